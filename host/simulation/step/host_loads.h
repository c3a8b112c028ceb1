// Forces that the calling program applies to nodes during the run.
#pragma once
#include <vector>

#include "simulation/state/run_context.h"

namespace pliant {

class HostLoads {
 public:
  explicit HostLoads(RunContext& run) : run_(run) {}
  /// Replaces the previous host forces; the scene's forces remain. Throws Error (usage) for an unknown node and (state) for a
  /// node without a force reserved by the Model (Scene::interactive), and then changes nothing.
  void set(std::vector<HostForce> forces);
  /// Throws as set().
  static void check(const Model& model, const std::vector<HostForce>& forces);
  /// Uploads the whole table of forces, including the constant ones of the scene. A force on a node that a cut removed, or
  /// that moves no vertex any more, is skipped until the host sets the forces again.
  void upload() const;

 private:
  RunContext& run_;
};

}  // namespace pliant
