// Edits that change how a body is modelled and leave its elements alone: the operational region that follows the tool, and
// hybrids that go on with fewer substeps. Every node keeps its position and momentum.
#include <algorithm>
#include <cmath>
#include <utility>

#include "edits/model_swap.h"
#include "edits/topology_edits.h"
#include "geometry/vec.h"
#include "pliant/error.h"

namespace pliant {
namespace {

double distance(const Vec3d& a, const Vec3d& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// The rest position of the node that is nearest to a point now.
Vec3d nearest_at_rest(const ModelBody& body, const std::vector<Vec3d>& u, const Vec3d& point) {
  std::size_t best = 0;
  double least = -1;
  for (std::size_t n = 0; n < body.rest.size(); ++n) {
    const Vec3d& x = body.rest[n];
    const double d = distance(vec::add(x, u[n]), point);
    if (least >= 0 && !(d < least)) continue;
    least = d;
    best = n;
  }
  return body.rest[best];
}

}  // namespace

/// A region moves when the material under the tool is more than a cell from its seed, and only between steps of shape matching.
void TopologyEdits::move_regions() {
  const auto& bodies_of_scene = run_.scene.bodies;
  if (std::none_of(bodies_of_scene.begin(), bodies_of_scene.end(), [](const Body& b) { return b.model.follow; })) return;
  if (run_.phase() != 0) return;
  const RunState& state = run_.state;
  const Vec3d tool = state.tool.value_or(run_.scene.tool.position(state.clock.time()));
  std::vector<double> u = run_.u();
  std::vector<Vec3d> seeds;
  bool moved = false;
  for (std::size_t b = 0; b < bodies_of_scene.size(); ++b) {
    const DeformationModel& model = bodies_of_scene[b].model;
    const bool known = !state.seeds.empty() || model.seed;
    Vec3d seed = !state.seeds.empty() ? state.seeds[b] : model.seed.value_or(Vec3d{});
    if (model.follow) {
      const Vec3d now = nearest_at_rest(run_.model().bodies[b], run_.loaded.pick(u, b, 1), tool);
      if (!known || distance(now, seed) > run_.model().bodies[b].spacing) {
        seed = now;
        moved = true;
      }
    }
    seeds.push_back(seed);
  }
  if (!moved) return;
  std::vector<Vec3d> before = std::exchange(run_.state.seeds, std::move(seeds));
  try {
    swap_partition(std::move(u));
  } catch (...) {
    run_.state.seeds = std::move(before);
    throw;
  }
  step_.adapt();
}

/// Held goals pull at the finite elements once in n substeps, n times as hard: where elements have become stiffer than the last
/// look at the step knew, that is a resonance, which a shorter step does not leave before it is a thousandth
/// (docs/stability.md).
bool TopologyEdits::fewer_substeps() {
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

void TopologyEdits::swap_partition(std::vector<double> u) {
  CutReport report;
  ModelSwap swap(run_, loads_, bodies(), std::move(u), report);
  swap.run(scene_at(run_.state), std::vector<NodeOrigins>(run_.scene.bodies.size()), [] {});
}

}  // namespace pliant
