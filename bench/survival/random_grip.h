// The grip of a random tool.
#pragma once
#include <nlohmann/json.hpp>

#include "bench/common/dice.h"

namespace pliant::bench {

/// Some time within two seconds; half of them let go at a hundredth to ten times `young` [Pa].
inline nlohmann::ordered_json random_grip(Dice& dice, double young) {
  using Json = nlohmann::ordered_json;
  Json grip{{"times", Json::array({Json::array({dice.uniform(0, 1), dice.uniform(1.1, 2)})})}};
  if (dice.chance(0.5)) grip["strength"] = dice.logarithmic(0.01, 10) * young;
  return grip;
}

}  // namespace pliant::bench
