// Timing of passes: the median of several batches after warm-up.
#pragma once
#include <cstdint>
#include <vector>

#include "backends/interface/backend.h"

namespace pliant {

struct Timing {
  double median = 0;  ///< [s] per run of the list of passes
  double best = 0;    ///< [s] of the fastest batch: for hardware limits, which must not be underestimated
  double spread = 0;  ///< (third quartile - first quartile) / median
  int batches = 0;
};

/// Runs `passes` in batches of about `batch_seconds` until there are `batches` of them, after one batch of warm-up.
Timing time_passes(Backend& backend, const std::vector<Pass>& passes, int batches = 9, double batch_seconds = 0.02);

/// Returns median, best and spread of the batch times [s].
Timing summary(std::vector<double> samples);

}  // namespace pliant
