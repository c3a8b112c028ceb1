// Random numbers that are the same everywhere.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "geometry/vec.h"

namespace pliant::bench {

/// The distributions of the standard library differ from one library to the next.
class Dice {
 public:
  explicit Dice(std::int64_t seed) : engine_(static_cast<std::uint64_t>(seed) * 0x9E3779B97F4A7C15u + 1) { engine_.discard(8); }
  double uniform(double low, double high) { return low + (high - low) * std::ldexp(static_cast<double>(engine_() >> 11), -53); }
  double logarithmic(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  bool chance(double share) { return uniform(0, 1) < share; }
  std::size_t below(std::size_t n) { return std::min(n - 1, static_cast<std::size_t>(uniform(0, static_cast<double>(n)))); }
  Vec3d direction() {
    for (;;) {
      const Vec3d v{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
      const double length = vec::norm(v);
      if (length > 0.1 && length < 1) return vec::mul(v, 1 / length);
    }
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace pliant::bench
