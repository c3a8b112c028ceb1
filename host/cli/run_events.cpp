#include "cli/run_events.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "cli/run_loop.h"
#include "geometry/vec.h"
#include "model/pieces.h"

namespace pliant::cli {
namespace {

constexpr double kFarAway = 20;  ///< in sizes of a body

bool over(const Blade& blade, double now, double dt) { return now >= blade.ends() - kStepSlack * dt; }

}  // namespace

RunEvents run_events(const Simulation& simulation) {
  const RunState& state = simulation.state();
  RunEvents events;
  const bool removes = blade_method(simulation.scene()) == BladeMethod::removal;
  for (const CutRecord& cut : state.cuts)
    (removes ? events.removed_elements : events.cut_edges) += static_cast<std::int64_t>(cut.edges.size());
  events.cut_edges = std::max<std::int64_t>(0, events.cut_edges - state.opened);
  for (const TearRecord& tear : state.tears) events.broken_faces += std::popcount(static_cast<unsigned>(tear.broken()));
  events.broken_faces /= 2;  // each is a face of two elements
  for (std::size_t b = 0; b < simulation.model().bodies.size(); ++b) {
    events.pieces += pieces_of(simulation.model().bodies[b]);
    events.cut_in_part += simulation.cut_in_part(b);
    for (const Vec3d& u : simulation.displacements(b))
      events.max_displacement = std::max(events.max_displacement, vec::norm(u));
  }
  return events;
}

std::vector<std::string> parts_far_away(const Simulation& simulation) {
  std::vector<std::string> sentences;
  for (std::size_t b = 0; b < simulation.model().bodies.size(); ++b) {
    const ModelBody& body = simulation.model().bodies[b];
    vec::Box box;
    for (const Vec3d& x : body.rest) box.extend(x);
    const double size = vec::norm(vec::sub(box.upper, box.lower));
    double farthest = 0;
    for (const Vec3d& u : simulation.displacements(b)) farthest = std::max(farthest, vec::norm(u));
    if (farthest <= kFarAway * size) continue;
    sentences.push_back(
        fmt::format("body '{}': some of it is {:.3g} m from its place at rest, {:.3g} times its size: nothing holds that part "
                    "(a piece that comes off keeps its velocity and its share of a force)",
                    body.name, farthest, farthest / size));
  }
  return sentences;
}

std::vector<std::string> blades_without_contact(const Simulation& simulation, bool certain) {
  const BladeState& state = simulation.state().blades;
  const double now = certain ? state.seen.value_or(0) : simulation.time();
  std::vector<std::string> names;
  for (const Blade& blade : simulation.scene().blades) {
    if (over(blade, now, simulation.dt()) && std::find(state.met.begin(), state.met.end(), blade.name) == state.met.end())
      names.push_back(blade.name);
  }
  return names;
}

std::vector<std::string> blades_without_effect(const Simulation& simulation) {
  const RunState& state = simulation.state();
  if (std::any_of(state.cuts.begin(), state.cuts.end(), [](const CutRecord& cut) { return !cut.edges.empty(); })) return {};
  if (parts_along_faces(simulation.scene()) && !state.tears.empty()) return {};
  std::vector<std::string> names;
  for (const Blade& blade : simulation.scene().blades) {
    const bool met = std::find(state.blades.met.begin(), state.blades.met.end(), blade.name) != state.blades.met.end();
    if (met && over(blade, simulation.time(), simulation.dt())) names.push_back(blade.name);
  }
  return names;
}

std::vector<const Blade*> blades_to_come(const Simulation& simulation) {
  std::vector<const Blade*> blades;
  for (const Blade& blade : simulation.scene().blades) {
    if (simulation.time() < blade.begins()) blades.push_back(&blade);
  }
  return blades;
}

}  // namespace pliant::cli
