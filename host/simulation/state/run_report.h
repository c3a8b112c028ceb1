// Statistics of a run. No step depends on them. Checkpoints contain them, so that a resumed run also reports earlier events;
// the deep hash and comparisons exclude them.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pliant/wrench.h"
#include "simulation/state/cut_strokes_state.h"
#include "simulation/state/run_state_parts.h"

namespace pliant {

/// Statistics of elements that had J <= 0 and continued.
struct Inversions {
  std::int64_t batches = 0;     ///< number of batches with inverted elements
  std::int64_t most = 0;        ///< largest number in one batch
  std::int64_t last = 0;        ///< number in the last batch
  std::int64_t first_step = 0;  ///< first step of the first such batch
  double first_time = 0;        ///< [s]
  std::int64_t calmed = 0;      ///< elements whose relative motion was reduced (recovery/calm.h), summed over batches
  std::string body;             ///< body of one of the first inverted elements
  std::int64_t element = -1;    ///< its index in the body
};

/// Inertia added to nodes whose elements need a shorter step than Scene::least_step.
struct BallastReport {
  std::int64_t nodes = 0;  ///< current number of nodes
  double mass = 0;         ///< current added mass [kg]
  double most = 0;         ///< largest added mass so far [kg]
};

/// Contact load on a tool, of one step or of a batch: force and torque are means over the batch, the rest is that of its last
/// step with contact.
struct ToolLoad : Wrench {
  double area = 0;   ///< undeformed area of the tissue in contact [m^2]
  double depth = 0;  ///< greatest depth of a point inside the tool, after contact [m]
  std::int64_t points = 0;
};

/// A tool whose centre, axis, corners or vertices are below the surface of a body: tissue has passed it, or it tissue.
struct SunkenTool {
  double depth = 0;        ///< below the surface, with the radius of a round tool [m]; 0: it is not
  double cell = 0;         ///< size of a cell of the body [m]
  double time = 0;         ///< [s]
  Vec3d where{};           ///< the deepest of these points [m]
  std::int32_t body = -1;  ///< index in the model
  [[nodiscard]] double cells() const { return depth > 0 ? depth / cell : 0; }
};

/// Statistics of a tool.
struct ToolHistory {
  ToolLoad now;              ///< load of the last batch
  double max_force = 0;      ///< largest mean force of a batch [N]
  double max_depth = 0;      ///< largest depth [m]
  double work = 0;           ///< work of its rigid motion on the tissue since the start [J]
  std::int64_t touched = 0;  ///< number of steps with contact
  Pose before;               ///< pose of the frame one step before `step`; the host may have placed the tool elsewhere since
  std::int64_t step = -1;    ///< end of the last batch with contact; -1: none
  SunkenTool sunk, deepest;  ///< at the last look (sunken_tool.h), and at the look that found most
};

/// Statistics of contact between tissue and tissue.
struct TouchHistory {
  std::int64_t points = 0;  ///< points in contact in the last batch
  double max_depth = 0;     ///< depth of the deepest pair, after contact [m]
  double work = 0;          ///< of parting tissue that had come inside other tissue, where the energy is watched [J]
};

/// Energy that appeared without a source (Simulation::watch_energy).
struct EnergyHistory {
  std::optional<double> least;  ///< least energy less work at any check [J]; empty: no check was made
  double created = 0,
         highest = 0;  ///< largest rise above an earlier `least`, and largest kinetic plus strain energy or work [J]
  /// Returns created / highest.
  [[nodiscard]] std::optional<double> share() const { return share_of(created); }
  /// Returns `energy` [J] / highest.
  [[nodiscard]] std::optional<double> share_of(double energy) const {
    if (!least) return {};
    return highest > 0 ? energy / highest : 0;
  }
};

struct RunReport {
  Inversions inversions;
  BallastReport ballast;
  std::vector<ToolHistory> tools;  ///< one per tool of the model
  TouchHistory tissue;
  EnergyHistory energy;
  CutStrokesState strokes;
  std::int64_t made_again = 0;  ///< number of batches that were rolled back (recovery/recovery.h)

  /// Call when a batch is rolled back: restores the statistics that it changed from `kept`, and counts it.
  void take_back(const RunReport& kept) {
    inversions = kept.inversions;
    tools = kept.tools;
    tissue = kept.tissue;
    energy = kept.energy;
    strokes = kept.strokes;
    ++made_again;
  }
};

/// The current statistics and those at the kept state.
struct RunReports {
  RunReport now, kept;
};

template <class V>
void visit(V& v, Inversions& s) {
  v("batches", s.batches), v("most", s.most), v("last", s.last), v("first_step", s.first_step), v("first_time", s.first_time);
  v("calmed", s.calmed), v("body", s.body), v("element", s.element);
}
template <class V>
void visit(V& v, BallastReport& s) {
  v("nodes", s.nodes), v("mass", s.mass), v("most", s.most);
}
template <class V>
void visit(V& v, ToolLoad& s) {
  v("force", s.force), v("torque", s.torque), v("area", s.area), v("depth", s.depth), v("points", s.points);
}
template <class V>
void visit(V& v, SunkenTool& s) {
  v("depth", s.depth), v("cell", s.cell), v("time", s.time), v("where", s.where), v("body", s.body);
}
template <class V>
void visit(V& v, ToolHistory& s) {
  v("now", s.now), v("max_force", s.max_force), v("max_depth", s.max_depth), v("work", s.work), v("touched", s.touched);
  v("before", s.before), v("step", s.step), v("sunk", s.sunk), v("deepest", s.deepest);
}
template <class V>
void visit(V& v, TouchHistory& s) {
  v("points", s.points), v("max_depth", s.max_depth), v("work", s.work);
}
template <class V>
void visit(V& v, EnergyHistory& s) {
  v("least", s.least), v("created", s.created), v("highest", s.highest);
}
template <class V>
void visit(V& v, RunReport& s) {
  v("inversions", s.inversions), v("ballast", s.ballast), v("tools", s.tools), v("tissue", s.tissue), v("energy", s.energy);
  v("made_again", s.made_again);
  v.last("strokes", s.strokes);
}
template <class V>
void visit(V& v, RunReports& s) {
  v("now", s.now), v("kept", s.kept);
}

/// Its bytes and the reverse, like write_state() and read_state() of RunState.
std::string write_report(const RunReports& reports);
RunReports read_report(const std::string& bytes);

}  // namespace pliant
