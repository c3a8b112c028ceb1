#include "edits/cut_state.h"

#include <algorithm>
#include <utility>

#include "geometry/vec.h"
#include "model/partition.h"

namespace pliant {

BodyCut::BodyCut(const Body& body, std::shared_ptr<const Solid> uncut)
    : uncut_(std::move(uncut)), solid_(*uncut_), topology_(cut_mesh(*uncut_, body.name)) {
  make_surface();
  const CutMesh& mesh = topology_.mesh();
  std::size_t count = 0;
  for (std::size_t c = 0; c < std::min<std::size_t>(mesh.cells.size(), 1000); ++c) {
    for (const auto& [a, b] : mesh.shape->edges) {
      edge_ += vec::norm(vec::sub(mesh.rest[mesh.cells[c][a]], mesh.rest[mesh.cells[c][b]]));
      ++count;
    }
  }
  edge_ /= static_cast<double>(std::max<std::size_t>(count, 1));
  rest_edges_ = std::make_unique<RestEdges>(mesh, edge_);
}

void BodyCut::make_surface() {
  if (uncut_->lattice != nullptr) {
    surface_ = std::make_unique<CutSurface>(TriangleMesh{uncut_->surface, uncut_->triangles}, *uncut_->lattice);
  }
}

void BodyCut::keep_allowed(const Body& body, CutEdges& edges) const {
  if (body.model.cut || body.model.type == ModelType::tled || edges.empty()) return;
  const Partition partition = partition_lattice(body, *uncut_->lattice);
  std::erase_if(edges, [&](const auto& edge) {
    for (const std::int32_t c : topology_.cells_at_edge(edge.first)) {
      if (partition.operational[c] == 0) return true;
    }
    return false;
  });
}

CutEdit BodyCut::cut(const CutEdges& edges, HelperThread& helper) {
  history_.push_back(edges);
  try {
    return topology_.cut(edges, [&](const std::vector<std::int32_t>& cells) {
      if (surface_ != nullptr) dividing_ = helper.run([this, cells] { surface_->update(topology_, cells); });
    });
  } catch (...) {
    undo();
    throw;
  }
}

void BodyCut::update_surface() {
  if (surface_ == nullptr) return update_solid_surface(*uncut_, topology_, nullptr, solid_);
  if (dividing_.valid()) dividing_.get();
  patch_solid_surface(*uncut_, topology_, *surface_, surface_->take_changes(), solid_);
}

void BodyCut::undo() {
  if (dividing_.valid()) dividing_.wait();
  dividing_ = {};
  history_.pop_back();
  topology_.reset({});
  solid_ = *uncut_;
  make_surface();
  for (const CutEdges& edges : history_) {
    const CutEdit edit = topology_.cut(edges);
    if (surface_ != nullptr && edit.changed_elements()) surface_->update(topology_, edit.cells);
  }
  update_solid(*uncut_, topology_, surface_.get(), solid_);
  if (surface_ != nullptr) static_cast<void>(surface_->take_changes());
}

namespace {

ModelSurface copy_of(const ModelSurface& from) {
  ModelSurface out;
  const auto copy = [](const auto& values, auto& to) {
    to.reserve(values.size() + values.size() / 8);  // for what an edit adds
    to = values;
  };
  copy(from.rest, out.rest);
  copy(from.nodes, out.nodes);
  copy(from.weights, out.weights);
  copy(from.triangles, out.triangles);
  copy(from.triangle_body, out.triangle_body);
  copy(from.triangle_cut, out.triangle_cut);
  return out;
}

}  // namespace

void SurfaceCopy::make(const std::shared_ptr<const Model>& model, HelperThread& helper) {
  if (made_.valid()) made_.wait();
  model_ = model;
  made_ = helper.run([this, model] { surface_ = copy_of(model->surface); });
}

ModelSurface SurfaceCopy::take(const Model& model) {
  if (made_.valid()) made_.get();
  const bool same = std::exchange(model_, nullptr).get() == &model;
  return same ? std::exchange(surface_, {}) : copy_of(model.surface);
}

CutState::CutState(const Scene& scene) : bodies(scene.bodies.size()) {
  for (Solid& solid : make_solids(scene)) {
    solid.wants_middles = !scene.bodies[uncut.size()].pressures.empty();
    solid.uncut_order = std::make_shared<const NodeOrder>(node_order(solid));
    uncut.push_back(std::make_shared<const Solid>(std::move(solid)));
  }
}

BodyCut& CutState::body(const Scene& scene, std::size_t b) {
  if (bodies[b] == nullptr) bodies[b] = std::make_unique<BodyCut>(scene.bodies[b], uncut[b]);
  return *bodies[b];
}

Model CutState::trial_model(const Scene& scene) const {
  std::vector<Solid> solids;
  for (std::size_t b = 0; b < uncut.size(); ++b) {
    solids.push_back(*uncut[b]);
    if (!can_be_cut(*uncut[b])) continue;
    CutTopology topology(cut_mesh(*uncut[b], scene.bodies[b].name));
    const CutMesh& mesh = topology.mesh();
    CutEdges edges;
    for (const std::size_t cell : {std::size_t{0}, mesh.cells.size() / 2, mesh.cells.size() - 1}) {
      for (const auto& [i, j] : mesh.shape->edges) edges[node_pair(mesh.cells[cell][i], mesh.cells[cell][j])] = 0.5;
    }
    topology.cut(edges);
    update_solid_elements(*uncut[b], topology, solids.back());
  }
  return build_model(scene, solids);
}

bool can_be_cut(const Solid& solid) { return solid.lattice != nullptr || solid.hexes.empty(); }

std::vector<const Solid*> CutState::solids() const {
  std::vector<const Solid*> all;
  for (std::size_t b = 0; b < bodies.size(); ++b) all.push_back(bodies[b] != nullptr ? &bodies[b]->solid() : uncut[b].get());
  return all;
}

}  // namespace pliant
