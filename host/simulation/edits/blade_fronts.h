// Fronts of blades that cut by force, on the host: where edges meet tissue, and how far they have gone through it. Between two
// updates the device presses the edges against the front points (kernels/contact/blade_press.cl).
#pragma once
#include <map>
#include <vector>

#include "simulation/edits/cut_strokes.h"
#include "simulation/edits/edited_bodies.h"
#include "simulation/edits/front_point.h"
#include "simulation/edits/present_surface.h"
#include "simulation/state/run_context.h"

namespace pliant {

/// Mean edge of the model's elements [m], from which samples and updates of blades are counted.
double typical_edge(const Model& model);
/// Number of samples of the edge of a blade; two per typical edge and both ends.
std::int32_t sample_count(const Blade& blade, double edge);
/// Largest speed of an end of a blade [m/s].
double top_speed(const Blade& blade);

/// Share of its integrity that tissue keeps where a front has gone this far through it [m]. edge: typical_edge().
double integrity_left(double depth, double edge);

class BladeFronts {
 public:
  BladeFronts(RunContext& run, CutStrokes& strokes) : run_(run), strokes_(strokes) {}
  /// Moves the fronts to the places of the edges and lets edges meet the tissue ahead of them. Returns the edges of each body
  /// that the fronts have crossed. u: RunContext::u(); `until`: time of the next update [s].
  std::vector<CutEdges> update(EditedBodies& bodies, const std::vector<double>& u, double until);

 private:
  /// One blade during an update.
  struct Edge;
  /// The sweep of the samples of a blade in one body.
  struct Sweep;
  void turn(PressedBlade& blade, const Edge& edge) const;
  void let_go(PressedBlade& blade, const Edge& edge, EditedBodies& bodies) const;
  void give_way(PressedBlade& blade, const Edge& edge, EditedBodies& bodies, std::vector<CutEdges>& edges);
  void sweep(PressedBlade& blade, const Edge& edge, EditedBodies& bodies, std::size_t b, CutEdges& edges) const;
  void meet(PressedBlade& blade, const Edge& edge, EditedBodies& bodies, PresentSurface& surface);
  static void weaken(PressedBlade& blade, FrontSample& sample, const Edge& edge);
  [[nodiscard]] double limit(const Blade& blade, const FrontSample& sample, double length, EditedBodies& bodies);
  [[nodiscard]] Material material(std::size_t body, std::int32_t cell, EditedBodies& bodies);

  RunContext& run_;
  CutStrokes& strokes_;
  std::vector<std::vector<Vec3d>> x_;  ///< present positions of the nodes of each body [m]
  std::map<std::size_t, ElementMaterials> materials_;
};

}  // namespace pliant
