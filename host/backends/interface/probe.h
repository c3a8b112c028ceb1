// The start-up probe: checks whether a backend's arithmetic gives the known answers, bit for bit.
#pragma once
#include <string>

#include "backends/interface/backend.h"

namespace pliant {

/// A program with a few thousand inputs (contraction, double rounding of fma, hard quotients and roots, denormals, signed
/// zeros, NaN, infinity, random bits) and two passes of kernels/measure/probe.cl over them, one for each lane width that the
/// backend uses.
const Program& probe_program();

/// Loads probe_program() into a float backend, runs it and compares with the results of <cmath>. Returns an empty text if all
/// agree, otherwise the first difference. Replaces the loaded program.
std::string run_probe(Backend& backend);

}  // namespace pliant
