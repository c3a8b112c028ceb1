// In scenes with blades or cuts, splits tissue that is stretched further than any tissue bears. Thin remains of a cut would
// otherwise stiffen until they determine the step. Tearing bodies have the same limit (tearing/torn_body.h).
#include <limits>
#include <utility>
#include <vector>

#include "simulation/edits/topology_edits.h"

namespace pliant {
namespace {

/// Positions of a body's nodes; NaN for nodes without elements.
std::vector<Vec3d> moving_nodes(const RunContext& run, const std::vector<double>& u, std::size_t b) {
  std::vector<Vec3d> x = run.loaded.positions(u, b);
  const std::vector<std::int32_t>& slot = run.model().bodies[b].slot;
  for (std::size_t n = 0; n < x.size(); ++n) {
    if (!(run.model().mass[static_cast<std::size_t>(slot[n])] > 0)) x[n].fill(std::numeric_limits<double>::quiet_NaN());
  }
  return x;
}

}  // namespace

void TopologyEdits::open_overstretched() {
  if (run_.phase() != 0) return;
  const double limit = run_.scene.break_stretch;
  // Where bodies part along faces make_tears does it; elements that are divided or removed have no thin remains.
  if (blade_method(run_.scene) != BladeMethod::virtual_nodes) return;
  if (!(limit > 0) || (run_.scene.blades.empty() && run_.state.cuts.empty())) return;
  EditedBodies& all = bodies();
  std::vector<double> u = known_u_.empty() ? run_.u() : std::exchange(known_u_, {});
  std::vector<CutEdges> edges(all.size());
  CutReport report;
  for (std::size_t b = 0; b < all.size(); ++b) {
    if (!can_be_cut(all.uncut(b))) continue;
    BodyCut& body = all.cut(b);
    edges[b] = body.mesh_edges().longer(body.topology(), moving_nodes(run_, u, b), limit);
    body.keep_allowed(run_.scene.bodies[b], edges[b]);
    report.edges += static_cast<std::int64_t>(edges[b].size());
  }
  if (report.edges == 0) return;
  report.opened = true;
  make_cut(std::move(edges), std::move(u), report);
}

}  // namespace pliant
