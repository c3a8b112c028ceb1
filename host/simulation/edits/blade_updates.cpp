// Blade updates: blades of the scene at the start of batches, blades of the host on request.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cutting/blade/blade_trace.h"
#include "geometry/stopwatch.h"
#include "geometry/vec.h"
#include "pliant/error.h"
#include "simulation/edits/topology_edits.h"

namespace pliant {
namespace {

/// Returns the motion of a blade between two times, along every row of its path in between. Empty if it does not cut then.
BladeMove move_of(const Blade& blade, double from, double to) {
  BladeMove move{blade.name, {}, {}};
  from = std::max(from, blade.begins());
  to = std::min(to, blade.ends());
  if (!(from < to)) return move;
  move.from = blade.at(from);
  for (const auto& row : blade.path) {
    if (row[0] > from && row[0] < to) move.to.push_back(blade.at(row[0]));
  }
  move.to.push_back(blade.at(to));
  return move;
}

/// Returns true if part of a blade is inside material, not just near it.
bool in_material(const BladeTrace& trace) {
  return std::any_of(trace.points.begin(), trace.points.end(), [](const TracePoint& p) { return p.carried.cell >= 0; });
}

/// What a blade sweeps where it is, whatever the tissue does meanwhile.
std::vector<SweepTriangle> triangles_of(const BladeMove& move) {
  std::vector<SweepTriangle> all;
  BladeSegment at = move.from;
  for (const BladeSegment& place : move.to) {
    const std::vector<SweepTriangle> swept = sweep(at, place);
    all.insert(all.end(), swept.begin(), swept.end());
    at = place;
  }
  return all;
}

/// Puts blades back to where they are now, for an edit that is refused later.
std::function<void()> return_of(BladeState& blades) {
  return [&blades, before = blades] {
    blades.placed = before.placed;
    blades.traces = before.traces;
    blades.met = before.met;
  };
}

vec::Box box_of(const std::vector<Vec3d>& x) {
  vec::Box box;
  for (const Vec3d& p : x) box.extend(p);
  return box;
}

}  // namespace

void TopologyEdits::move_scene_blades() {
  BladeState& blades = run_.state.blades;
  const PendingEdits pending = std::exchange(run_.state.pending, {});
  std::vector<BladeMove> moves = pending.moves;
  if (!run_.scene.blades.empty()) {
    const double now = run_.state.clock.time();
    if (!blades.seen) blades.seen = now;
    for (const Blade& blade : run_.scene.blades) {
      if (blade.cuts == BladeCuts::always) moves.push_back(move_of(blade, *blades.seen, now));
    }
    if (now > *blades.seen) blades.seen = now;
  }
  const bool asked = !pending.triangles.empty() || !pending.moves.empty();
  if (asked || !moves.empty()) run_blades(moves, pending.triangles, asked);
}

/// The same for blades that cut by force.
void TopologyEdits::move_fronts() {
  if (run_.settings.force_blades == 0 || run_.phase() != 0) return;
  EditedBodies& all = cut_bodies();
  std::vector<double> u = run_.u();
  CutReport report;
  const Stopwatch clock;
  const double next = run_.state.clock.time_at(run_.state.clock.step + run_.settings.blade_steps);
  std::vector<CutEdges> edges = fronts_.update(all, u, next);
  for (const CutEdges& e : edges) report.edges += static_cast<std::int64_t>(e.size());
  report.search = clock.seconds();
  if (report.edges > 0) {
    divide(std::move(edges), std::move(u), report);
  } else {
    known_u_ = std::move(u);
  }
  std::vector<std::string>& met = run_.state.blades.met;
  for (const auto& [name, blade] : run_.state.pressed) {
    const bool meets = std::any_of(blade.samples.begin(), blade.samples.end(),
                                   [](const FrontSample& s) { return s.kind == static_cast<std::int32_t>(FrontKind::held); });
    if (meets && std::find(met.begin(), met.end(), name) == met.end()) met.push_back(name);
  }
}

const BladeTrace* TopologyEdits::front(const BladeMove& move, std::size_t body) const {
  const auto blade = run_.state.blades.traces.find(move.key);
  if (blade == run_.state.blades.traces.end()) return nullptr;
  const auto found = blade->second.find(static_cast<std::int32_t>(body));
  return found == blade->second.end() ? nullptr : &found->second;
}

/// Cuts edges, opens the faces between pairs of elements, or removes elements.
void TopologyEdits::divide(std::vector<CutEdges> crossed, std::vector<double> u, CutReport& report) {
  if (remakes_elements(run_.scene)) return remake(std::move(crossed), std::move(u), report);
  if (!parts_along_faces(run_.scene)) return make_cut(std::move(crossed), std::move(u), report);
  std::vector<std::vector<TetFace>> faces;
  for (std::size_t b = 0; b < crossed.size(); ++b) faces.push_back(bodies().swept(b)->faces(crossed[b]));
  part(faces, std::move(u), true, report);
}

/// Follows each blade along its motion, and cuts.
CutReport TopologyEdits::run_blades(const std::vector<BladeMove>& moves, std::span<const SweepTriangle> triangles, bool asked) {
  EditedBodies& all = cut_bodies();
  CutReport report;
  report.asked = asked;
  const Stopwatch clock;
  std::vector<CutEdges> edges(run_.scene.bodies.size());
  std::vector<double> u = run_.u();
  std::map<std::string, std::map<std::int32_t, BladeTrace>> traces;
  std::vector<std::string> met = run_.state.blades.met;
  for (std::size_t b = 0; b < edges.size(); ++b) {
    const std::vector<Vec3d> x = run_.loaded.positions(u, b);
    if (!reached(b, x, moves, triangles)) continue;
    edges[b] = all.crossed(b, x, triangles);
    const auto meet = [&](const BladeMove& move) {
      if (std::find(met.begin(), met.end(), move.key) == met.end()) met.push_back(move.key);
    };
    if (all.follows_at_rest(b)) {
      BladeSweep sweep = all.sweep(b, x);
      for (const BladeMove& move : moves) {
        if (move.to.empty()) continue;
        const BladeTrace* known = front(move, b);
        BladeTrace trace = known != nullptr ? *known : BladeTrace{move.from, 0, {}};
        const std::size_t before = sweep.crossed().size();
        for (const BladeSegment& place : move.to) sweep.move(trace, place);
        if (sweep.crossed().size() > before || in_material(trace)) meet(move);
        if (!trace.points.empty()) traces[move.key][static_cast<std::int32_t>(b)] = std::move(trace);
      }
      edges[b].insert(sweep.crossed().begin(), sweep.crossed().end());
    } else {
      for (const BladeMove& move : moves) {
        const CutEdges met_now = all.crossed(b, x, triangles_of(move));
        if (!met_now.empty()) meet(move);
        edges[b].insert(met_now.begin(), met_now.end());
      }
    }
    all.keep_allowed(b, edges[b]);
    report.edges += static_cast<std::int64_t>(edges[b].size());
  }
  report.search = clock.seconds();
  std::vector<char> met_edges;
  met_edges.reserve(edges.size());
  for (const CutEdges& of_body : edges) met_edges.push_back(static_cast<char>(!of_body.empty()));
  if (report.edges > 0) divide(std::move(edges), std::move(u), report);
  if (report.pending) under_way_->also_undo(return_of(run_.state.blades));
  for (auto& [key, by_body] : traces) {
    for (auto& [b, trace] : by_body) {
      if (report.changed && met_edges[static_cast<std::size_t>(b)] != 0) all.follow(static_cast<std::size_t>(b), trace);
    }
  }
  for (const BladeMove& move : moves) {
    // A blade that does not move, as when a batch is repeated, keeps its trace.
    if (!move.to.empty()) run_.state.blades.traces.erase(move.key);
  }
  run_.state.blades.traces.merge(traces);
  run_.state.blades.met = std::move(met);
  return report;
}

/// Returns true if anything that cuts may come near a body.
bool TopologyEdits::reached(std::size_t body, const std::vector<Vec3d>& x, const std::vector<BladeMove>& moves,
                            std::span<const SweepTriangle> triangles) const {
  vec::Box reach = box_of(x);
  double size = 0;
  for (int a = 0; a < 3; ++a) size = std::max(size, reach.upper[a] - reach.lower[a]);
  for (int a = 0; a < 3; ++a) {
    reach.lower[a] -= 0.25 * size;
    reach.upper[a] += 0.25 * size;
  }
  for (const SweepTriangle& t : triangles) {
    if (reach.overlaps(box_of({t[0], t[1], t[2]}))) return true;
  }
  for (const BladeMove& move : moves) {
    if (move.to.empty()) continue;
    if (front(move, body) != nullptr) return true;
    vec::Box path = box_of({move.from[0], move.from[1]});
    for (const BladeSegment& place : move.to) path.extend(box_of({place[0], place[1]}));
    if (reach.overlaps(path)) return true;
  }
  return false;
}

CutReport TopologyEdits::cut(std::span<const SweepTriangle> triangles) {
  for (const SweepTriangle& t : triangles) {
    for (const Vec3d& p : t) {
      if (!vec::finite(p)) {
        throw Error(ErrorCode::bad_input,
                    fmt::format("cut: got a triangle with the corner [{}] m; allowed are finite numbers", fmt::join(p, ", ")));
      }
    }
  }
  settle();
  if (run_.phase() == 0) return run_blades({}, triangles, true);
  cut_bodies();  // throws for a scene that cannot be cut
  auto& pending = run_.state.pending.triangles;
  pending.insert(pending.end(), triangles.begin(), triangles.end());
  return {};
}

CutReport TopologyEdits::move_blades(std::span<const BladePose> poses) {
  for (const auto& [blade, segment] : poses) {
    if (vec::finite(segment[0]) && vec::finite(segment[1]) && segment[0] != segment[1]) continue;
    throw Error(ErrorCode::bad_input,
                fmt::format("blade '{}': got a segment from [{}] m to [{}] m; allowed are two different finite points", blade,
                            fmt::join(segment[0], ", "), fmt::join(segment[1], ", ")));
  }
  settle();
  auto placed = run_.state.blades.placed;
  std::vector<BladeMove> moves;
  for (const auto& [blade, segment] : poses) {
    const std::string key = "host/" + blade;
    const auto [before, fresh] = placed.try_emplace(blade, segment);
    if (fresh) continue;
    const auto move = std::find_if(moves.begin(), moves.end(), [&](const BladeMove& m) { return m.key == key; });
    if (move == moves.end())
      moves.push_back({key, before->second, {segment}});
    else
      move->to.push_back(segment);
    before->second = segment;
  }
  CutReport report;
  if (!moves.empty() && run_.phase() == 0) {
    report = run_blades(moves, {}, true);
  } else if (!moves.empty()) {
    cut_bodies();
    auto& pending = run_.state.pending.moves;
    pending.insert(pending.end(), moves.begin(), moves.end());
  }
  run_.state.blades.placed = std::move(placed);
  return report;
}

void TopologyEdits::lift_blade(const std::string& blade) {
  run_.state.blades.placed.erase(blade);
  run_.state.blades.traces.erase("host/" + blade);
}

}  // namespace pliant
