// Forces that a program puts on nodes while the simulation runs.
#pragma once
#include <vector>

#include "simulation/state/run_context.h"

namespace pliant {

class HostLoads {
 public:
  explicit HostLoads(RunContext& run) : run_(run) {}
  /// These replace those set before, beside the forces of the scene. Throws Error (usage) for a node that does not exist,
  /// (state) for one without a force reserved by the Model (Scene::interactive), with nothing changed.
  void set(std::vector<HostForce> forces);
  /// Throws what set() throws.
  static void check(const Model& model, const std::vector<HostForce>& forces);
  /// Write the whole table of forces: those of the scene are constants of the Model. After a cut a node may be gone, or move no
  /// vertex any more; its force waits until the host sets them again.
  void upload() const;

 private:
  RunContext& run_;
};

}  // namespace pliant
