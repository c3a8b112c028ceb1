// Edits that change the model of cells but not the elements: the operational region that follows the tool, and hybrids that
// continue with fewer substeps. Every node keeps its position and momentum.
#include <Eigen/Dense>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geometry/vec.h"
#include "model/matching/partition.h"
#include "pliant/error.h"
#include "simulation/contact/tool_changes.h"
#include "simulation/edits/model_swap.h"
#include "simulation/edits/topology_edits.h"
#include "simulation/recovery/limits.h"

namespace pliant {
namespace {

double distance(const Vec3d& a, const Vec3d& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// From a point to a segment [m].
double distance(const Vec3d& x, const BladeSegment& s) {
  const Vec3d along = vec::sub(s[1], s[0]);
  const double square = vec::dot(along, along);
  if (!(square > 0)) return distance(x, s[0]);
  const double t = std::clamp(vec::dot(vec::sub(x, s[0]), along) / square, 0.0, 1.0);
  return distance(x, vec::add(s[0], vec::mul(along, t)));
}

/// The node that is nearest to a point now.
std::size_t nearest(const ModelBody& body, const std::vector<Vec3d>& u, const BladeSegment& place) {
  std::size_t best = 0;
  double least = -1;
  for (std::size_t n = 0; n < body.rest.size(); ++n) {
    const double d = distance(vec::add(body.rest[n], u[n]), place);
    if (least >= 0 && !(d < least)) continue;
    least = d;
    best = n;
  }
  return best;
}

/// The rest position of the material that is nearest to a segment now: many nodes are about as near to one that passes through,
/// and the one in their middle does not jump along it when it moves.
Vec3d nearest_at_rest(const ModelBody& body, const std::vector<Vec3d>& u, const BladeSegment& place) {
  const std::size_t best = nearest(body, u, place);
  if (place[0] == place[1]) return body.rest[best];
  const double reach = distance(vec::add(body.rest[best], u[best]), place) + body.spacing;
  Vec3d sum{};
  double count = 0;
  for (std::size_t n = 0; n < body.rest.size(); ++n) {
    const Vec3d x = vec::add(body.rest[n], u[n]);
    if (!(distance(x, place) <= reach)) continue;
    sum = vec::add(sum, x);
    ++count;
  }
  const Vec3d middle = vec::mul(sum, 1 / count);
  return body.rest[nearest(body, u, {middle, middle})];
}

/// Where the named thing is now, as a segment or a point; nothing while it is nowhere.
std::optional<BladeSegment> place_of(const RunContext& run, const std::string& name) {
  const RunState& state = run.state;
  const double now = state.clock.time();
  if (name == kFocus) {
    const Vec3d x = state.focus.value_or(run.scene.focus.position(now));
    return BladeSegment{x, x};
  }
  if (name.starts_with(kHostBlade)) {
    const auto found = state.blades.placed.find(name.substr(std::string_view(kHostBlade).size()));
    if (found == state.blades.placed.end()) return {};
    return found->second;
  }
  for (const Blade& blade : run.scene.blades) {
    if (blade.name == name) return blade_place(state.driven_blades, blade, now);
  }
  const std::vector<ContactTool> tools = present_tools(run.scene, state.tools);
  for (std::size_t t = 0; t < tools.size(); ++t) {
    if (tools[t].name != name) continue;
    const Pose pose = tool_pose(tools[t], state, now);
    const ToolForm& form = (*run.model().tools)[t];
    if (form.shape == ToolShape::capsule) return BladeSegment{place(pose, form.first), place(pose, form.second)};
    Vec3d middle{};  // of the box around a mesh
    for (std::size_t c = 0; c < 3 && form.grid.spacing > 0; ++c)
      middle[c] = form.grid.origin[c] + 0.5 * form.grid.spacing * (form.grid.size[c] - 1);
    return BladeSegment{place(pose, middle), place(pose, middle)};
  }
  return {};
}

/// At large strain shape matching and finite elements have different forces, and shape matching even folds, so a cell that
/// changes its model there would lose or gain energy. Below this stretch, and above its inverse, they are similar enough.
constexpr double kMostStretch = 1.5;
constexpr double kFreeShare = 1.0 / 3;    ///< of the radius of a region: how far the tool may go before the region moves
constexpr double kNextFrame = 1.0 / 60;   ///< a frame has no time to load a model and to check its step [s]
constexpr std::int64_t kWaitSteps = 256;  ///< interval after which such a cell is checked again

/// Returns true if a cell is deformed too far to change its model. corners: x fastest; u by node.
bool strained(const std::array<std::int32_t, 8>& corners, double spacing, const std::vector<Vec3d>& u) {
  Eigen::Matrix<double, 3, 8> x;
  Eigen::Matrix<double, 8, 3> sides;
  for (int a = 0; a < 8; ++a) {
    const Eigen::RowVector3d at(a & 1, a >> 1 & 1, a >> 2 & 1);
    x.col(a) = spacing * at.transpose() + Eigen::Map<const Eigen::Vector3d>(u[static_cast<std::size_t>(corners[a])].data());
    sides.row(a) = (2 * at.array() - 1) / 4;
  }
  const double volume = (x * sides).determinant() / std::pow(spacing, 3);  // relative volume of the mean edges
  if (!(volume > 1 / kMostStretch)) return true;
  for (int a = 0; a < 8; ++a) {
    for (int b = a + 1; b < 8; ++b) {
      const double stretch = (x.col(a) - x.col(b)).norm() / (spacing * std::sqrt(std::popcount(static_cast<unsigned>(a ^ b))));
      if (!(stretch < kMostStretch && stretch > 1 / kMostStretch)) return true;
    }
  }
  return false;
}

/// How far the material under the tool may be from the seed of the region [m]: a third of the radius of a ball with as many
/// cells, at least a cell. A move takes as long as a picture; a region that follows each cell makes twice as many.
double tool_may_go(const ModelBody& body) {
  const double radius = std::cbrt(3 * static_cast<double>(body.operational_elements) / (4 * std::numbers::pi));
  return std::max(1.0, kFreeShare * radius) * body.spacing;
}

}  // namespace

MovedRegion TopologyEdits::region_at(std::size_t b, const Vec3d& seed, const std::vector<Vec3d>& u) {
  MovedRegion region{seed, {}, false};
  const BodyMesh& solid = bodies().solid(b);
  const auto chosen = [&](const Body& body) { return partition_lattice(body, *solid.lattice).operational; };
  Body next = run_.scene.bodies[b];
  next.model.seed = seed;
  std::vector<char> operational = chosen(next);
  const std::vector<char> before = chosen(scene_at(run_.state).bodies[b]);
  const std::size_t elements = solid.copy_of.empty() ? before.size() : solid.copy_of.size();
  for (std::size_t e = 0; e < elements; ++e) {
    const std::size_t c = solid.copy_of.empty() ? e : static_cast<std::size_t>(solid.copy_of[e]);
    if (operational[c] == before[c]) continue;
    const std::array<std::int32_t, 8> corners = solid.tets.empty() ? solid.hexes[e] : cell_corners(&solid.tets[6 * e]);
    if (!strained(corners, run_.model().bodies[b].spacing, u)) continue;
    operational[c] = before[c];
    region.waits = true;
  }
  for (std::size_t c = 0; c < operational.size(); ++c) {
    if (operational[c] != 0) region.cells.push_back(static_cast<std::int32_t>(c));
  }
  return region;
}

/// A region moves when the material under the tool is further from its seed than tool_may_go(), and only between steps of
/// shape matching.
void TopologyEdits::move_regions() {
  const auto& bodies_of_scene = run_.scene.bodies;
  if (std::none_of(bodies_of_scene.begin(), bodies_of_scene.end(), [](const Body& b) { return !b.model.follow.empty(); }))
    return;
  if (run_.phase() != 0) return;
  const RunState& state = run_.state;
  std::vector<double> u = run_.u();
  const bool first = state.regions.empty();
  std::vector<std::pair<std::size_t, MovedRegion>> found;
  bool moved = false;
  for (std::size_t b = 0; b < bodies_of_scene.size(); ++b) {
    const DeformationModel& model = bodies_of_scene[b].model;
    if (model.follow.empty()) continue;
    const std::optional<BladeSegment> place = place_of(run_, model.follow);
    const std::vector<Vec3d> of_body = run_.loaded.pick(u, b, 1);
    const std::optional<Vec3d> seed = first ? model.seed : state.regions[b].seed;
    // Before it is anywhere, the region stays, or begins in the middle.
    if (!place && (first || !seed)) continue;
    const Vec3d now = place ? nearest_at_rest(run_.model().bodies[b], of_body, *place) : *seed;
    const bool moves = !seed || distance(now, *seed) > tool_may_go(run_.model().bodies[b]);
    const bool again = !first && state.regions[b].waits && run_.begins_after(state.clock.step, kWaitSteps);
    if (!first && !moves && !again) continue;
    found.emplace_back(b, region_at(b, moves ? now : *seed, of_body));
    moved = moved || moves || (!first && found.back().second.cells != state.regions[b].cells);
  }
  if (!moved) return;
  std::vector<MovedRegion> regions = state.regions;
  regions.resize(bodies_of_scene.size());
  for (auto& [b, region] : found) regions[b] = std::move(region);
  ModelEdit edit;
  edit.keeps_bodies = true;
  edit.scene = [this, regions] {
    std::vector<MovedRegion> before = std::exchange(run_.state.regions, regions);
    Scene scene = scene_at(run_.state);
    run_.state.regions = std::move(before);
    return scene;
  };
  edit.edit = [bodies = bodies_of_scene.size()](CutReport& made) {
    made.changed = true;
    return std::vector<NodeOrigins>(bodies);
  };
  edit.record = [this, regions](const ModelSwap&, CutReport&) {
    run_.state.regions = regions;
    if (beside_) {
      check_after_ = run_.state.clock.time() + kNextFrame;
    } else {
      step_.adapt_after_move();
    }
  };
  CutReport report;
  perform(std::move(edit), std::move(u), report);
}

void TopologyEdits::load_scene(const std::vector<std::size_t>& remodelled) {
  settle();
  std::vector<double> u = run_.u();
  std::vector<MovedRegion> regions = run_.state.regions;
  for (const std::size_t b : remodelled) {
    if (regions.empty() || run_.scene.bodies[b].model.follow.empty()) continue;
    regions[b] = region_at(b, regions[b].seed, run_.loaded.pick(u, b, 1));
  }
  std::vector<MovedRegion> before = std::exchange(run_.state.regions, std::move(regions));
  try {
    swap_partition(std::move(u), true);
  } catch (...) {
    run_.state.regions = std::move(before);
    throw;
  }
  bodies().follow_materials();
}

/// Held goals pull at the finite elements once in n substeps, n times as hard. If elements have stiffened since the last
/// step-size check, this is a resonance, which a shorter step avoids only below a thousandth (docs/stability.md).
bool TopologyEdits::fewer_substeps() {
  if (under_way_ != nullptr) return false;
  const std::vector<FlsmBatch>& batches = run_.model().flsm;
  const bool many = std::any_of(batches.begin(), batches.end(),
                                [](const FlsmBatch& b) { return b.interface > 0 && b.settings.substeps > kSafeSubsteps; });
  if (!many || run_.phase() != 0 || !run_.settings.automatic || !bodies_as_loaded()) return false;
  const std::int32_t before = std::exchange(run_.state.most_substeps, kSafeSubsteps);
  try {
    swap_partition(run_.u());
  } catch (...) {
    run_.state.most_substeps = before;
    throw;
  }
  return true;
}

bool TopologyEdits::bodies_as_loaded() {
  try {
    const EditedBodies& all = bodies();
    for (std::size_t b = 0; b < all.size(); ++b) {
      if (all.solid(b).nodes.size() != run_.model().bodies[b].rest.size()) return false;
    }
    return true;
  } catch (const Error&) {
    return false;
  }
}

void TopologyEdits::swap_partition(std::vector<double> u, bool keeps_state) {
  CutReport report;
  ModelSwap swap(run_, loads_, bodies(), report);
  if (keeps_state) swap.keep_state();
  swap.keep_bodies();
  swap.build(scene_at(run_.state), std::vector<NodeOrigins>(run_.scene.bodies.size()), [] {});
  swap.load(std::move(u));
}

}  // namespace pliant
