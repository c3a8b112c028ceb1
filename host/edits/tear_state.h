// The bodies of a simulation that tear. Private to host/solver.
#pragma once
#include <optional>
#include <vector>

#include "model/solid.h"
#include "tearing/torn_body.h"

namespace pliant {

/// Steps between two looks at the stress.
inline constexpr std::int64_t kTearSteps = 16;

struct TearState {
  /// Throws Error for a body that has a toughness and is no volume mesh of tetrahedra.
  explicit TearState(const Scene& scene);
  /// Whether a material of the scene has a toughness.
  static bool wanted(const Scene& scene);
  std::vector<std::optional<TornBody>> bodies;  ///< nothing for a body that does not tear
  std::vector<Solid> solids;                    ///< as they are now
};

}  // namespace pliant
