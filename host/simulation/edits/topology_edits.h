// Cuts, tears and moved operational regions: what changes the model of a running simulation. Each is found, made on the bodies,
// carried over by a ModelSwap, and entered into the RunState; if anything fails on the way, all is as it was before.
#pragma once
#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "simulation/edits/cut_report.h"
#include "simulation/edits/edited_bodies.h"
#include "simulation/step/host_loads.h"
#include "simulation/step/step_control.h"

namespace pliant {

class TopologyEdits {
 public:
  TopologyEdits(RunContext& run, StepControl& step, HostLoads& loads) : run_(run), step_(step), loads_(loads) {}

  /// At the start of a simulation: fill bodies that blades of the scene will cut or that may tear, and settle when both are
  /// looked at. Throws Error (bad_input) for scenes that cannot be edited so.
  void start();
  /// Before a batch that begins on the grid: move the scene's blades, part what is stretched too far, break faces, let regions
  /// follow the tool.
  void update();
  /// Go on with at most kSafeSubsteps substeps in all hybrids; false if none has more, if the step is the user's, or if a mesh
  /// file has gone. To be called in a state that was kept.
  /// Throws, with all as it was, what Backend::load throws.
  [[nodiscard]] bool fewer_substeps();

  /// Described at Simulation's functions of the same names.
  CutReport cut(std::span<const SweepTriangle> triangles);
  CutReport move_blades(std::span<const BladePose> poses);
  void lift_blade(const std::string& blade);
  void prepare_cuts();
  [[nodiscard]] const CutTopology* cut_topology(std::size_t body) const;

  /// The scene with its operational regions where a state has them, with the substeps that it goes on with, and with its tools
  /// but for those that are parked.
  [[nodiscard]] Scene scene_at(const RunState& state) const;
  /// Bodies as the edits of a state make them; nullptr if neither it nor the present state has any. Throws Error (bad_input)
  /// for a state that does not belong to this scene. Changes nothing.
  [[nodiscard]] std::unique_ptr<EditedBodies> bodies_at(const RunState& state) const;
  /// Go on with these.
  void take_up(std::unique_ptr<EditedBodies> bodies);

 private:
  EditedBodies& bodies();
  EditedBodies& cut_bodies();

  // blade_updates.cpp
  void move_scene_blades();
  CutReport run_blades(const std::vector<BladeMove>& moves, std::span<const SweepTriangle> triangles);
  [[nodiscard]] bool reached(std::size_t body, const std::vector<Vec3d>& x, const std::vector<BladeMove>& moves,
                             std::span<const SweepTriangle> triangles) const;
  [[nodiscard]] const BladeTrace* front(const BladeMove& move, std::size_t body) const;
  // cut_edit.cpp, overstretch_edit.cpp, tear_edit.cpp, partition_edit.cpp
  void make_cut(std::vector<CutEdges> edges, std::vector<double> u, CutReport& report);
  void make_tears();
  void open_overstretched();
  void move_regions();
  /// A region of a body that grows from `seed`, but for cells that are deformed too far to change their model (u: [nodes] of
  /// the body).
  [[nodiscard]] MovedRegion region_at(std::size_t body, const Vec3d& seed, const std::vector<Vec3d>& u);
  /// Whether the bodies' files, which are read when somebody edits a body for the first time, are still there and as they were.
  [[nodiscard]] bool bodies_as_loaded();
  /// The model of scene_at(state) with the bodies as they are.
  void swap_partition(std::vector<double> u);

  RunContext& run_;
  StepControl& step_;
  HostLoads& loads_;
  std::unique_ptr<EditedBodies> bodies_;  ///< what RunState's edits make of the scene's bodies; once somebody asked for them
};

}  // namespace pliant
