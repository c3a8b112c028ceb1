// What a run tells of itself afterwards. No step depends on it: checkpoints have it, so that a run that was interrupted tells
// what happened before; the deep hash and comparisons leave it out.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "simulation/state/run_state_parts.h"

namespace pliant {

/// Elements that had J <= 0 and went on.
struct Inversions {
  std::int64_t batches = 0;     ///< in how many batches there were some
  std::int64_t most = 0;        ///< most of them in one batch
  std::int64_t last = 0;        ///< in the last batch
  std::int64_t first_step = 0;  ///< the first batch with some began with this step
  double first_time = 0;        ///< [s]
  std::int64_t calmed = 0;      ///< elements that lost relative motion (recovery/calm.h), counted batch by batch
  std::string body;             ///< of one of the first
  std::int64_t element = -1;    ///< its number in the body
};

/// Inertia given to nodes whose elements asked for a shorter step than Scene::least_step.
struct BallastReport {
  std::int64_t nodes = 0;  ///< now
  double mass = 0;         ///< now [kg]
  double most = 0;         ///< at any time [kg]
};

/// What a tool feels: of one step, or the mean over the steps since somebody asked.
struct ToolLoad {
  Vec3d force{};     ///< on the tool [N]
  Vec3d torque{};    ///< about its origin [N m]
  double area = 0;   ///< of the tissue that touches it, at rest [m^2]
  double depth = 0;  ///< deepest point inside the tool, after contact [m]
  std::int64_t points = 0;
};

/// What became of a tool over a run.
struct ToolHistory {
  ToolLoad now;              ///< mean of the last batch
  double max_force = 0;      ///< of a batch's mean [N]
  double max_depth = 0;      ///< [m]
  double work = 0;           ///< done on the tissue by its rigid motion since the simulation was made [J]
  std::int64_t touched = 0;  ///< steps with contact
  Pose before;               ///< a step before `step`, of a sequence's frame: driven tools do not know their past
  std::int64_t step = -1;    ///< the end of the last batch with contact; -1: there was none
};

/// What became of the contact of tissue with tissue over a run.
struct TouchHistory {
  std::int64_t points = 0;  ///< points that touched in the last batch
  double max_depth = 0;     ///< deepest pair, after contact [m]
};

/// Energy that nothing put in (Simulation::watch_energy).
struct EnergyHistory {
  std::optional<double> least;      ///< less the work of the tools, at any look [J]; nothing: nobody has looked
  double created = 0, highest = 0;  ///< the highest rise above an earlier `least`; kinetic and strain energy, or the work [J]
  /// The first as a share of the second.
  [[nodiscard]] std::optional<double> share() const {
    if (!least) return {};
    return highest > 0 ? created / highest : 0;
  }
};

struct RunReport {
  Inversions inversions;
  BallastReport ballast;
  std::vector<ToolHistory> tools;  ///< one per tool of the model
  TouchHistory tissue;
  EnergyHistory energy;
  std::int64_t made_again = 0;  ///< batches that were gone back from (recovery/recovery.h)

  /// A batch that is made again has told nothing of what it went through: that is as it was in `kept`.
  void take_back(const RunReport& kept) {
    inversions = kept.inversions;
    tools = kept.tools;
    tissue = kept.tissue;
    ++made_again;
  }
};

/// With the report as of the kept state.
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
void visit(V& v, ToolHistory& s) {
  v("now", s.now), v("max_force", s.max_force), v("max_depth", s.max_depth), v("work", s.work), v("touched", s.touched);
  v("before", s.before), v("step", s.step);
}
template <class V>
void visit(V& v, TouchHistory& s) {
  v("points", s.points), v("max_depth", s.max_depth);
}
template <class V>
void visit(V& v, EnergyHistory& s) {
  v("least", s.least), v("created", s.created), v("highest", s.highest);
}
template <class V>
void visit(V& v, RunReport& s) {
  v("inversions", s.inversions), v("ballast", s.ballast), v("tools", s.tools), v("tissue", s.tissue), v("energy", s.energy);
  v("made_again", s.made_again);
}
template <class V>
void visit(V& v, RunReports& s) {
  v("now", s.now), v("kept", s.kept);
}

/// Its bytes and the reverse, like write_state() and read_state() of RunState.
std::string write_report(const RunReports& reports);
RunReports read_report(const std::string& bytes);

}  // namespace pliant
