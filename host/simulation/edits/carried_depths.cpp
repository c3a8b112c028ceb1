#include "simulation/edits/carried_depths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "geometry/vec.h"
#include "model/contact/contact.h"
#include "schedule/program_layout.h"

namespace pliant {
namespace {

/// The shares of points that hang on held nodes.
class HeldParts {
 public:
  explicit HeldParts(const Program& program) : held_(program.at(program.find("contact_held")).reals) {}
  [[nodiscard]] double of(std::size_t i) const { return held_[tile_base(i, 4) + std::size_t{3} * PLIANT_TILE]; }

 private:
  const std::vector<double>& held_;
};

/// A point near a tool: how much of it is held, and its two numbers in contact_start.
struct NearPoint {
  double held = 0;
  std::array<double, 2> start{};
};

struct NearPoints {
  std::map<std::pair<std::int32_t, Vec3d>, NearPoint> at;  ///< by body and place at rest
  vec::Box box;                                            ///< of these places
};

NearPoints points_near_tools(const RunContext& run, BufferId starts) {
  const ContactPoints& points = *run.model().contact;
  const Program& program = run.loaded.program();
  const std::vector<std::int32_t> near = run.backend().read_ints(program.find("contact_near"));
  const HeldParts held(program);
  NearPoints out;
  std::vector<double> start;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if ((near[i / PLIANT_TILE] & ~PLIANT_TOUCH_BIT) == 0) continue;
    if (start.empty()) start = run.backend().read_reals(starts);
    const std::size_t base = tile_base(i, 2);
    out.at.emplace(std::pair{points.body[i], points.rest[i]}, NearPoint{held.of(i), {start[base], start[base + PLIANT_TILE]}});
    out.box.extend(points.rest[i]);
  }
  return out;
}

/// Changes of the step by a smaller factor change forces by less than a quarter, which contact takes as any change of motion.
constexpr double kSudden = 0.9;

/// Writes into the numbers of a point that the depth that is taken back in each step shrinks to `square` of itself, and that
/// the rest is left to it (start_depth in kernels/contact/press_lanes.cl).
void mark_step(double square, double& depth, double& tool) {
  if (depth < 0 || tool == 0) {
    depth = (depth < 0 ? 1 + depth : 1) * square - 1;
  } else {  // what is behind the point is from a change since which no step was done
    tool = std::floor(tool) + 1 - (1 - (tool - std::floor(tool))) * square;
  }
}

}  // namespace

void mark_freed(const RunContext& run, const Model& next, Program& program) {
  const BufferId to = program.find("contact_start");
  if (to < 0 || run.model().contact == nullptr || run.model().contact->size() != next.contact->size()) return;
  const HeldParts before(run.loaded.program()), now(program);
  for (std::size_t i = 0; i < next.contact->size(); ++i) {
    if (before.of(i) != now.of(i)) program.at(to).reals[tile_base(i, 2)] = -1;
  }
}

void carry_depths(const RunContext& run, const Model& next, Program& program) {
  const BufferId from = run.loaded.program().find("contact_start"), to = program.find("contact_start");
  if (from < 0 || to < 0) return;
  const NearPoints before = points_near_tools(run, from);
  if (before.at.empty()) return;
  const HeldParts held(program);
  std::vector<double>& start = program.at(to).reals;
  start.assign(program.at(to).values(), 0.0);
  for (std::size_t i = 0; i < next.contact->size(); ++i) {
    const std::size_t base = tile_base(i, 2);
    start[base] = -1;
    if (before.box.distance2(next.contact->rest[i]) > 0) continue;
    const auto found = before.at.find({next.contact->body[i], next.contact->rest[i]});
    if (found == before.at.end() || found->second.held != held.of(i)) continue;
    start[base] = found->second.start[0];
    start[base + PLIANT_TILE] = found->second.start[1];
  }
}

void follow_step(const RunContext& run, double ratio) {
  const Program& program = run.loaded.program();
  const BufferId yields = program.find("contact_yield"), starts = program.find("contact_start");
  if (yields < 0) return;
  std::vector<double> yield = run.backend().read_reals(yields);
  const double square = ratio * ratio;
  if (starts >= 0 && ratio < kSudden) {
    std::vector<double> start = run.backend().read_reals(starts);
    for (std::size_t i = 0; i < yield.size(); ++i) {
      if (yield[i] > 0) mark_step(square, start[tile_base(i, 2)], start[tile_base(i, 2) + PLIANT_TILE]);
    }
    run.backend().write_reals(starts, start);
  }
  for (double& y : yield) y *= square;  // the compliance in one step
  run.backend().write_reals(yields, yield);
}

}  // namespace pliant
