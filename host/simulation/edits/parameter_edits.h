// Changes of parameters of a running simulation: gravity, materials, models, and supports. The scene is replaced by one
// with the new values, and a model of it takes over the motion. Materials and models wait for a step at which all subcycles of
// shape matching begin, before and after the change.
#pragma once
#include <string>
#include <vector>

#include "simulation/edits/topology_edits.h"
#include "simulation/state/run_report.h"
#include "simulation/step/step_control.h"

namespace pliant {

class ParameterEdits {
 public:
  /// `scene`: the one that RunContext shows.
  ParameterEdits(Scene& scene, RunContext& run, StepControl& step, TopologyEdits& topology, RunReports& reports)
      : scene_(scene), run_(run), step_(step), topology_(topology), reports_(reports) {}

  /// Call at the start of a simulation.
  void start() { first_ = scene_; }
  /// Call before a batch that begins on the grid: makes the changes that are due.
  void update();
  /// Makes a change now, or with substeps of shape matching when they begin. `change`: JSON text, an entry of "changes" without
  /// its time. Throws Error (bad_input), and then changes nothing.
  void change(const std::string& change);
  /// Returns the scene with the parameters of a state. Throws Error (bad_input) if they do not belong to it.
  [[nodiscard]] Scene scene_of(const RunState& state) const;

 private:
  [[nodiscard]] bool may_load(const Scene& next) const;
  /// Returns false if the change has to wait.
  bool make(const std::string& change, const std::string& where);
  void load(const Scene& next);

  Scene& scene_;
  Scene first_;  ///< as it was loaded
  RunContext& run_;
  StepControl& step_;
  TopologyEdits& topology_;
  RunReports& reports_;
};

}  // namespace pliant
