// The start-up probe: does a backend's arithmetic give the known answers, bit for bit?
#pragma once
#include <string>

#include "backends/interface/backend.h"

namespace pliant {

/// Inputs (a few thousand cases: contraction, double rounding of fma, hard quotients and roots, denormals, signed zeros, NaN,
/// infinity, random bits) and two passes of kernels/measure/probe.cl over them, one of each lane width that the backend uses.
const Program& probe_program();

/// Loads probe_program() into a float backend, runs it and compares with the answers of <cmath>. Returns an empty text if all
/// agree, else the first difference. Replaces what was loaded.
std::string run_probe(Backend& backend);

}  // namespace pliant
