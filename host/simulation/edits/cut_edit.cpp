// A cut: edges become split elements.
#include <algorithm>
#include <cmath>
#include <future>
#include <memory>
#include <utility>

#include "pliant/error.h"
#include "simulation/edits/topology_edits.h"

namespace pliant {
namespace {

/// The cut of all bodies. The helper splits their surfaces meanwhile.
class BodiesCut {
 public:
  BodiesCut(EditedBodies& all, std::vector<CutEdges> edges) : all_(all), edges_(std::move(edges)), edits_(edges_.size()) {}
  BodiesCut(const BodiesCut&) = delete;
  BodiesCut& operator=(const BodiesCut&) = delete;

  std::vector<NodeOrigins> make(CutReport& report) {
    for (; done_ < edges_.size(); ++done_) {
      if (edges_[done_].empty()) continue;
      edits_[done_] = all_.cut(done_).cut(edges_[done_], all_.helper);
      report.changed = report.changed || edits_[done_].changed_elements();
      report.in_part += all_.cut(done_).topology().cut_in_part(edits_[done_].cells);
    }
    std::vector<NodeOrigins> origins(edits_.size());
    if (!report.changed) return origins;
    surfaces_ = all_.helper.run([this] {
      for (std::size_t b = 0; b < edits_.size(); ++b) {
        if (edits_[b].changed_elements()) all_.cut(b).update_surface();
      }
    });
    for (std::size_t b = 0; b < edits_.size(); ++b) {
      if (!edits_[b].changed_elements()) continue;
      all_.cut(b).update_elements();
      origins[b] = {edits_[b].node_from};
    }
    return origins;
  }
  void ready() { get_soon(surfaces_); }
  void undo(const RunState& state) {
    if (surfaces_.valid()) surfaces_.wait();
    for (std::size_t b = 0; b < std::min(done_ + 1, edges_.size()); ++b) {
      if (!edges_[b].empty()) all_.rebuild(b, state);
    }
  }
  void record(RunState& state) {
    for (std::size_t b = 0; b < edges_.size(); ++b) {
      if (!edges_[b].empty()) state.cuts.push_back({static_cast<std::int32_t>(b), std::move(edges_[b])});
    }
  }

 private:
  EditedBodies& all_;
  std::vector<CutEdges> edges_;
  std::vector<CutEdit> edits_;
  std::size_t done_ = 0;
  std::future<void> surfaces_;
  const WaitFor end_{surfaces_};
};

}  // namespace

void TopologyEdits::make_cut(std::vector<CutEdges> edges, std::vector<double> u, CutReport& report) {
  EditedBodies& all = bodies();
  const auto cut = std::make_shared<BodiesCut>(all, std::move(edges));
  ModelEdit edit;
  edit.scene = [this] {
    Scene scene = scene_at(run_.state);
    scene.cuttable = true;
    return scene;
  };
  edit.edit = [cut](CutReport& made) { return cut->make(made); };
  edit.ready = [cut] { cut->ready(); };
  edit.undo = [this, cut] { cut->undo(run_.state); };
  edit.record = [this, cut, &all](const ModelSwap& swap, CutReport& made) {
    cut->record(run_.state);
    if (made.opened) run_.state.opened += made.edges;
    if (!made.changed) return;
    if (all.size() == 1) all.surface_copy.make(run_.loaded.shared_model(), all.helper);
    end_edit(swap.changed_nodes(), made);
  };
  perform(std::move(edit), std::move(u), report);
}

}  // namespace pliant
