#include "bench/haptics/spectrum.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "geometry/vec.h"

namespace pliant::bench::haptics {

double energy_at_multiples(const ForceTrace& felt, const ForceTrace& expected, double frequency) {
  constexpr double kHighest = 300;  // [1/s]; touch is most sensitive at 200 to 300 (Verrillo 1963)
  const std::size_t n = std::min(felt.wrench.size(), expected.wrench.size());
  if (n < 2) return 0;
  const double length = static_cast<double>(n) * felt.period;
  double energy = 0;
  for (double f = frequency; f < kHighest; f += frequency) {
    for (int bin = -1; bin <= 1; ++bin) {
      const double turn = 2 * std::numbers::pi * (f + bin / length) * felt.period;
      for (std::size_t c = 0; c < 3; ++c) {
        std::complex<double> sum = 0;
        for (std::size_t k = 0; k < n; ++k) {
          const double hann = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n));
          sum +=
              hann * (felt.wrench[k].force[c] - expected.wrench[k].force[c]) * std::polar(1.0, -turn * static_cast<double>(k));
        }
        energy += std::norm(sum) / static_cast<double>(n * n);
      }
    }
  }
  return energy;
}

double largest_jump(const ForceTrace& felt) {
  double most = 0;
  for (std::size_t k = 1; k < felt.wrench.size(); ++k)
    most = std::max(most, vec::norm(vec::sub(felt.wrench[k].force, felt.wrench[k - 1].force)));
  return most;
}

}  // namespace pliant::bench::haptics
