// Random inputs of the kinds that have broken bit-exactness elsewhere.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "kernels/kernel_case.h"

namespace pliant::kernel_test {

enum class Data {
  small,      ///< a thousandth of the typical size
  large,      ///< about the typical size: large deformation, inverted elements
  denormal,   ///< denormal numbers
  underflow,  ///< ordinary numbers whose products are denormal or zero
  huge,       ///< 1e18 .. 1e30
  special,    ///< ordinary numbers among which NaN, infinity, zeros and the largest float are sprinkled
  bits,       ///< random bit patterns
  zeros,      ///< +0 and -0
};

inline constexpr Data all_data[] = {Data::small, Data::large,   Data::denormal, Data::underflow,
                                    Data::huge,  Data::special, Data::bits,     Data::zeros};

inline const char* name_of(Data data) {
  constexpr const char* names[] = {"small", "large", "denormal", "underflow", "huge", "special", "random bits", "zeros"};
  return names[static_cast<int>(data)];
}

class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  double uniform(double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(engine_()) / 4294967296.0;  // the same numbers with every standard library
  }
  int integer(int lo, int hi) { return lo + static_cast<int>(engine_() % static_cast<std::uint32_t>(hi - lo + 1)); }
  bool chance(double p) { return uniform(0, 1) < p; }

  double draw(Data data, double typical) {
    const double sign = chance(0.5) ? 1 : -1;
    switch (data) {
      case Data::small:
        return typical * 1e-3 * uniform(-1, 1);
      case Data::large:
        return typical * uniform(-1, 1);
      case Data::denormal:
        return 1e-38 * std::pow(10, uniform(-6, 0)) * sign;
      case Data::underflow:
        return std::pow(10, uniform(-22, -18)) * sign;
      case Data::huge:
        return std::pow(10, uniform(18, 30)) * sign;
      case Data::bits:
        return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(engine_())));
      case Data::zeros:
        return chance(0.5) ? 0.0 : -0.0;
      case Data::special:
        break;
    }
    using Limits = std::numeric_limits<float>;
    constexpr double special[] = {Limits::quiet_NaN(), Limits::infinity(),   -Limits::infinity(), 0.0, -0.0,
                                  Limits::max(),       Limits::denorm_min(), Limits::min()};
    return chance(0.02) ? special[integer(0, 7)] : typical * uniform(-1, 1);
  }
  Reals reals(std::size_t n, Data data, double typical) {
    Reals v(n);
    for (double& x : v) x = draw(data, typical);
    return v;
  }
  Reals positive(std::size_t n, double lo, double hi) {
    Reals v(n);
    for (double& x : v) x = uniform(lo, hi);
    return v;
  }
  Ints ints(std::size_t n, int lo, int hi) {
    Ints v(n);
    for (auto& x : v) x = integer(lo, hi);
    return v;
  }
  /// n distinct numbers of 0 .. range - 1.
  Ints distinct(std::size_t n, std::size_t range) {
    Ints v(range);
    for (std::size_t i = 0; i < range; ++i) v[i] = static_cast<std::int32_t>(i);
    for (std::size_t i = 0; i < n; ++i) std::swap(v[i], v[i + engine_() % (range - i)]);
    v.resize(n);
    return v;
  }
  /// Fault steps: most elements have had none.
  Ints faults(std::size_t n) {
    Ints v(n);
    for (auto& x : v) x = chance(0.1) ? (chance(0.3) ? -1 : 1) * integer(1, 9) : 0;  // negative: only inverted
    return v;
  }

 private:
  std::mt19937 engine_;
};

/// The number after which a field of element data stands still: ordinary except where the class concerns every number.
inline Data data_for_constants(Data data) { return data == Data::bits || data == Data::special ? data : Data::large; }

}  // namespace pliant::kernel_test
