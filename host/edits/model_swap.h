// Replaces the model of a running simulation by that of its bodies after a cut or a tear. Private to host/solver.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "model/solid.h"
#include "simulation/simulation.h"

namespace pliant {

/// Mass that a node takes over from another one than its own origin [kg].
struct FluxMass {
  std::int32_t node, from;
  double mass;
};

/// Where the nodes of an edited body come from.
struct NodeOrigins {
  std::vector<std::int32_t> from;  ///< node of the body before the edit; empty: the edit left it alone
  std::vector<FluxMass> flux;
  [[nodiscard]] std::size_t of(std::size_t node) const { return from.empty() ? node : static_cast<std::size_t>(from[node]); }
};

/// Every node keeps its displacement, and its momentum goes where its mass goes. Construct and run() once.
class ModelSwap {
 public:
  /// `u`: what node_u holds. Adds its times to `report`.
  ModelSwap(Simulation& simulation, std::vector<double> u, CutReport& report);
  /// `solids`: the bodies as edited; their surfaces may still be in the making until `ready` returns, which may throw. Throws
  /// with the old model back in place.
  void run(std::span<const Solid* const> solids, std::vector<NodeOrigins> origins, const std::function<void()>& ready);

 private:
  void keep_surface(Program& program);
  /// Wait for the surfaces, and put them into the model.
  void take_surfaces(std::span<const Solid* const> solids, const std::function<void()>& ready);
  void carry_motion();
  void restore();

  Simulation& s_;
  CutReport& report_;
  double start_;
  std::shared_ptr<const Model> old_model_;
  std::vector<double> old_u_, old_w_;
  std::vector<std::vector<Vec3d>> v_;  ///< [bodies][nodes before the edit]
  std::vector<NodeOrigins> origins_;
  std::shared_ptr<Model> model_;
  bool kept_ = false;                        ///< the surface of the old model is in the new one
  const SurfaceChanges* changes_ = nullptr;  ///< where it differs from what was kept
  std::vector<double> new_u_, new_w_;
};

}  // namespace pliant
