// The operational region that follows the tool: the model is partitioned anew around it, and every node keeps its position and
// momentum.
#include <algorithm>
#include <cmath>

#include "edits/model_swap.h"
#include "edits/topology_edits.h"
#include "geometry/vec.h"

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
  CutReport report;
  RunState next;
  next.seeds = seeds;
  ModelSwap swap(run_, loads_, bodies(), std::move(u), report);
  swap.run(scene_at(next), std::vector<NodeOrigins>(bodies_of_scene.size()), [] {});
  run_.state.seeds = std::move(seeds);
  step_.adapt();
}

}  // namespace pliant
