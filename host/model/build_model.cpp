// Scene -> Model: cut every body into elements, number the nodes, lump the masses, and resolve the boundary conditions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/vec.h"
#include "layout.h"
#include "model/body_mesh.h"
#include "model/boundary_conditions.h"
#include "model/bricks.h"
#include "model/flsm.h"
#include "model/hourglass.h"
#include "model/least_fill.h"
#include "model/model.h"
#include "model/node_numbering.h"
#include "pliant/error.h"

namespace pliant {
namespace {

Vec3d centroid(const BodyElements& solid, const std::int32_t* corners, int count) {
  Vec3d sum{};
  for (int a = 0; a < count; ++a) {
    for (int c = 0; c < 3; ++c) sum[c] += solid.nodes[corners[a]][c] / count;
  }
  return sum;
}

/// Index of the material of each element: 0 for the body's own, i + 1 for inclusion i; the last match wins.
std::vector<int> materials_of(const Body& body, const BodyElements& solid) {
  const bool tets = !solid.tets.empty();
  const std::size_t count = tets ? solid.tets.size() : solid.hexes.size();
  std::vector<int> material(count, 0);
  std::vector<char> hit(body.inclusions.size(), false);
  for (std::size_t e = 0; e < count && !body.inclusions.empty(); ++e) {
    const Vec3d x = tets ? centroid(solid, solid.tets[e].data(), 4) : centroid(solid, solid.hexes[e].data(), 8);
    for (std::size_t i = 0; i < body.inclusions.size(); ++i) {
      if (body.inclusions[i].where.contains(x, static_cast<std::int64_t>(e))) {
        material[e] = static_cast<int>(i) + 1;
        hit[i] = true;
      }
    }
  }
  for (std::size_t i = 0; i < hit.size(); ++i) {
    if (!hit[i])
      throw Error(ErrorCode::bad_input,
                  fmt::format("{}: no element has its centre in this inclusion", body.inclusions[i].where.pointer));
  }
  return material;
}

/// work(), whose messages get the name of the scene's file.
template <class Work>
auto told_with_file(const Scene& scene, Work work) {
  try {
    return work();
  } catch (const Error& error) {
    if (scene.file.empty()) throw;
    throw Error(error.code(), fmt::format("{}: {}", scene.file.string(), error.what()));
  }
}

const Material& material_of(const Body& body, int index) {
  return index == 0 ? body.material : body.inclusions[index - 1].material;
}

/// A material as its elements have it.
Material material_for(const Model& model, const Body& body, int index) {
  Material material = material_of(body, index);
  material.low = model.recovers ? low_volume : 0;
  return material;
}

void note_bound(Model& model, double frequency, double volume, const std::string& element) {
  const double edge = std::cbrt(volume);
  if (model.shortest == 0 || edge < model.shortest) model.shortest = edge;
  const double bound = 2 / frequency;
  if (model.element_bound == 0 || bound < model.element_bound) {
    model.element_bound = bound;
    model.bound_element = element;
  }
}

/// Elements by their lowest slot, of `slots`: what a sweep over them touches lies close together.
template <std::size_t N>
std::vector<std::int32_t> element_order(const std::vector<std::array<std::int32_t, N>>& elements, const NodeNumbering& draft,
                                        std::int32_t slots) {
  std::vector<std::int32_t> order(elements.size()), lowest(elements.size()), next(static_cast<std::size_t>(slots) + 1, 0);
  for (std::size_t e = 0; e < elements.size(); ++e) {
    lowest[e] = draft.slot[elements[e][0]];
    for (const std::int32_t n : elements[e]) lowest[e] = std::min(lowest[e], draft.slot[n]);
    ++next[lowest[e] + 1];
  }
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (std::size_t e = 0; e < elements.size(); ++e) order[next[lowest[e]]++] = static_cast<std::int32_t>(e);
  return order;
}

/// What a thin element holds less than what it is as stiff as, it gets as inertia: however thin, it keeps its shape and
/// vibrates like any other. `full`: mass of a full one [kg].
template <std::size_t N>
void add_inertia(Model& model, const std::array<std::int32_t, N>& slots, double fill, double stiff, double full) {
  if (model.added.empty() || stiff <= fill) return;
  const double more = (stiff - fill) * full / static_cast<double>(N);
  for (const std::int32_t n : slots) {
    model.mass[n] += more;
    model.added[n] += more;
  }
}

void add_tets(const Body& body, std::int32_t b, const NodeNumbering& draft, Model& model) {
  const std::vector<std::int32_t> order = element_order(draft.solid().tets, draft, model.slots);
  for (std::size_t m = 0; m <= body.inclusions.size(); ++m) {
    TetBatch batch;
    batch.material = material_for(model, body, static_cast<int>(m));
    batch.body = b;
    batch.averaged = body.element == ElementKind::tet4anp;
    for (const std::int32_t e : order) {
      if (draft.material[e] != static_cast<int>(m)) continue;
      std::array<Vec3d, 4> x;
      std::array<std::int32_t, 4> slots{};
      for (int a = 0; a < 4; ++a) {
        x[a] = draft.solid().nodes[draft.solid().tets[e][a]];
        slots[a] = draft.slot[draft.solid().tets[e][a]];
      }
      const TetGeometry geometry = tet_geometry(x);
      const double mass = batch.material.density * geometry.volume * draft.solid().fill[e];
      for (const std::int32_t n : slots) model.mass[n] += mass / 4;
      add_inertia(model, slots, draft.solid().fill[e], draft.stiff[e], batch.material.density * geometry.volume);
      if (!draft.solid().operational(static_cast<std::size_t>(e))) continue;
      batch.nodes.push_back(slots);
      batch.gradients.push_back(geometry.gradients);
      batch.volume.push_back(geometry.volume * draft.stiff[e]);
      batch.id.push_back(e);
      note_bound(model, tet_frequency(geometry, batch.material), geometry.volume,
                 fmt::format("{}: tetrahedron {}", body.name, e));
    }
    if (!batch.nodes.empty()) model.tets.push_back(std::move(batch));
  }
}

std::vector<double> hex_record(const HexBatch& batch, const std::array<Vec3d, 8>& x, const std::string& what) {
  return batch.full ? hex8full_record(x, what) : hex8_record(x, batch.material, what);
}

double hex_frequency(const HexBatch& batch, const std::vector<double>& record) {
  return batch.full ? hex8full_frequency(record, batch.material) : hex8_frequency(record, batch.material);
}

/// The sum of the weights of a hex8full record.
double gauss_volume(const std::vector<double>& record) {
  double volume = 0;
  for (int p = 0; p < 8; ++p) volume += record[25 * p + 24];
  return volume;
}

double hex_volume(const HexBatch& batch, const std::vector<double>& record) {
  return batch.full ? gauss_volume(record) : hex8_volume(record);
}

void add_hexes(const Body& body, std::int32_t b, const NodeNumbering& draft, Model& model) {
  const BodyElements& solid = draft.solid();
  const std::vector<std::int32_t> order = element_order(solid.hexes, draft, model.slots);
  for (std::size_t m = 0; m <= body.inclusions.size(); ++m) {
    HexBatch batch;
    batch.material = material_for(model, body, static_cast<int>(m));
    batch.body = b;
    batch.full = body.element == ElementKind::hex8full;
    batch.uniform = solid.spacing > 0;
    const auto describe = [&](std::size_t e) { return fmt::format("{}: hexahedron {}", body.name, e); };
    // A lattice's record is that of an exact cube, whatever the rounding of its corners.
    const double d = solid.spacing;
    if (batch.uniform) {
      std::array<Vec3d, 8> cube;
      for (int a = 0; a < 8; ++a) cube[a] = {d * (a & 1), d * (a >> 1 & 1), d * (a >> 2 & 1)};
      const std::string what = fmt::format("{}: lattice cell", body.name);
      batch.records.push_back(batch.full ? hex8full_record(cube, what) : hex8_cube_record(d, batch.material, what));
      if (model.bodies[b].operational_elements > 0)
        note_bound(model, hex_frequency(batch, batch.records[0]), d * d * d, fmt::format("{}: every lattice cell", body.name));
    }
    for (const std::int32_t i : order) {
      const auto e = static_cast<std::size_t>(i);
      if (draft.material[e] != static_cast<int>(m)) continue;
      std::array<std::int32_t, 8> slots{};
      for (int a = 0; a < 8; ++a) slots[a] = draft.slot[solid.hexes[e][a]];
      double volume = d * d * d;
      if (!batch.uniform) {
        std::array<Vec3d, 8> x;
        for (int a = 0; a < 8; ++a) x[a] = solid.nodes[solid.hexes[e][a]];
        batch.records.push_back(hex_record(batch, x, describe(e)));
        volume = hex_volume(batch, batch.records.back());
        note_bound(model, hex_frequency(batch, batch.records.back()), volume, describe(e));
      }
      for (const std::int32_t n : slots) model.mass[n] += batch.material.density * volume * solid.fill[e] / 8;
      add_inertia(model, slots, solid.fill[e], draft.stiff[e], batch.material.density * volume);
      if (draft.in_brick[e] || !solid.operational(e)) continue;
      batch.nodes.push_back(slots);
      batch.fill.push_back(draft.stiff[e]);
      batch.id.push_back(static_cast<std::int64_t>(e));
    }
    if (!batch.nodes.empty()) model.hexes.push_back(std::move(batch));
  }
}

void fill_body(const Body& body, NodeNumbering& draft, ModelBody& out) {
  out.name = body.name;
  out.element = body.element;
  out.slot = draft.slot;
  out.rest = draft.solid().nodes;
  out.tets = draft.solid().tets;
  out.virtual_nodes = draft.solid().virtual_nodes;
  out.hexes.reserve(draft.solid().hexes.size());
  for (const auto& hex : draft.solid().hexes) {
    std::array<std::int32_t, 8> corners{};
    for (int a = 0; a < 8; ++a) corners[a] = hex[kVtkFromBits[a]];
    out.hexes.push_back(corners);
  }
  out.spacing = draft.solid().spacing;
  out.surface_volume = draft.given->surface_volume;
  for (std::size_t e = 0; e < draft.material.size(); ++e) out.operational_elements += draft.solid().operational(e);
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

/// Fields of motion at the start, beside the rigid one.
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
  for (std::size_t e = 0; e < draft.material.size(); ++e) {
    double volume = solid.spacing * solid.spacing * solid.spacing;
    if (!solid.tets.empty()) {
      std::array<Vec3d, 4> x;
      for (int a = 0; a < 4; ++a) x[a] = solid.nodes[solid.tets[e][a]];
      volume = tet_geometry(x).volume;
    } else if (solid.spacing == 0) {
      std::array<Vec3d, 8> x;
      for (int a = 0; a < 8; ++a) x[a] = solid.nodes[solid.hexes[e][a]];
      volume = gauss_volume(hex8full_record(x, body.name));
    }
    out.volume += volume * solid.fill[e];
    out.mass += material_of(body, draft.material[e]).density * volume * solid.fill[e];
  }
}

void place_bodies(const Scene& scene, std::span<const BodyMesh* const> solids, const Model* previous,
                  std::vector<NodeNumbering>& drafts, Model& model) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    NodeNumbering draft;
    draft.given = solids[b];
    if (body.model.type != ModelType::tled) {
      draft.own = static_cast<const BodyElements&>(*solids[b]);
      repartition(body, *draft.own);
    }
    draft.material = told_with_file(scene, [&] { return materials_of(body, draft.solid()); });
    draft.stiff = stiff_fills(draft.solid(), model.least_fill);
    draft.in_brick.assign(draft.material.size(), false);
    draft.slot.assign(draft.solid().nodes.size(), -1);
    if (!draft.solid().cells.empty() && body.element == ElementKind::hex8) {
      for (std::size_t e = 0; e < draft.in_brick.size(); ++e)
        draft.in_brick[e] = draft.material[e] == 0 && draft.solid().operational(e);
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
    const auto b = static_cast<std::int32_t>(i);
    const Body& body = scene.bodies[i];
    NodeNumbering& draft = drafts[i];
    fill_body(body, draft, model.bodies[i]);
    for (std::size_t n = 0; n < draft.slot.size(); ++n) {
      model.rest[draft.slot[n]] = draft.solid().nodes[n];
      model.damping[draft.slot[n]] = body.material.damping;
    }
    if (!draft.solid().tets.empty()) {
      add_tets(body, b, draft, model);
    } else {
      add_hexes(body, b, draft, model);
    }
    add_totals(body, draft, model.bodies[i]);
    for (const std::int32_t s : model.bodies[i].slot) model.bodies[i].added_mass += model.mass[s] - model.own_mass(s);
    set_velocity(body, model.bodies[i], model);
    told_with_file(scene, [&] { add_initial(body, model.bodies[i], model); });
  }
  for (FlsmBatch& batch : model.flsm) {
    weigh(batch, model.mass);
    if (model.shortest == 0 || batch.spacing < model.shortest) model.shortest = batch.spacing;
  }
  return model;
}

Model build_model(const Scene& scene, std::span<const BodyMesh* const> solids) {
  Model model = build_elements(scene, solids);
  add_surfaces(solids, model);
  add_boundary_conditions(scene, model);
  return model;
}

}  // namespace pliant
