#include "backends/interface/timing.h"

#include <algorithm>
#include <chrono>

namespace pliant {
namespace {

constexpr std::int32_t kLongest = 64;  // maximum steps per batch: rows of curve_value

double seconds_for(Backend& backend, const std::vector<Pass>& passes, std::int32_t runs) {
  const auto start = std::chrono::steady_clock::now();
  for (std::int32_t done = 0; done < runs; done += kLongest) backend.run(passes, 0, std::min(kLongest, runs - done));
  backend.finish();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Timing time_passes(Backend& backend, const std::vector<Pass>& passes, int batches, double batch_seconds) {
  seconds_for(backend, passes, 1);
  const double once = seconds_for(backend, passes, 4) / 4;
  const auto runs = static_cast<std::int32_t>(std::clamp(batch_seconds / std::max(once, 1e-7), 1.0, 4096.0));
  seconds_for(backend, passes, runs);
  std::vector<double> samples;
  for (int b = 0; b < batches; ++b) samples.push_back(seconds_for(backend, passes, runs) / runs);
  return summary(samples);
}

Timing summary(std::vector<double> samples) {
  std::sort(samples.begin(), samples.end());
  const std::size_t n = samples.size();
  return {samples[n / 2], samples[0], (samples[3 * n / 4] - samples[n / 4]) / samples[n / 2], static_cast<int>(n)};
}

}  // namespace pliant
