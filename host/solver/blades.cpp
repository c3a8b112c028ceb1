// When blades cut: those of the scene at the start of batches, those of the host when it says so.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cutting/blade.h"
#include "model/vec.h"
#include "pliant/error.h"
#include "solver/cut_state.h"
#include "solver/simulation.h"

namespace pliant {
namespace {

constexpr double kFrame = 1.0 / 60;  // [s]

/// What a blade sweeps from one time to another, along every row of its path in between.
void add_sweep(const Blade& blade, double from, double to, std::vector<SweepTriangle>& triangles) {
  from = std::max({from, blade.start, blade.path.front()[0]});
  to = std::min({to, blade.end, blade.path.back()[0]});
  if (!(from < to)) return;
  std::array<Vec3d, 2> at = blade.at(from);
  const auto move_to = [&](double time) {
    const std::array<Vec3d, 2> next = blade.at(time);
    const std::vector<SweepTriangle> part = sweep(at, next);
    triangles.insert(triangles.end(), part.begin(), part.end());
    at = next;
  };
  for (const auto& row : blade.path) {
    if (row[0] > from && row[0] < to) move_to(row[0]);
  }
  move_to(to);
}

}  // namespace

/// A look at the blades every sixtieth of a second; the bodies are filled once more, to be cut.
void Simulation::prepare_blades() {
  if (scene_.blades.empty()) return;
  cuts_ = std::make_shared<CutState>(scene_);
  const double steps = kFrame / first_dt_;
  blade_steps_ = steps < 1 ? 1 : static_cast<std::int64_t>(std::min(steps, static_cast<double>(batch_steps_)));
}

/// Batches begin at the same steps however a run is cut into pieces, and between steps of shape matching. Tissue is cut where
/// the blade moves; tissue that moves across a resting blade is not.
void Simulation::move_blades() {
  std::vector<SweepTriangle> triangles = std::move(pending_);
  pending_.clear();
  if (!scene_.blades.empty()) {
    std::vector<double>& seen = state_.vectors["blade_time"];
    const double now = time();
    if (seen.empty()) seen = {now};
    for (const Blade& blade : scene_.blades) add_sweep(blade, seen[0], now, triangles);
    seen[0] = std::max(seen[0], now);
  }
  if (!triangles.empty()) cut_now(triangles);
}

CutReport Simulation::cut(std::span<const std::array<Vec3d, 3>> triangles) {
  for (const SweepTriangle& t : triangles) {
    for (const Vec3d& p : t) {
      if (!vec::finite(p)) {
        throw Error(fmt::format("cut: got a triangle with the corner [{}] m; allowed are finite numbers", fmt::join(p, ", ")));
      }
    }
  }
  if (phase() == 0) return cut_now(triangles);
  pending_.insert(pending_.end(), triangles.begin(), triangles.end());
  return {};
}

CutReport Simulation::move_blade(const std::string& blade, const std::array<Vec3d, 2>& segment) {
  if (!vec::finite(segment[0]) || !vec::finite(segment[1]) || segment[0] == segment[1]) {
    throw Error(fmt::format("blade '{}': got a segment from [{}] m to [{}] m; allowed are two different finite points", blade,
                            fmt::join(segment[0], ", "), fmt::join(segment[1], ", ")));
  }
  const std::vector<double> now{segment[0][0], segment[0][1], segment[0][2], segment[1][0], segment[1][1], segment[1][2]};
  const auto known = state_.vectors.find("blade/" + blade);
  CutReport report;
  if (known != state_.vectors.end() && known->second.size() == 6) {
    const std::vector<double>& p = known->second;
    report = cut(sweep({Vec3d{p[0], p[1], p[2]}, Vec3d{p[3], p[4], p[5]}}, segment));
  }
  state_.vectors["blade/" + blade] = now;
  return report;
}

}  // namespace pliant
