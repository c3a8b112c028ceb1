// Replaces the model of a running simulation after an edit of its bodies. Private to host/edits.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "geometry/stopwatch.h"
#include "simulation/edits/cut_report.h"
#include "simulation/edits/edited_bodies.h"
#include "simulation/state/carried_state.h"
#include "simulation/state/run_context.h"
#include "simulation/step/host_loads.h"
#include "tearing/node_origins.h"

namespace pliant {

/// Preserves the displacement and velocity of every node, so that momentum follows mass; a new node on an edge gets what the
/// edge has there, so that deformation gradients stay what they are. Construct it, edit the bodies, then call build() and
/// load().
class ModelSwap {
 public:
  /// Adds its times to `report`.
  ModelSwap(RunContext& run, HostLoads& loads, EditedBodies& bodies, CutReport& report);
  /// Keeps contact and the state of shape matching if the nodes are unchanged.
  void keep_state() { keeps_state_ = true; }
  /// Call if no body has been edited: the points of contact are the same, in other slots.
  void keep_bodies() { keeps_bodies_ = true; }
  /// Returns true while the run has the model that this started from.
  [[nodiscard]] bool fits() const { return run_.loaded.shared_model() == old_model_; }
  /// Starts from the run's model now.
  void renew() { old_model_ = run_.loaded.shared_model(); }
  /// Builds the new model and its Program. Of the run it reads only the old model, which never changes, so that it may work
  /// beside steps. `scene`: with the new operational regions. The surfaces may still be in progress until `ready` returns,
  /// which may throw.
  void build(const Scene& scene, std::vector<NodeOrigins> origins, std::function<void()> ready);
  /// Compiles the Program, if the backend can do so beside steps: otherwise load() does.
  void compile() { run_.backend().compile_beside(program_); }
  /// Waits for the surfaces and adds them to the model, if that was not done. load() calls it.
  void take_surfaces();
  /// Replaces the model. `u`: RunContext::u(). On an exception, the old model is restored.
  void load(std::vector<double> u);
  /// After load(): nonzero for each slot whose mass differs from that of its origin, so that its elements have changed. Shape
  /// [slots].
  [[nodiscard]] std::vector<char> changed_nodes() const;
  [[nodiscard]] const std::vector<NodeOrigins>& origins() const { return origins_; }

 private:
  [[nodiscard]] bool keeps_surface() const;
  /// Returns the ballast of the old nodes, distributed to their copies in proportion to mass.
  [[nodiscard]] std::vector<NodeInertia> carried_ballast() const;
  /// Returns true if all nodes and points of contact are the same as before.
  [[nodiscard]] bool keeps_nodes() const;
  /// For each slot with a node, the slots of the nodes that its values come from.
  [[nodiscard]] std::vector<SlotOrigin> slot_origins() const;
  /// Gives the new Program the values that nodes hold, as Carry of each state buffer says.
  void carry_nodes(Program& program);
  void carry_velocity(Buffer& to) const;
  /// The same for RunState::offset, which is taken off the displacements `u`.
  void carry_offset(const std::vector<SlotOrigin>& origins, std::vector<double>& u);
  /// Gives the new Program, whose nodes are those of the old one, what Carry::drop would drop: contact and shape matching.
  void keep_rest(Program& program) const;
  void load_steps();
  void load_surface();
  void restore();

  RunContext& run_;
  HostLoads& loads_;
  EditedBodies& bodies_;
  CutReport& report_;
  Stopwatch clock_;
  std::shared_ptr<const Model> old_model_;
  std::vector<double> old_u_, old_w_;
  std::vector<std::vector<Vec3d>> v_;  ///< shape [bodies][nodes before the edit]
  std::vector<NodeOrigins> origins_;
  std::function<void()> ready_;  ///< empty: the surfaces are in the model
  std::shared_ptr<Model> model_;
  Program program_;
  std::vector<BufferValues> initial_;
  std::vector<NodeInertia> ballast_;
  bool keeps_state_ = false, keeps_bodies_ = false;
  bool same_nodes_ = false;                  ///< and keeps_state_
  bool kept_ = false;                        ///< the new model reuses the surface of the old one
  const SurfaceChanges* changes_ = nullptr;  ///< the differences from the reused surface
  std::vector<double> offset_;               ///< RunState::offset of the new model
};

}  // namespace pliant
