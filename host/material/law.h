// Interface of law_STEM.h: a struct, named in kernels/laws.h, with
//   info                       the constant LawInfo
//   Name(const double* p)      constructs from its parameters, in the order of info.parameters
//   from_moduli(m)             the parameters, or those of a typical material (if not takes_moduli), with these moduli at rest
//   moduli()                   the moduli at rest
//   constants()                the values after `low` in law_parameters for kernels/law_STEM.cl
//   bulk()                     k of the volumetric part U(J) = k/2 (J - 1)^2, 0 without one
//   energy(k), stress(k), add_tangent(k, out)
// The last three exclude U(J), which response.cpp adds for all laws, and avoid cancellation at small strain by formulas in H
// = F - I (kinematics.h). Below J = k.low, a law that is not invertible is continued by LowVolume (kinematics.h); without
// that, it is evaluated only for J > 0.
#pragma once
#include <cmath>
#include <vector>

#include "material/kinematics.h"
#include "material/material.h"
