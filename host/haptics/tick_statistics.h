// Times of ticks: counted by the haptic thread, read by any.
#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>

namespace pliant::haptics {

/// A histogram of durations from 0.1 us to 10 s, ten bins per factor of two: read values are exact within 4 %.
class TimeHistogram {
 public:
  void add(double seconds) noexcept {
    const double bins = seconds > kLeast ? kPerOctave * std::log2(seconds / kLeast) : 0;
    const auto bin = static_cast<std::size_t>(bins < kBins - 1 ? bins : kBins - 1);
    counts_[bin].fetch_add(1, std::memory_order_relaxed);
    if (seconds > most_.load(std::memory_order_relaxed)) most_.store(seconds, std::memory_order_relaxed);
    sum_.store(sum_.load(std::memory_order_relaxed) + seconds, std::memory_order_relaxed);
    count_.fetch_add(1, std::memory_order_relaxed);
  }
  [[nodiscard]] std::int64_t count() const noexcept { return count_.load(std::memory_order_relaxed); }
  [[nodiscard]] double most() const noexcept { return most_.load(std::memory_order_relaxed); }
  [[nodiscard]] double mean() const noexcept {
    return count() > 0 ? sum_.load(std::memory_order_relaxed) / static_cast<double>(count()) : 0;
  }
  /// The duration that a share of all does not exceed [s].
  [[nodiscard]] double quantile(double share) const noexcept {
    const double wanted = share * static_cast<double>(count());
    double seen = 0;
    for (std::size_t b = 0; b < kBins; ++b) {
      seen += static_cast<double>(counts_[b].load(std::memory_order_relaxed));
      if (seen >= wanted) return std::min(most(), kLeast * std::exp2(static_cast<double>(b + 1) / kPerOctave));
    }
    return most();
  }

 private:
  static constexpr double kLeast = 1e-7;
  static constexpr int kPerOctave = 10;
  static constexpr std::size_t kBins = 270;
  std::array<std::atomic<std::uint32_t>, kBins> counts_{};
  std::atomic<double> most_{0}, sum_{0};
  std::atomic<std::int64_t> count_{0};
};

}  // namespace pliant::haptics
