// The last forces of a tool or grab, one per step or update. Private to host/api.
#pragma once
#include <algorithm>
#include <cstdint>
#include <deque>
#include <vector>

#include "pliant/live.h"

namespace pliant::api {

/// Steps ascend.
class ForceTrace {
 public:
  static constexpr std::size_t kMost = 4096;

  void add(const ForceSample& sample) {
    if (!samples_.empty() && samples_.back().step >= sample.step) return;
    if (samples_.size() == kMost) samples_.pop_front();
    samples_.push_back(sample);
  }
  void forget_after(std::int64_t step) {
    while (!samples_.empty() && samples_.back().step > step) samples_.pop_back();
  }
  [[nodiscard]] std::vector<ForceSample> after(std::int64_t step) const {
    const auto later = [](std::int64_t a, const ForceSample& s) { return a < s.step; };
    return {std::upper_bound(samples_.begin(), samples_.end(), step, later), samples_.end()};
  }

 private:
  std::deque<ForceSample> samples_;
};

}  // namespace pliant::api
