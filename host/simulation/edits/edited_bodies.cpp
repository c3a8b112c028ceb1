#include "simulation/edits/edited_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "geometry/vec.h"
#include "model/matching/partition.h"
#include "pliant/error.h"
#include "scene/keys.h"

namespace pliant {

BodyCut::BodyCut(const Body& body, std::shared_ptr<const BodyMesh> uncut)
    : uncut_(std::move(uncut)), solid_(*uncut_), topology_(cut_mesh(*uncut_, body.name)), mesh_edges_(topology_.mesh()) {
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
  if (body.model.cut || !body.model.matches() || edges.empty()) return;
  const Partition partition = partition_lattice(body, *uncut_->lattice);
  std::erase_if(edges, [&](const auto& edge) {
    for (const std::int32_t c : topology_.cells_at_edge(edge.first)) {
      if (partition.operational[c] == 0) return true;
    }
    return false;
  });
}

CutEdit BodyCut::cut(const CutEdges& edges, HelperThread& helper) {
  return topology_.cut(edges, [&](const std::vector<std::int32_t>& cells) {
    if (surface_ != nullptr) dividing_ = helper.run([this, cells] { surface_->update(topology_, cells); });
  });
}

void BodyCut::update_surface() {
  if (surface_ == nullptr) return update_body_surface(*uncut_, topology_, nullptr, solid_);
  if (dividing_.valid()) dividing_.get();
  patch_body_surface(*uncut_, topology_, *surface_, surface_->take_changes(), solid_);
}

void BodyCut::rebuild(std::span<const CutEdges* const> edits) {
  if (dividing_.valid()) dividing_.wait();
  dividing_ = {};
  topology_.reset({});
  solid_ = *uncut_;
  make_surface();
  for (const CutEdges* edges : edits) {
    const CutEdit edit = topology_.cut(*edges);
    if (surface_ != nullptr && edit.changed_elements()) surface_->update(topology_, edit.cells);
  }
  update_body_mesh(*uncut_, topology_, surface_.get(), solid_);
  if (surface_ != nullptr) static_cast<void>(surface_->take_changes());
}

namespace {

ModelSurface copy_of(const ModelSurface& from) {
  ModelSurface out;
  const auto copy = [](const auto& values, auto& to) {
    to.reserve(values.size() + values.size() / 8);  // reserve for later edits
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

bool can_be_cut(const BodyMesh& solid) { return solid.lattice != nullptr || solid.hexes.empty(); }

namespace {

bool tears(const Body& body) {
  return body.material.toughness > 0 || std::any_of(body.inclusions.begin(), body.inclusions.end(),
                                                    [](const Inclusion& i) { return i.material.toughness > 0; });
}

/// Returns the material of each element, as build_model assigns it. In a scene in which nothing tears by itself none has a
/// toughness: it belongs to the blades.
std::vector<Material> materials_of(const Scene& scene, const Body& body, const BodyMesh& solid) {
  const ElementMaterials materials = element_materials(body, solid);
  const bool tear = EditedBodies::tears(scene);
  std::vector<Material> out;
  for (std::size_t e = 0; e < solid.size(); ++e) {
    out.push_back(material_of(body, materials, e));
    if (!tear) out.back().toughness = 0;
  }
  return out;
}

[[noreturn]] void refuse_edits(const char* kind) {
  throw Error(ErrorCode::bad_input, fmt::format("the list of {} does not belong to this scene, or is damaged", kind));
}

}  // namespace

bool EditedBodies::tears(const Scene& scene) {
  return !scene.solver.enabled && !cuts_by_force(scene) && std::any_of(scene.bodies.begin(), scene.bodies.end(), pliant::tears);
}

EditedBodies::EditedBodies(const Scene& scene, const WholeBodies& whole)
    : scene_(scene),
      uncut_(whole),
      cuts_(scene.bodies.size()),
      torn_(scene.bodies.size()),
      swept_(scene.bodies.size()),
      remade_(scene.bodies.size()) {
  const bool parted = parts_along_faces(scene), remade = remakes_elements(scene), torn = parted || remade || tears(scene);
  if (uncut_.empty()) {
    for (BodyMesh& solid : make_body_meshes(scene)) {
      if (!torn) {
        solid.wants_middles = !scene.bodies[uncut_.size()].pressures.empty();
        solid.uncut_order = std::make_shared<const NodeOrder>(node_order(solid));
      }
      uncut_.push_back(std::make_shared<const BodyMesh>(std::move(solid)));
    }
  }
  for (std::size_t b = 0; b < uncut_.size(); ++b) {
    if (remade)
      make_remade(b);
    else if (parted || (torn && pliant::tears(scene.bodies[b])))
      make_torn(b);
  }
}

void EditedBodies::make_torn(std::size_t b) {
  const Body& body = scene_.bodies[b];
  const bool stress = tears(scene_) && pliant::tears(body);
  if (!uncut_[b]->lattice_nodes.empty() || (stress && uncut_[b]->tets.empty())) {
    const char* const why = parts_along_faces(scene_) ? "shall be parted along its faces" : "has a material with a toughness";
    throw Error(ErrorCode::bad_input,
                fmt::format("body '{}' {}; only volume meshes and sheets do, and only their tetrahedra tear", body.name, why));
  }
  swept_[b].reset();
  torn_[b] = std::make_unique<TornBody>(uncut_[b], materials_of(scene_, body, *uncut_[b]));
  if (parts_along_faces(scene_)) swept_[b] = std::make_unique<SweptFaces>(*torn_[b]);
}

void EditedBodies::make_remade(std::size_t b) {
  const bool divides = blade_method(scene_) == BladeMethod::decomposition, lattice = !uncut_[b]->lattice_nodes.empty();
  if (lattice || (divides && uncut_[b]->tets.empty())) {
    throw Error(ErrorCode::bad_input,
                fmt::format("body '{}' is {}; blades with the method \"{}\" know {} only", scene_.bodies[b].name,
                            lattice ? "a lattice" : "of hexahedra", word_of(blade_method_words(), blade_method(scene_)),
                            divides ? "volume meshes of tetrahedra" : "volume meshes"));
  }
  remade_[b] = divides ? make_divided_body(uncut_[b]) : make_thinned_body(uncut_[b]);
}

const CutTopology& EditedBodies::topology(std::size_t b) {
  if (remade_[b] != nullptr) return remade_[b]->topology();
  return swept_[b] != nullptr ? swept_[b]->topology() : cut(b).topology();
}

double EditedBodies::edge(std::size_t b) {
  if (remade_[b] != nullptr) return remade_[b]->edge();
  return swept_[b] != nullptr ? swept_[b]->edge() : cut(b).edge();
}

std::vector<std::int32_t> EditedBodies::part(std::size_t b, const std::vector<TetFace>& faces, bool by_blade) {
  const std::vector<std::uint8_t> before = torn_[b]->broken();
  std::vector<std::int32_t> from = by_blade ? torn_[b]->part(faces) : torn_[b]->tear(faces);
  if (before == torn_[b]->broken()) return {};
  if (swept_[b] != nullptr) swept_[b]->follow();
  return from;
}

BladeSweep EditedBodies::sweep(std::size_t b, const std::vector<Vec3d>& x) {
  if (remade_[b] != nullptr) return remade_[b]->sweep(x);
  if (swept_[b] != nullptr) return swept_[b]->sweep(x);
  BodyCut& body = cut(b);
  return {body.topology(), x, body.rest_edges(), body.edge()};
}

CutEdges EditedBodies::crossed(std::size_t b, const std::vector<Vec3d>& x, std::span<const SweepTriangle> triangles) {
  if (remade_[b] != nullptr) return remade_[b]->crossed(x, triangles);
  return swept_[b] != nullptr ? swept_[b]->crossed(x, triangles) : crossed_edges(cut(b).topology(), x, triangles);
}

void EditedBodies::keep_allowed(std::size_t b, CutEdges& crossed) {
  if (remade_[b] != nullptr) return remade_[b]->keep_new(crossed);
  if (swept_[b] != nullptr) return swept_[b]->keep_joined(crossed);
  cut(b).keep_allowed(scene_.bodies[b], crossed);
}

InverseMap EditedBodies::inverse_map(std::size_t b, const std::vector<Vec3d>& x, const vec::Box& region, double reach) {
  return {topology(b), x, region, edge(b), reach};
}

void EditedBodies::follow(std::size_t b, BladeTrace& trace) const {
  if (remade_[b] == nullptr) return;
  for (TracePoint& point : trace.points) {
    if (point.node < 0) remade_[b]->follow(point.carried);
  }
}

void EditedBodies::follow(std::size_t b, RunState& state) const {
  for (auto& [key, traces] : state.blades.traces) {
    const auto found = traces.find(static_cast<std::int32_t>(b));
    if (found != traces.end()) follow(b, found->second);
  }
  for (auto& [name, blade] : state.pressed) {
    for (FrontSample& sample : blade.samples) {
      if (static_cast<std::size_t>(sample.body) == b && sample.kind != 0) remade_[b]->follow(sample.point);
    }
  }
}

void EditedBodies::follow_materials() {
  for (std::size_t b = 0; b < size(); ++b) {
    if (torn_[b] != nullptr) torn_[b]->set_materials(materials_of(scene_, scene_.bodies[b], *uncut_[b]));
  }
}

BodyCut& EditedBodies::cut(std::size_t b) {
  if (cuts_[b] == nullptr) cuts_[b] = std::make_unique<BodyCut>(scene_.bodies[b], uncut_[b]);
  return *cuts_[b];
}

const BodyMesh& EditedBodies::solid(std::size_t b) const {
  if (remade_[b] != nullptr) return remade_[b]->solid();
  if (cuts_[b] != nullptr) return cuts_[b]->solid();
  return torn_[b] != nullptr ? torn_[b]->solid() : *uncut_[b];
}

std::vector<const BodyMesh*> EditedBodies::solids() const {
  std::vector<const BodyMesh*> all;
  for (std::size_t b = 0; b < size(); ++b) all.push_back(&solid(b));
  return all;
}

void EditedBodies::replay(const RunState& state) {
  if (parts_along_faces(scene_) && !state.cuts.empty()) refuse_edits("cuts");
  for (const CutRecord& record : state.cuts) {
    if (record.body < 0 || static_cast<std::size_t>(record.body) >= size()) refuse_edits("cuts");
    if (RemadeBody* remade = remade_[static_cast<std::size_t>(record.body)].get()) {
      remade->remake(record.edges);
      continue;
    }
    BodyCut& body = cut(static_cast<std::size_t>(record.body));
    if (body.cut(record.edges, helper).changed_elements()) body.update_surface();
  }
  for (const auto& body : cuts_) {
    if (body != nullptr) body->update_elements();
  }
  replay_tears(state);
}

void EditedBodies::replay_tears(const RunState& state) {
  std::vector<std::vector<TetFace>> faces(size()), waiting(size());
  for (const TearRecord& record : state.tears) {
    const auto b = static_cast<std::size_t>(record.body);
    const bool known = record.body >= 0 && b < size() && torn_[b] != nullptr && record.tet >= 0 &&
                       static_cast<std::size_t>(record.tet) < torn_[b]->broken().size() && record.faces > 0;
    const int all = known ? (1 << torn_[b]->faces()) - 1 : 0;
    if (!known || (record.faces & ~(all | all << TearRecord::kWaiting)) != 0) refuse_edits("tears");
    for (int f = 0; f < static_cast<int>(torn_[b]->faces()); ++f) {
      const TetFace face{record.tet, static_cast<std::int8_t>(f)};
      if (record.faces >> f & 1) faces[b].push_back(face);
      if (record.faces >> (f + TearRecord::kWaiting) & 1) waiting[b].push_back(face);
    }
  }
  for (std::size_t b = 0; b < size(); ++b) {
    if (!faces[b].empty()) part(b, faces[b], false);
    if (!waiting[b].empty()) torn_[b]->set_waiting(waiting[b]);
  }
}

void EditedBodies::rebuild(std::size_t b, const RunState& state) {
  if (cuts_[b] != nullptr) {
    std::vector<const CutEdges*> edits;
    for (const CutRecord& record : state.cuts) {
      if (static_cast<std::size_t>(record.body) == b) edits.push_back(&record.edges);
    }
    cuts_[b]->rebuild(edits);
  }
  if (remade_[b] != nullptr) {
    make_remade(b);
    for (const CutRecord& record : state.cuts) {
      if (static_cast<std::size_t>(record.body) == b) remade_[b]->remake(record.edges);
    }
  }
  if (torn_[b] == nullptr) return;
  make_torn(b);
  RunState own;
  std::copy_if(state.tears.begin(), state.tears.end(), std::back_inserter(own.tears),
               [b](const TearRecord& record) { return static_cast<std::size_t>(record.body) == b; });
  replay_tears(own);
}

namespace {

/// Returns representative cells for a trial cut, spread over the body so that some cells of a hybrid are finite elements:
/// their cut copies need passes that other cells do not.
std::vector<std::size_t> trial_cells(std::size_t cells) {
  constexpr std::size_t kParts = 16;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i <= kParts; ++i) chosen.push_back(i * (cells - 1) / kParts);
  return chosen;
}

}  // namespace

Model EditedBodies::trial_model() const {
  std::vector<BodyMesh> solids;
  for (std::size_t b = 0; b < size(); ++b) {
    solids.push_back(*uncut_[b]);
    if (!can_be_cut(*uncut_[b])) continue;
    CutTopology topology(cut_mesh(*uncut_[b], scene_.bodies[b].name));
    const CutMesh& mesh = topology.mesh();
    CutEdges edges;
    for (const std::size_t cell : trial_cells(mesh.cells.size())) {
      for (const auto& [i, j] : mesh.shape->edges) edges[node_pair(mesh.cells[cell][i], mesh.cells[cell][j])] = 0.5;
    }
    topology.cut(edges);
    update_body_elements(*uncut_[b], topology, solids.back());
  }
  return build_model(scene_, solids);
}

}  // namespace pliant
