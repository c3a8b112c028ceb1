// Central differences in textbook form, 2 u_n - u_(n-1): node_w holds u_(n-1), which belongs to the previous step size.
#pragma once
#include "integrators/central_differences.h"

namespace pliant::integrators {

struct Textbook {
  static constexpr IntegratorInfo info{.word = "textbook",
                                       .what = "2 u_n - u_(n-1), which loses small increments in float; for comparison",
                                       .source = "Hybrid Deformation Model, equation 14",
                                       .order = 2,
                                       .first = [](const Start& s) { return s.u - first_increment(s); },
                                       .increment = [](double u, double w) { return u - w; },
                                       .decay = central_decay,
                                       .squared_velocity = central_square,
                                       .stable_step = central_step,
                                       .keeps_increment = false,
                                       .automatic = false,
                                       .edits = false,
                                       .contact = false,
                                       .matching = false,
                                       .relaxation = true};
};

}  // namespace pliant::integrators
