// Faces of the blades of a random scene that cut by force.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>

#include "bench/common/dice.h"

namespace pliant::bench {

/// Half of these blades are plates, so thin that every method allows them. `extent`: of the body [m].
inline void give_random_plates(std::uint64_t number, double extent, nlohmann::ordered_json& blades) {
  Dice dice(number ^ 0x2c1b3c6d);
  for (auto& blade : blades) {
    if (!blade.contains("cuts") || !dice.chance(0.5)) continue;
    blade["thickness"] = extent * dice.logarithmic(2e-3, 1e-2);
    blade["height"] = extent * dice.uniform(1, 1.5);
  }
}

}  // namespace pliant::bench
