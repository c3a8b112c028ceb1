// Parting: bodies of tetrahedra separate along faces between two batches of a run, where stress or a stretched edge breaks them
// (tearing) or where a blade passes whose method is separation. Every node keeps the displacement and velocity of its origin.
// The masses of copies add up to that of their origin, so momentum is conserved.
#include <utility>
#include <vector>

#include "geometry/stopwatch.h"
#include "simulation/edits/model_swap.h"
#include "simulation/edits/topology_edits.h"

namespace pliant {

void TopologyEdits::make_tears() {
  if (!run_.settings.tears || !run_.begins_after(run_.state.clock.step, kTearSteps)) return;
  EditedBodies& all = bodies();
  const std::vector<double> u = run_.u();
  std::vector<std::vector<TetFace>> faces(all.size());
  bool any = false;
  std::int64_t edges = 0;
  for (std::size_t b = 0; b < faces.size(); ++b) {
    if (all.torn(b) == nullptr) continue;
    TornBody::Breaks found = all.torn(b)->breaking_faces(run_.loaded.positions(u, b), run_.scene.break_stretch);
    faces[b] = std::move(found.faces);
    edges += found.edges;
    any = any || !faces[b].empty();
  }
  if (!any) return;
  CutReport report;
  part(faces, u, false, report);
  run_.state.opened += edges;
}

std::vector<char> TopologyEdits::swap_bodies(const std::function<NodeOrigins(std::size_t)>& edit, std::vector<double> u,
                                             CutReport& report) {
  EditedBodies& all = bodies();
  Stopwatch clock;
  try {
    ModelSwap swap(run_, loads_, all, report);
    std::vector<NodeOrigins> origins(all.size());
    for (std::size_t b = 0; b < all.size(); ++b) {
      origins[b] = edit(b);
      report.changed = report.changed || !origins[b].from.empty();
    }
    report.topology += clock.lap();
    if (!report.changed) return {};
    swap.build(scene_at(run_.state), std::move(origins), [] {});
    swap.load(std::move(u));
    return swap.changed_nodes();
  } catch (...) {
    for (std::size_t b = 0; b < all.size(); ++b) all.rebuild(b, run_.state);
    throw;
  }
}

void TopologyEdits::end_edit(std::vector<char> changed, CutReport& report) {
  ++run_.state.topology_version;
  Stopwatch clock;
  report.step_before = run_.state.clock.dt;
  step_.limit_after_edit(changed);
  report.step_after = run_.state.clock.dt;
  report.step += clock.lap();
  changed_nodes_ = std::move(changed);
}

void TopologyEdits::part(const std::vector<std::vector<TetFace>>& faces, std::vector<double> u, bool by_blade,
                         CutReport& report) {
  EditedBodies& all = bodies();
  std::vector<char> changed = swap_bodies(
      [&](std::size_t b) { return faces[b].empty() ? NodeOrigins{} : NodeOrigins{all.part(b, faces[b], by_blade)}; },
      std::move(u), report);
  run_.state.tears.clear();
  for (std::size_t b = 0; b < all.size(); ++b) {
    for (std::size_t t = 0; all.torn(b) != nullptr && t < all.torn(b)->broken().size(); ++t) {
      const int bits = all.torn(b)->broken()[t] | all.torn(b)->waiting()[t] << TearRecord::kWaiting;
      if (bits != 0) run_.state.tears.push_back({static_cast<std::int32_t>(b), static_cast<std::int32_t>(t), bits});
    }
  }
  if (report.changed) end_edit(std::move(changed), report);
}

}  // namespace pliant
