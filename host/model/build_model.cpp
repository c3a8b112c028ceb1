// Scene to Model: divides bodies into elements, numbers the nodes, lumps the masses, and resolves the boundary conditions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "elements/elements.h"
#include "geometry/vec.h"
#include "layout.h"
#include "model/elements/body_mesh.h"
#include "model/elements/bricks.h"
#include "model/elements/element_materials.h"
#include "model/elements/kept_elements.h"
#include "model/elements/least_fill.h"
#include "model/links/build_links.h"
#include "model/links/membranes.h"
#include "model/matching/flsm.h"
#include "model/matching/matching_step.h"
#include "model/model.h"
#include "model/nodes/boundary_conditions.h"
#include "model/nodes/node_numbering.h"
#include "pliant/error.h"

namespace pliant {
namespace {

/// Calls work() and adds the name of the scene file to error messages.
template <class Work>
auto told_with_file(const Scene& scene, Work work) {
  try {
    return work();
  } catch (const Error& error) {
    if (scene.file.empty()) throw;
    throw Error(error.code(), fmt::format("{}: {}", scene.file.string(), error.what()));
  }
}

/// The material with a modulus as its elements have it.
Material material_for(const Model& model, const Body& body, int index) {
  Material material = material_of(body, index);
  material.low = model.recovers ? low_volume : 0;
  return material;
}

/// `element`: returns its name.
template <class Name>
void note_bound(Model& model, double frequency, double volume, Name element) {
  constexpr double kSurelyMore = 1 + 1e-9;  // than rounding; most elements need no root
  if (model.shortest == 0 || volume < kSurelyMore * model.shortest * model.shortest * model.shortest) {
    const double edge = std::cbrt(volume);
    if (model.shortest == 0 || edge < model.shortest) model.shortest = edge;
  }
  const double bound = 2 / frequency;
  if (model.element_bound == 0 || bound < model.element_bound) {
    model.element_bound = bound;
    model.bound_element = element();
  }
}

/// Elements ordered by their lowest slot, so that a sweep over them accesses memory locally.
std::vector<std::int32_t> element_order(const NodeNumbering& draft, std::int32_t slots) {
  const BodyElements& solid = draft.solid();
  std::vector<std::int32_t> order(solid.size()), lowest(solid.size()), next(static_cast<std::size_t>(slots) + 1, 0);
  for (std::size_t e = 0; e < solid.size(); ++e) {
    lowest[e] = draft.slot[solid.corners(e)[0]];
    for (const std::int32_t n : solid.corners(e)) lowest[e] = std::min(lowest[e], draft.slot[n]);
    ++next[lowest[e] + 1];
  }
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (std::size_t e = 0; e < solid.size(); ++e) order[next[lowest[e]]++] = static_cast<std::int32_t>(e);
  return order;
}

/// Adds inertia to a thin element up to its stiffness fraction, so that it vibrates like any other, however thin it is.
/// `full`: mass of a full element [kg].
void add_inertia(Model& model, std::span<const std::int32_t> slots, double fill, double stiff, double full) {
  if (model.added.empty() || stiff <= fill) return;
  const double more = (stiff - fill) * full / static_cast<double>(slots.size());
  for (const std::int32_t n : slots) {
    model.mass[n] += more;
    model.added[n] += more;
  }
}

/// The element lists of one body, one per material, and the masses of all its elements.
class ElementLists {
 public:
  /// `previous` (may be null): a model from before an edit, which spares work where elements kept their shape.
  ElementLists(const Body& body, std::int32_t b, const Model* previous, NodeNumbering& draft, Model& model)
      : body_(body), info_(element_info(body.element)), b_(b), previous_(previous), draft_(draft), model_(model) {}

  void add() {
    draft_.volume.resize(draft_.solid().size());
    const std::vector<std::int32_t> order = element_order(draft_, model_.slots);
    for (std::size_t m = 0; m <= body_.inclusions.size(); ++m) {
      batch_ = {};
      batch_.kind = body_.element;
      batch_.material = material_for(model_, body_, static_cast<int>(m));
      batch_.body = b_;
      batch_.uniform = draft_.solid().spacing > 0 && info_.corners == 8;
      if (batch_.uniform) add_cube();
      const KeptElements kept(previous_, batch_);
      make_room(static_cast<std::int32_t>(m));
      for (const std::int32_t e : order) {
        if (draft_.materials.index[e] == static_cast<std::int32_t>(m)) add(static_cast<std::size_t>(e), kept);
      }
      if (batch_.size() > 0) model_.batches.push_back(std::move(batch_));
    }
  }

 private:
  /// For the elements of material `m`.
  void make_room(std::int32_t m) {
    const std::vector<std::int32_t>& index = draft_.materials.index;
    const auto count = static_cast<std::size_t>(std::count(index.begin(), index.end(), m));
    batch_.nodes.reserve(count * static_cast<std::size_t>(info_.corners));
    batch_.share.reserve(count);
    batch_.id.reserve(count);
    if (batch_.uniform) return;
    batch_.records.reserve(count * static_cast<std::size_t>(info_.record));
    batch_.frequency.reserve(count);
  }

  /// The record of all cells of a lattice.
  void add_cube() {
    const double d = draft_.solid().spacing;
    batch_.records = with_element(batch_.kind, [&](auto e) {
      return decltype(e)::cube_record(d, batch_.material, fmt::format("{}: lattice cell", body_.name));
    });
    if (model_.bodies[b_].operational_elements > 0)
      note_bound(model_, element_frequency(batch_.kind, batch_.records, batch_.material), d * d * d,
                 [&] { return fmt::format("{}: every lattice cell", body_.name); });
  }

  [[nodiscard]] std::string name_of(std::size_t e) const { return fmt::format("{}: {} {}", body_.name, info_.cell, e); }

  void add(std::size_t e, const KeptElements& kept) {
    const BodyElements& solid = draft_.solid();
    std::array<std::int32_t, 8> all_slots{};
    const auto corners = solid.corners(e);
    for (std::size_t a = 0; a < corners.size(); ++a) all_slots[a] = draft_.slot[corners[a]];
    const std::span<const std::int32_t> slots(all_slots.data(), corners.size());
    const bool finite = solid.operational(e) && body_.model.type != ModelType::mass_spring;
    const double modulus = draft_.materials.modulus_of(e);
    double& volume = draft_.volume[e];
    std::vector<double> record;
    double frequency = 0;
    if (batch_.uniform) {
      volume = solid.spacing * solid.spacing * solid.spacing;
    } else {
      std::array<Vec3d, 8> x;
      for (std::size_t a = 0; a < corners.size(); ++a) x[a] = solid.nodes[corners[a]];
      const std::span<const Vec3d> rest(x.data(), corners.size());
      const std::vector<std::int32_t>& before = solid.parts.before;
      if (const auto had = kept.find(before.empty() ? e : static_cast<std::size_t>(before[e]), rest)) {
        record.assign(had->record.begin(), had->record.end());
        frequency = had->frequency;
      } else {
        record = element_record(batch_.kind, rest, batch_.material, name_of(e));
        if (finite) frequency = element_frequency(batch_.kind, record, batch_.material);
      }
      volume = element_volume(batch_.kind, record);
      if (finite) note_bound(model_, std::sqrt(modulus) * frequency, volume, [&] { return name_of(e); });
    }
    const double full = batch_.material.density * volume, mass = full * solid.fill[e];
    for (const std::int32_t n : slots) model_.mass[n] += mass / static_cast<double>(slots.size());
    add_inertia(model_, slots, solid.fill[e], draft_.stiff[e], full);
    if (draft_.in_brick[e] || !finite) return;
    batch_.nodes.insert(batch_.nodes.end(), slots.begin(), slots.end());
    if (!batch_.uniform) {
      batch_.records.insert(batch_.records.end(), record.begin(), record.end());
      batch_.frequency.push_back(frequency);
    }
    batch_.share.push_back(modulus * draft_.stiff[e]);
    batch_.id.push_back(static_cast<std::int64_t>(e));
  }

  const Body& body_;
  const ElementInfo& info_;
  std::int32_t b_;
  const Model* previous_;
  NodeNumbering& draft_;
  Model& model_;
  ElementBatch batch_;
};

void fill_body(const Body& body, NodeNumbering& draft, ModelBody& out) {
  out.name = body.name;
  out.element = body.element;
  out.materials = draft.materials;
  out.slot = draft.slot;
  out.rest = draft.solid().nodes;
  out.tets = draft.solid().tets;
  out.virtual_nodes = draft.solid().virtual_nodes;
  out.edge_nodes = draft.solid().edge_nodes;
  out.remade = draft.solid().parts.whole != nullptr;
  out.hexes.reserve(draft.solid().hexes.size());
  for (const auto& hex : draft.solid().hexes) {
    std::array<std::int32_t, 8> corners{};
    for (int a = 0; a < 8; ++a) corners[a] = hex[kVtkFromBits[a]];
    out.hexes.push_back(corners);
  }
  out.spacing = draft.solid().spacing;
  out.surface_volume = draft.given->surface_volume;
  for (std::size_t e = 0; e < draft.solid().size() && body.model.type != ModelType::mass_spring; ++e)
    out.operational_elements += draft.solid().operational(e);
  const Partition& partition = draft.solid().partition;
  const auto nodes = static_cast<std::int64_t>(draft.solid().nodes.size());
  out.operational_nodes = partition.kind.empty() ? nodes : partition.operational_nodes;
  out.matching_nodes = partition.matching_nodes;
  out.interface_nodes = partition.interface_nodes;
}

/// Rigid initial motion: velocity plus angular velocity about the centre of mass.
void set_velocity(const Body& body, const ModelBody& placed, Model& model) {
  if (body.velocity == Vec3d{} && body.angular_velocity == Vec3d{}) return;
  Vec3d centre{};
  double mass = 0;
  for (const std::int32_t s : placed.slot) {
    const double own = model.own_mass(s);
    mass += own;
    for (int c = 0; c < 3; ++c) centre[c] += own * model.rest[s][c];
  }
  for (double& c : centre) c /= mass;
  const Vec3d& w = body.angular_velocity;
  for (const std::int32_t s : placed.slot) {
    const Vec3d r{model.rest[s][0] - centre[0], model.rest[s][1] - centre[1], model.rest[s][2] - centre[2]};
    model.velocity[s] = {body.velocity[0] + w[1] * r[2] - w[2] * r[1], body.velocity[1] + w[2] * r[0] - w[0] * r[2],
                         body.velocity[2] + w[0] * r[1] - w[1] * r[0]};
  }
}

/// Adds the initial fields of motion to the rigid motion.
void add_initial(const Body& body, const ModelBody& placed, Model& model) {
  for (const Initial& initial : body.initial) {
    const bool moved = !initial.displacement.zero();
    if (moved) model.displacement.resize(model.slots);
    for (const std::int32_t n : select_nodes(initial.where, placed, Virtual::with_anchors)) {
      const std::int32_t s = placed.slot[n];
      model.velocity[s] = vec::add(model.velocity[s], initial.velocity.at(model.rest[s]));
      if (moved) model.displacement[s] = vec::add(model.displacement[s], initial.displacement.at(model.rest[s]));
    }
  }
}

void add_totals(const Body& body, const NodeNumbering& draft, ModelBody& out) {
  const BodyElements& solid = draft.solid();
  for (std::size_t e = 0; e < solid.size(); ++e) {
    out.volume += draft.volume[e] * solid.fill[e];
    out.mass += material_of(body, draft.materials.index[e]).density * draft.volume[e] * solid.fill[e];
  }
}

void place_bodies(const Scene& scene, std::span<const BodyMesh* const> solids, const Model* previous,
                  std::vector<NodeNumbering>& drafts, Model& model) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    NodeNumbering draft;
    draft.given = solids[b];
    if (body.model.matches()) {
      draft.own = static_cast<const BodyElements&>(*solids[b]);
      repartition(body, *draft.own);
    }
    draft.materials = told_with_file(scene, [&] { return element_materials(body, draft.solid()); });
    draft.stiff = stiff_fills(draft.solid(), model.least_fill);
    draft.in_brick.assign(draft.solid().size(), false);
    draft.slot.assign(draft.solid().nodes.size(), -1);
    if (!draft.solid().cells.empty() && element_info(body.element).brick != nullptr) {
      for (std::size_t e = 0; e < draft.in_brick.size(); ++e)
        draft.in_brick[e] = draft.materials.index[e] == 0 && draft.solid().operational(e) && !body.material.viscous();
      const std::int32_t first = model.bricks;
      draft.slot = place_in_bricks(draft.solid(), draft.stiff, static_cast<std::int32_t>(b), draft.in_brick, model);
      if (model.bricks > first) {
        model.brick_batches.push_back(
            {material_for(model, body, 0), static_cast<std::int32_t>(b), draft.solid().spacing, first, model.bricks - first});
      }
    }
    drafts.push_back(std::move(draft));
  }
  close_bricks(model);
  number_list_nodes(drafts, model);
  for (std::size_t b = 0; b < drafts.size(); ++b) {
    if (drafts[b].solid().matching_cells.empty()) continue;
    model.flsm.push_back(place_matching_nodes(drafts[b].solid(), scene.bodies[b], static_cast<std::int32_t>(b), drafts[b].slot,
                                              previous, model));
  }
}

}  // namespace

std::int64_t Model::nodes() const {
  std::int64_t n = 0;
  for (const ModelBody& b : bodies) n += static_cast<std::int64_t>(b.slot.size());
  return n;
}

std::int64_t Model::elements() const {
  std::int64_t n = 0;
  for (const ModelBody& b : bodies) n += b.elements();
  return n;
}

Model build_model(const Scene& scene) { return build_model(scene, make_body_meshes(scene)); }

Model build_model(const Scene& scene, const std::vector<BodyMesh>& solids) {
  std::vector<const BodyMesh*> all;
  for (const BodyMesh& solid : solids) all.push_back(&solid);
  return build_model(scene, all);
}

Model build_elements(const Scene& scene, std::span<const BodyMesh* const> solids, const Model* previous) {
  Model model;
  if (previous != nullptr) model.tools = previous->tools;
  model.recovers = scene.inverted == Inverted::recover;
  std::vector<NodeNumbering> drafts;
  const bool thin_cells = scene.least_fill > 0 && (scene.cuttable || !scene.blades.empty());
  if (thin_cells) model.least_fill = scene.least_fill;
  place_bodies(scene, solids, previous, drafts, model);
  model.rest.resize(model.slots);
  model.mass.resize(model.slots);
  if (thin_cells) model.added.resize(model.slots);
  model.damping.resize(model.slots);
  model.velocity.resize(model.slots);
  model.bodies.resize(scene.bodies.size());
  for (std::size_t i = 0; i < drafts.size(); ++i) {
    const Body& body = scene.bodies[i];
    NodeNumbering& draft = drafts[i];
    fill_body(body, draft, model.bodies[i]);
    for (std::size_t n = 0; n < draft.slot.size(); ++n) {
      model.rest[draft.slot[n]] = draft.solid().nodes[n];
      model.damping[draft.slot[n]] = body.material.damping;
    }
    ElementLists(body, static_cast<std::int32_t>(i), previous, draft, model).add();
    if (body.model.type == ModelType::mass_spring && body.model.edge_springs)
      add_mass_springs(body, static_cast<std::int32_t>(i), draft, model);
    told_with_file(scene, [&] { add_spring_lists(body, static_cast<std::int32_t>(i), draft, model); });
    add_totals(body, draft, model.bodies[i]);
    told_with_file(scene, [&] { add_vessels(body, static_cast<std::int32_t>(i), draft, model); });
    for (const std::int32_t s : model.bodies[i].slot) model.bodies[i].added_mass += model.mass[s] - model.own_mass(s);
    set_velocity(body, model.bodies[i], model);
    told_with_file(scene, [&] { add_initial(body, model.bodies[i], model); });
  }
  add_joins(scene, model);
  if (!has_membranes(scene)) note_link_bounds(model);
  for (FlsmBatch& batch : model.flsm) {
    weigh(batch, model.mass);
    if (model.shortest == 0 || batch.spacing < model.shortest) model.shortest = batch.spacing;
  }
  return model;
}

Model build_model(const Scene& scene, std::span<const BodyMesh* const> solids) {
  Model model = build_elements(scene, solids);
  add_surfaces(solids, model);
  add_membranes(scene, model);
  add_boundary_conditions(scene, model);
  choose_substeps(scene, model);
  return model;
}

}  // namespace pliant
