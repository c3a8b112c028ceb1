// Joins that break: springs between bodies that are stretched or pulled too far go, between two batches of a run. Nothing else
// changes, so that momentum is kept; their energy is lost.
#include <algorithm>
#include <memory>
#include <utility>

#include "simulation/edits/topology_edits.h"
#include "simulation/recovery/ballast_swap.h"
#include "simulation/state/snapshot.h"
#include "simulation/step/coupling.h"

namespace pliant {
namespace {

/// Whether spring s is beyond what its join bears. u: node_u.
bool overloaded(const Links& links, const SpringBatch& b, std::size_t s, const Join& join, const std::vector<double>& u) {
  const double e = elongation(links.points, b, s, [&](std::int32_t slot) {
    const double* at = u.data() + 4 * static_cast<std::size_t>(slot);
    return Vec3d{at[0], at[1], at[2]};
  });
  if (join.break_stretch > 0 && b.length[s] + e > join.break_stretch * b.length[s]) return true;
  return join.break_force > 0 && spring_state(b.law, b.parameters[s], e).force > join.break_force;
}

}  // namespace

void TopologyEdits::break_joins() {
  if (!run_.settings.breaks || !run_.begins_after(run_.state.clock.step, kTearSteps)) return;
  const Links& links = run_.model().links;
  const std::vector<double> u = run_.u();
  std::vector<std::vector<std::int32_t>> broken = run_.state.broken;
  broken.resize(run_.scene.joins.size());
  bool any = false;
  for (const SpringBatch& b : links.springs) {
    if (b.join < 0) continue;
    const auto join = static_cast<std::size_t>(b.join);
    for (std::size_t s = 0; s < b.size(); ++s) {
      if (!b.whole(s) || !overloaded(links, b, s, run_.scene.joins[join], u)) continue;
      broken[join].push_back(static_cast<std::int32_t>(s));
      any = true;
    }
    std::sort(broken[join].begin(), broken[join].end());
  }
  if (!any) return;
  const std::shared_ptr<const Model> old = run_.loaded.shared_model();
  const auto model = std::make_shared<Model>(*old);
  for (SpringBatch& b : model->links.springs) {
    if (b.join < 0) continue;
    b.broken.resize(b.size(), 0);
    for (const std::int32_t s : broken[static_cast<std::size_t>(b.join)]) {
      if (s >= 0 && static_cast<std::size_t>(s) < b.size()) b.broken[static_cast<std::size_t>(s)] = 1;
    }
  }
  const Snapshot before = take_snapshot(run_);
  try {
    load_with_state(run_, model, before);
  } catch (...) {
    load_with_state(run_, old, before);
    throw;
  }
  run_.state.broken = std::move(broken);
  run_.state.kept.reset();
  ++run_.state.topology_version;
  upload_coupling(run_);
  if (!run_.state.forces.empty()) loads_.upload();
}

}  // namespace pliant
