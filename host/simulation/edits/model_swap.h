// Replaces the model of a running simulation by that of its bodies after an edit. Private to this shelf.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "geometry/stopwatch.h"
#include "simulation/edits/cut_report.h"
#include "simulation/edits/edited_bodies.h"
#include "simulation/state/run_context.h"
#include "simulation/step/host_loads.h"

namespace pliant {

/// Where the nodes of an edited body come from.
struct NodeOrigins {
  std::vector<std::int32_t> from;  ///< node of the body before the edit; empty: the edit left it alone
  [[nodiscard]] std::size_t of(std::size_t node) const { return from.empty() ? node : static_cast<std::size_t>(from[node]); }
};

/// Every node keeps its displacement, and its momentum goes where its mass goes. Construct, edit the bodies, and run() once.
class ModelSwap {
 public:
  /// `u`: RunContext::u(). Adds its times to `report`.
  ModelSwap(RunContext& run, HostLoads& loads, EditedBodies& bodies, std::vector<double> u, CutReport& report);
  /// `scene`: with its operational regions as they are to be. The bodies' surfaces may still be in the making until `ready`
  /// returns, which may throw. Throws with the old model back in place.
  void run(const Scene& scene, std::vector<NodeOrigins> origins, const std::function<void()>& ready);
  /// After run(): which nodes have another mass than the ones they come from, so that their elements are others. [slots]
  [[nodiscard]] std::vector<char> changed_nodes() const;

 private:
  [[nodiscard]] bool keeps_surface() const;
  /// Wait for the surfaces, and put them into the model.
  void take_surfaces(const std::vector<const BodyMesh*>& solids, const std::function<void()>& ready);
  /// What the nodes had of ballast, shared among their copies like their masses.
  [[nodiscard]] std::vector<NodeInertia> carried_ballast() const;
  void load_steps(const Scene& scene);
  void load_surface();
  void carry_motion();
  void restore();

  RunContext& run_;
  HostLoads& loads_;
  EditedBodies& bodies_;
  CutReport& report_;
  Stopwatch clock_;
  std::shared_ptr<const Model> old_model_;
  std::vector<double> old_u_, old_w_;
  std::vector<std::vector<Vec3d>> v_;  ///< [bodies][nodes before the edit]
  std::vector<NodeOrigins> origins_;
  std::shared_ptr<Model> model_;
  std::vector<NodeInertia> ballast_;
  bool kept_ = false;                           ///< the surface of the old model is in the new one
  const SurfaceChanges* changes_ = nullptr;     ///< where it differs from what was kept
  std::vector<double> new_u_, new_w_, offset_;  ///< offset_: RunState::offset of the new model
};

}  // namespace pliant
