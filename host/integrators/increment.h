// Central differences in increment form: node_w holds u_n - u_(n-1), which keeps its precision for any step size.
#pragma once
#include "integrators/central_differences.h"

namespace pliant::integrators {

struct Increment {
  static constexpr IntegratorInfo info{.word = "increment",
                                       .what = "central differences in the increment of the displacement",
                                       .source = "Miller et al. 2007",
                                       .order = 2,
                                       .first = first_increment,
                                       .increment = [](double /*u*/, double w) { return w; },
                                       .decay = central_decay,
                                       .squared_velocity = central_square,
                                       .stable_step = central_step,
                                       .keeps_increment = true,
                                       .automatic = true,
                                       .edits = true,
                                       .contact = true,
                                       .matching = true,
                                       .relaxation = true};
};

}  // namespace pliant::integrators
