// When blades cut: those of the scene at the start of batches, those of the host when it says so.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "cutting/blade/blade_front.h"
#include "edits/cut_state.h"
#include "geometry/vec.h"
#include "pliant/error.h"
#include "simulation/simulation.h"

namespace pliant {
namespace {

constexpr double kFrame = 1.0 / 60;  // [s]

/// Where a blade goes from one time to another, along every row of its path in between. No places if it does not cut then.
BladeMove move_of(const Blade& blade, double from, double to) {
  BladeMove move{blade.name, {}, {}};
  from = std::max({from, blade.start, blade.path.front()[0]});
  to = std::min({to, blade.end, blade.path.back()[0]});
  if (!(from < to)) return move;
  move.from = blade.at(from);
  for (const auto& row : blade.path) {
    if (row[0] > from && row[0] < to) move.to.push_back(blade.at(row[0]));
  }
  move.to.push_back(blade.at(to));
  return move;
}

std::string front_key(const BladeMove& move, std::size_t body) { return fmt::format("front/{}/{}", body, move.key); }

constexpr std::size_t kFrontHead = 7, kFrontPoint = 11;

std::vector<double> pack(const BladeFront& front) {
  std::vector<double> out{static_cast<double>(front.levels)};
  for (const Vec3d& end : front.blade) out.insert(out.end(), end.begin(), end.end());
  for (const FrontPoint& p : front.points) {
    const CarriedPoint& c = p.carried;
    for (const std::int32_t i : {p.place, p.node, c.cell, c.tet}) out.push_back(static_cast<double>(i));
    out.insert(out.end(), c.weight.begin(), c.weight.end());
    out.insert(out.end(), c.rest.begin(), c.rest.end());
  }
  return out;
}

/// Empty if `packed` does not belong to the body: it came with a checkpoint.
std::optional<BladeFront> unpack(const std::vector<double>& packed, const CutMesh& mesh) {
  const auto within = [](double value, double low, double count) { return value >= low && value < count; };
  if (packed.size() < kFrontHead || (packed.size() - kFrontHead) % kFrontPoint != 0) return {};
  if (!within(packed[0], 0, kMostLevels + 1)) return {};
  BladeFront front;
  front.levels = static_cast<int>(packed[0]);
  for (std::size_t i = 0; i < 6; ++i) front.blade[i / 3][i % 3] = packed[1 + i];
  double place = -1;
  for (std::size_t i = kFrontHead; i < packed.size(); i += kFrontPoint) {
    const double* p = &packed[i];
    const bool carried = p[2] >= 0;
    if (!within(p[0], place + 1, std::ldexp(1.0, front.levels) + 1) || !within(p[0], 0, packed[kFrontHead] + (1 << 17)) ||
        !within(p[1], -1, static_cast<double>(mesh.rest.size())) || carried == (p[1] >= 0) ||
        !within(p[2], -1, static_cast<double>(mesh.cells.size())) ||
        !within(p[3], 0, static_cast<double>(mesh.shape->tets.size()))) {
      return {};
    }
    place = p[0];
    FrontPoint point{static_cast<std::int32_t>(p[0]), static_cast<std::int32_t>(p[1]), {}};
    point.carried = {
        static_cast<std::int32_t>(p[2]), static_cast<std::int32_t>(p[3]), {p[4], p[5], p[6], p[7]}, {p[8], p[9], p[10]}};
    front.points.push_back(point);
  }
  return front;
}

vec::Box box_of(const std::vector<Vec3d>& x) {
  vec::Box box;
  for (const Vec3d& p : x) box.extend(p);
  return box;
}

/// What the scene's file cannot hold, but a Scene made in memory can.
void check_blade(const Blade& blade) {
  const auto fail = [&](const std::string& what) {
    throw Error(ErrorCode::bad_input, fmt::format("blade '{}': {}", blade.name, what));
  };
  if (blade.path.size() < 2) fail(fmt::format("got a path of {} rows; allowed are two or more", blade.path.size()));
  for (std::size_t i = 0; i < blade.path.size(); ++i) {
    const auto& row = blade.path[i];
    const bool finite = std::all_of(row.begin(), row.end(), [](double v) { return std::isfinite(v); });
    if (!finite) fail(fmt::format("got [{}] in row {} of the path; allowed are finite numbers", fmt::join(row, ", "), i));
    if (Vec3d{row[1], row[2], row[3]} == Vec3d{row[4], row[5], row[6]}) {
      fail(fmt::format("both ends are [{}] m in row {} of the path; allowed are two different points",
                       fmt::join(row.begin() + 1, row.begin() + 4, ", "), i));
    }
    if (i > 0 && !(row[0] > blade.path[i - 1][0])) {
      fail(fmt::format("got {} s after {} s in row {} of the path; allowed are ascending times", row[0], blade.path[i - 1][0],
                       i));
    }
  }
}

}  // namespace

/// A look at the blades every sixtieth of a second; the bodies are filled once more, to be cut.
void Simulation::prepare_blades() {
  if (scene_.blades.empty()) return;
  for (const Blade& blade : scene_.blades) check_blade(blade);
  prepare_cuts();
  const double steps = kFrame / first_dt_;
  blade_steps_ = steps < 1 ? 1 : static_cast<std::int64_t>(std::min(steps, static_cast<double>(batch_steps_)));
}

std::vector<Vec3d> Simulation::positions(const std::vector<double>& u, std::size_t body) const {
  std::vector<Vec3d> x = model_->bodies[body].rest;
  for (std::size_t n = 0; n < x.size(); ++n) {
    const double* moved = &u[4 * static_cast<std::size_t>(model_->bodies[body].slot[n])];
    for (std::size_t c = 0; c < 3; ++c) x[n][c] += moved[c];
  }
  return x;
}

/// Batches begin at the same steps however a run is cut into pieces, and between steps of shape matching.
void Simulation::move_blades() {
  if (cuts_ == nullptr) return;
  const std::vector<SweepTriangle> triangles = std::exchange(cuts_->pending_triangles, {});
  std::vector<BladeMove> moves = std::exchange(cuts_->pending_moves, {});
  if (!scene_.blades.empty()) {
    std::vector<double>& seen = state_.vectors["blade_time"];
    const double now = time();
    if (seen.empty()) seen = {now};
    for (const Blade& blade : scene_.blades) moves.push_back(move_of(blade, seen[0], now));
    if (now > seen[0]) seen[0] = now;
  }
  if (!triangles.empty() || !moves.empty()) run_blades(moves, triangles);
}

CutState& Simulation::cut_state() {
  if (cuts_ != nullptr) return *cuts_;
  if (tears_ != nullptr) throw Error(ErrorCode::bad_input, "a scene with a material that tears (\"toughness\") cannot be cut");
  if (scene_.integrator != Integrator::increment || scene_.relaxation.enabled) {
    throw Error(ErrorCode::bad_input, "a scene with \"integrator\": \"textbook\" or with relaxation cannot be cut");
  }
  cuts_ = std::make_shared<CutState>(scene_);
  return *cuts_;
}

void Simulation::prepare_cuts() {
  CutState& cuts = cut_state();
  if (backend_->info().kind != "reference") {  // that has nothing to compile
    backend_->compile(build_program(cuts.trial_model(scene_), {scene_.integrator, batch_steps_}));
  }
  for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
    if (can_be_cut(*cuts.uncut[b])) static_cast<void>(cuts.body(scene_, b));
  }
  if (scene_.bodies.size() == 1) cuts.surface_copy.make(model_, cuts.helper);
}

/// Follow each blade to its new places, and cut.
CutReport Simulation::run_blades(const std::vector<BladeMove>& moves, std::span<const SweepTriangle> triangles) {
  cut_state();
  CutReport report;
  const auto start = std::chrono::steady_clock::now();
  std::vector<CutEdges> edges(scene_.bodies.size());
  std::vector<double> u = backend_->read_reals(u_);
  std::map<std::string, std::vector<double>> fronts;
  for (std::size_t b = 0; b < edges.size(); ++b) {
    const std::vector<Vec3d> x = positions(u, b);
    if (!reached(b, x, moves, triangles)) continue;
    BodyCut& body = cuts_->body(scene_, b);
    edges[b] = crossed_edges(body.topology(), x, triangles);
    BladeSweep sweep(body.topology(), x, body.rest_edges(), body.edge());
    for (const BladeMove& move : moves) {
      if (move.to.empty()) continue;
      const auto known = state_.vectors.find(front_key(move, b));
      std::optional<BladeFront> front;
      if (known != state_.vectors.end()) front = unpack(known->second, body.topology().mesh());
      if (!front) front = BladeFront{move.from, 0, {}};
      for (const BladeSegment& place : move.to) sweep.move(*front, place);
      if (!front->points.empty()) fronts[front_key(move, b)] = pack(*front);
    }
    edges[b].insert(sweep.crossed().begin(), sweep.crossed().end());
    body.keep_allowed(scene_.bodies[b], edges[b]);
    report.edges += static_cast<std::int64_t>(edges[b].size());
  }
  report.search = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (report.edges > 0) cut_now(edges, std::move(u), report);
  for (const BladeMove& move : moves) {
    for (std::size_t b = 0; b < edges.size(); ++b) state_.vectors.erase(front_key(move, b));
  }
  state_.vectors.merge(fronts);
  return report;
}

/// Whether anything that cuts may come near a body.
bool Simulation::reached(std::size_t body, const std::vector<Vec3d>& x, const std::vector<BladeMove>& moves,
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
    if (state_.vectors.contains(front_key(move, body))) return true;
    vec::Box path = box_of({move.from[0], move.from[1]});
    for (const BladeSegment& place : move.to) path.extend(box_of({place[0], place[1]}));
    if (reach.overlaps(path)) return true;
  }
  return false;
}

CutReport Simulation::cut(std::span<const std::array<Vec3d, 3>> triangles) {
  for (const SweepTriangle& t : triangles) {
    for (const Vec3d& p : t) {
      if (!vec::finite(p)) {
        throw Error(ErrorCode::bad_input,
                    fmt::format("cut: got a triangle with the corner [{}] m; allowed are finite numbers", fmt::join(p, ", ")));
      }
    }
  }
  if (phase() == 0) return run_blades({}, triangles);
  auto& pending = cut_state().pending_triangles;
  pending.insert(pending.end(), triangles.begin(), triangles.end());
  return {};
}

CutReport Simulation::move_blades(std::span<const BladePlace> places) {
  for (const auto& [blade, segment] : places) {
    if (vec::finite(segment[0]) && vec::finite(segment[1]) && segment[0] != segment[1]) continue;
    throw Error(ErrorCode::bad_input,
                fmt::format("blade '{}': got a segment from [{}] m to [{}] m; allowed are two different finite points", blade,
                            fmt::join(segment[0], ", "), fmt::join(segment[1], ", ")));
  }
  std::vector<BladeMove> moves;
  for (const auto& [blade, segment] : places) {
    const std::vector<double>& before = state_.vectors["blade/" + blade];
    if (before.size() != 6) continue;
    const BladeSegment from{Vec3d{before[0], before[1], before[2]}, Vec3d{before[3], before[4], before[5]}};
    moves.push_back({"host/" + blade, from, {segment}});
  }
  CutReport report;
  if (!moves.empty() && phase() == 0) {
    report = run_blades(moves, {});
  } else if (!moves.empty()) {
    auto& pending = cut_state().pending_moves;
    pending.insert(pending.end(), moves.begin(), moves.end());
  }
  for (const auto& [blade, segment] : places) {
    const auto& [a, b] = segment;
    state_.vectors["blade/" + blade] = {a[0], a[1], a[2], b[0], b[1], b[2]};
  }
  return report;
}

CutReport Simulation::move_blade(const std::string& blade, const std::array<Vec3d, 2>& segment) {
  const BladePlace place{blade, segment};
  return move_blades(std::span(&place, 1));
}

}  // namespace pliant
