// What this machine can do at best, measured through the same backend in the same run.
#pragma once
#include <cstdint>

#include "backends/interface/backend.h"

namespace pliant::bench {

/// Bytes per second of a triad whose three arrays take about `footprint` bytes together (the fastest of several batches).
double triad_bandwidth(Backend& backend, std::int64_t footprint);

/// Floating-point operations per second of independent fma chains (an fma counts two).
double fma_rate(Backend& backend);

}  // namespace pliant::bench
