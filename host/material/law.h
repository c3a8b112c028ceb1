// What a law_STEM.h gives: a struct, named in kernels/laws.h, with
//   info                       the constant LawInfo
//   Name(const double* p)      from its parameters, in the order of info.parameters
//   from_moduli(m)             the parameters, or those of a typical material (if not takes_moduli), with these moduli at rest
//   moduli()                   the moduli at rest
//   constants()                what kernels/law_STEM.cl finds in law_parameters behind `low`
//   bulk()                     k of the volumetric part U(J) = k/2 (J - 1)^2, 0 without one
//   energy(k), stress(k), add_tangent(k, out)
// The last three leave U(J) out, which response.cpp adds for all laws, and lose no digit at small strain: they are written in
// H = F - I (kinematics.h). Below J = k.low a law that is not invertible goes on with LowVolume
// (kinematics.h); without, it is asked only where J > 0.
#pragma once
#include <cmath>
#include <vector>

#include "material/kinematics.h"
#include "material/material.h"
