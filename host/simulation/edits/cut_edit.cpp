// A cut: edges become split elements.
#include <algorithm>
#include <cmath>
#include <future>
#include <utility>

#include "geometry/stopwatch.h"
#include "pliant/error.h"
#include "simulation/edits/model_swap.h"
#include "simulation/edits/topology_edits.h"

namespace pliant {
void TopologyEdits::make_cut(std::vector<CutEdges> edges, std::vector<double> u, CutReport& report) {
  Stopwatch clock;
  EditedBodies& all = bodies();
  std::vector<CutEdit> edits(edges.size());
  std::vector<char> changed;
  std::size_t done = 0;
  try {
    for (; done < edges.size(); ++done) {
      if (!edges[done].empty()) edits[done] = all.cut(done).cut(edges[done], all.helper);
      report.changed = report.changed || edits[done].changed_elements();
      if (!edges[done].empty()) report.in_part += all.cut(done).topology().cut_in_part(edits[done].cells);
    }
    report.topology += clock.lap();
    if (report.changed) {
      std::future<void> surfaces = all.helper.run([&] {
        for (std::size_t b = 0; b < edits.size(); ++b) {
          if (edits[b].changed_elements()) all.cut(b).update_surface();
        }
      });
      const WaitFor end(surfaces);
      ModelSwap swap(run_, loads_, all, std::move(u), report);
      std::vector<NodeOrigins> origins(edits.size());
      for (std::size_t b = 0; b < edits.size(); ++b) {
        if (!edits[b].changed_elements()) continue;
        all.cut(b).update_elements();
        origins[b] = {edits[b].node_from};
      }
      Scene scene = scene_at(run_.state);
      scene.cuttable = true;
      swap.run(scene, std::move(origins), [&] { get_soon(surfaces); });
      changed = swap.changed_nodes();
    }
  } catch (...) {
    for (std::size_t b = 0; b < std::min(done + 1, edges.size()); ++b) {
      if (!edges[b].empty()) all.rebuild(b, run_.state);
    }
    throw;
  }
  for (std::size_t b = 0; b < edges.size(); ++b) {
    if (!edges[b].empty()) run_.state.cuts.push_back({static_cast<std::int32_t>(b), std::move(edges[b])});
  }
  if (!report.changed) return;
  if (all.size() == 1) all.surface_copy.make(run_.loaded.shared_model(), all.helper);
  end_edit(std::move(changed), report);
}

}  // namespace pliant
