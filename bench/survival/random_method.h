// The method of the blades of a random scene that do not cut with virtual nodes.
#pragma once
#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "bench/common/dice.h"

namespace pliant::bench {

/// One that the body and its blades allow. `tears`: a material has a toughness.
inline std::string random_blade_method(std::uint64_t number, const nlohmann::ordered_json& blades,
                                       const nlohmann::ordered_json& body, bool tears) {
  Dice dice(number ^ 0x51ed27);
  const bool presses =
      std::any_of(blades.begin(), blades.end(), [](const auto& b) { return b.value("cuts", "") == "by-force"; });
  const double at = dice.uniform(0, 1);
  if (tears || at < 0.4) return "separation";
  if (at < 0.7) return body["model"]["type"] == "mass-spring" ? "separation" : "decomposition";
  return presses ? "separation" : "removal";
}

inline void give_random_method(std::uint64_t number, const nlohmann::ordered_json& body, bool tears,
                               nlohmann::ordered_json& blades) {
  const std::string method = random_blade_method(number, blades, body, tears);
  for (auto& blade : blades) blade["method"] = method;
}

}  // namespace pliant::bench
