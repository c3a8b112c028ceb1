// When blades cut: those of the scene at the start of batches, those of the host when it says so.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "cutting/blade_front.h"
#include "model/vec.h"
#include "pliant/error.h"
#include "solver/cut_state.h"
#include "solver/simulation.h"

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

std::vector<double> pack(const BladeFront& front) {
  std::vector<double> out{static_cast<double>(front.levels)};
  for (const Vec3d& end : front.blade) out.insert(out.end(), end.begin(), end.end());
  for (const FrontPoint& p : front.points) {
    out.insert(out.end(), {static_cast<double>(p.place), static_cast<double>(p.cell), static_cast<double>(p.tet)});
    out.insert(out.end(), p.weight.begin(), p.weight.end());
  }
  return out;
}

/// Empty if `packed` does not belong to the body: it came with a checkpoint.
std::optional<BladeFront> unpack(const std::vector<double>& packed, const CutMesh& mesh) {
  const auto within = [](double value, double count) { return value >= 0 && value < count; };
  if (packed.size() < 7 || packed.size() % 7 != 0 || !within(packed[0], 13)) return {};
  BladeFront front;
  front.levels = static_cast<int>(packed[0]);
  for (std::size_t i = 0; i < 6; ++i) front.blade[i / 3][i % 3] = packed[1 + i];
  for (std::size_t i = 7; i < packed.size(); i += 7) {
    if (!within(packed[i], (1 << front.levels) + 1) || !within(packed[i + 1], static_cast<double>(mesh.cells.size())) ||
        !within(packed[i + 2], static_cast<double>(mesh.shape->tets.size()))) {
      return {};
    }
    front.points.push_back({static_cast<std::int32_t>(packed[i]),
                            static_cast<std::int32_t>(packed[i + 1]),
                            static_cast<std::int32_t>(packed[i + 2]),
                            {packed[i + 3], packed[i + 4], packed[i + 5], packed[i + 6]}});
  }
  return front;
}

std::vector<Vec3d> straight(const BladeSegment& blade, int levels) {
  BladeFront front;
  front.blade = blade;
  front.levels = levels;
  return front_points(front);
}

vec::Box box_of(const std::vector<Vec3d>& x) {
  vec::Box box;
  for (const Vec3d& p : x) box.extend(p);
  return box;
}

}  // namespace

/// A look at the blades every sixtieth of a second; the bodies are filled once more, to be cut.
void Simulation::prepare_blades() {
  if (scene_.blades.empty()) return;
  cuts_ = std::make_shared<CutState>(scene_);
  const double steps = kFrame / first_dt_;
  blade_steps_ = steps < 1 ? 1 : static_cast<std::int64_t>(std::min(steps, static_cast<double>(batch_steps_)));
}

std::vector<Vec3d> Simulation::positions(std::size_t body) const {
  std::vector<Vec3d> x = displacements(body);
  for (std::size_t n = 0; n < x.size(); ++n) x[n] = vec::add(model_->bodies[body].rest[n], x[n]);
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
  if (scene_.integrator != Integrator::increment || scene_.relaxation.enabled) {
    throw Error("a scene with \"integrator\": \"textbook\" or with relaxation cannot be cut");
  }
  cuts_ = std::make_shared<CutState>(scene_);
  return *cuts_;
}

/// Sweep from where the material has carried each blade's last place to its new ones, and cut.
CutReport Simulation::run_blades(const std::vector<BladeMove>& moves, std::span<const SweepTriangle> triangles) {
  cut_state();
  vec::Box reach;
  for (const SweepTriangle& t : triangles) {
    for (const Vec3d& p : t) reach.extend(p);
  }
  for (const BladeMove& move : moves) {
    for (const BladeSegment& place : move.to) reach.extend(box_of({move.from[0], move.from[1], place[0], place[1]}));
  }
  std::vector<std::vector<SweepTriangle>> sweeps(scene_.bodies.size());
  std::vector<std::vector<Vec3d>> x(scene_.bodies.size());
  bool any = false;
  for (std::size_t b = 0; b < sweeps.size(); ++b) {
    x[b] = positions(b);
    if (!reach.overlaps(box_of(x[b]))) continue;
    any = true;
    const BodyCut& body = cuts_->body(scene_, b);
    sweeps[b].assign(triangles.begin(), triangles.end());
    for (const BladeMove& move : moves) {
      if (move.to.empty()) continue;
      const auto known = state_.vectors.find(front_key(move, b));
      std::optional<BladeFront> front;
      if (known != state_.vectors.end()) front = unpack(known->second, body.topology().mesh());
      const int levels = front ? front->levels : front_levels(move.from, body.edge());
      std::vector<Vec3d> line = front ? carried_front(*front, body.topology(), x[b]) : straight(move.from, levels);
      for (const BladeSegment& place : move.to) {
        const std::vector<SweepTriangle> part = sweep_to(line, place);
        sweeps[b].insert(sweeps[b].end(), part.begin(), part.end());
        line = straight(place, levels);
      }
    }
  }
  CutReport report;
  if (any) report = cut_now(sweeps, x);
  for (const BladeMove& move : moves) {
    for (std::size_t b = 0; b < sweeps.size(); ++b) {
      state_.vectors.erase(front_key(move, b));
      if (move.to.empty() || cuts_->bodies[b] == nullptr || sweeps[b].empty()) continue;
      if (report.changed) x[b] = positions(b);
      const BodyCut& body = *cuts_->bodies[b];
      const BladeSegment& place = move.to.back();
      const BladeFront front = hold_front(body.topology(), x[b], place, front_levels(place, body.edge()));
      if (!front.points.empty()) state_.vectors[front_key(move, b)] = pack(front);
    }
  }
  return report;
}

CutReport Simulation::cut(std::span<const std::array<Vec3d, 3>> triangles) {
  for (const SweepTriangle& t : triangles) {
    for (const Vec3d& p : t) {
      if (!vec::finite(p)) {
        throw Error(fmt::format("cut: got a triangle with the corner [{}] m; allowed are finite numbers", fmt::join(p, ", ")));
      }
    }
  }
  if (phase() == 0) return run_blades({}, triangles);
  auto& pending = cut_state().pending_triangles;
  pending.insert(pending.end(), triangles.begin(), triangles.end());
  return {};
}

CutReport Simulation::move_blade(const std::string& blade, const std::array<Vec3d, 2>& segment) {
  if (!vec::finite(segment[0]) || !vec::finite(segment[1]) || segment[0] == segment[1]) {
    throw Error(fmt::format("blade '{}': got a segment from [{}] m to [{}] m; allowed are two different finite points", blade,
                            fmt::join(segment[0], ", "), fmt::join(segment[1], ", ")));
  }
  std::vector<double>& place = state_.vectors["blade/" + blade];
  const std::vector<double> before = place;
  CutReport report;
  if (before.size() == 6) {
    const BladeSegment from{Vec3d{before[0], before[1], before[2]}, Vec3d{before[3], before[4], before[5]}};
    const BladeMove move{"host/" + blade, from, {segment}};
    if (phase() == 0) {
      report = run_blades({move}, {});
    } else {
      cut_state().pending_moves.push_back(move);
    }
  }
  state_.vectors["blade/" + blade] = {segment[0][0], segment[0][1], segment[0][2], segment[1][0], segment[1][1], segment[1][2]};
  return report;
}

}  // namespace pliant
