// Explicit Euler, Y <- Y + h f(Y) with Y = (u, v): node_w holds h v at the time of u. For comparison: the amplitude of an
// undamped oscillator grows by sqrt(1 + h^2 omega^2) per step, so it needs damping and much smaller steps than central
// differences.
#pragma once
#include <algorithm>

#include "integrators/integrator.h"

namespace pliant::integrators {

struct ForwardEuler {
  static constexpr IntegratorInfo info{
      .word = "forward-euler",
      .what = "explicit Euler, which is stable with damping and short steps only; for comparison",
      .source = "Hairer, Norsett and Wanner 1993",
      .order = 1,
      .first = [](const Start& s) { return s.h * s.v; },
      .increment = [](double /*u*/, double w) { return w; },
      .decay = [](double k) { return 1 - 2 * k; },
      .squared_velocity = [](double v, double, double, double) { return v * v; },
      // |1 + h l| <= 1 for l^2 + d l + omega^2 = 0, d = c + t omega^2 with the viscous time t: h <= d / omega^2 for complex l;
      // for real l h <= 2 / |l|, and |l| <= d.
      .stable_step =
          [](double central, const DampingRange& d) {
            const double omega2 = 4 / (central * central);
            return std::min(d.least_rate / omega2 + d.least_time, 2 / (d.most_rate + d.most_time * omega2));
          },
      .keeps_increment = true,
      .automatic = false,
      .edits = true,
      .contact = false,
      .matching = false,
      .relaxation = false};
};

}  // namespace pliant::integrators
