#include "model/nodes/boundary_conditions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <utility>

#include "model/matching/flsm.h"
#include "model/nodes/whereabouts.h"
#include "pliant/error.h"

namespace pliant {
namespace {

std::string extent_of(const ModelBody& body) {
  return fmt::format("body '{}' has {} nodes between {}", body.name, body.rest.size(), corners_text(bounds_of(body.rest)));
}

/// Returns whether a virtual node is selected: only if all its anchors are, so that a piece is not held by the far side of
/// its elements.
bool follows(const VirtualNodes& nodes, std::size_t virtual_node, const std::vector<char>& chosen) {
  for (std::int32_t i = nodes.offset[virtual_node]; i < nodes.offset[virtual_node + 1]; ++i) {
    if (chosen[nodes.anchor[i]] == 0) return false;
  }
  return true;
}

}  // namespace

std::vector<std::int32_t> select_nodes(const Selection& where, const ModelBody& body, Virtual rule) {
  if (where.kind == Selection::Kind::nodes) {
    for (const std::int64_t n : where.nodes) {
      if (n < 0 || n >= static_cast<std::int64_t>(body.rest.size())) {
        throw Error(ErrorCode::bad_input, fmt::format("{}: node {} does not exist; {}", where.pointer, n, extent_of(body)));
      }
    }
  }
  std::vector<std::int32_t> chosen;
  const VirtualNodes& virtual_nodes = body.virtual_nodes;
  const std::size_t real = virtual_nodes.first < 0 ? body.rest.size() : static_cast<std::size_t>(virtual_nodes.first);
  std::vector<char> is_chosen(real, 0);
  std::vector<char> on_edge(real, 0);
  for (const EdgeNode& n : body.edge_nodes) on_edge[static_cast<std::size_t>(n.node)] = 1;
  for (std::size_t n = 0; n < real; ++n) {
    if (on_edge[n] != 0) continue;
    is_chosen[n] = where.contains(body.rest[n], static_cast<std::int64_t>(n));
    if (is_chosen[n] != 0) chosen.push_back(static_cast<std::int32_t>(n));
  }
  for (std::size_t n = real; n < body.rest.size() && rule == Virtual::with_anchors; ++n) {
    const bool among = where.contains(body.rest[n], static_cast<std::int64_t>(n));
    if (among && follows(virtual_nodes, n - real, is_chosen)) chosen.push_back(static_cast<std::int32_t>(n));
  }
  for (const EdgeNode& n : body.edge_nodes) {  // wherever they are: two ends that are listed by number hold what is between
    const bool both =
        is_chosen[static_cast<std::size_t>(n.ends[0])] != 0 && is_chosen[static_cast<std::size_t>(n.ends[1])] != 0;
    if (rule == Virtual::with_anchors && both) chosen.push_back(n.node);
  }
  if (!body.edge_nodes.empty()) std::sort(chosen.begin(), chosen.end());
  if (chosen.empty())
    throw Error(ErrorCode::bad_input, fmt::format("{}: no node in this set; {}{}", where.pointer, extent_of(body),
                                                  nearest_text(where, body.rest, "node")));
  return chosen;
}

namespace {

std::int32_t add_curve(Model& model, const Curve& curve) {
  if (curve.always()) return 0;
  model.curves.push_back(curve);
  return static_cast<std::int32_t>(model.curves.size()) - 1;
}

/// Adds the two consecutive curves of a rotation; returns the index of the first.
std::int32_t add_turn(Model& model, Curve curve, double angle) {
  curve.angle = angle;
  for (const Curve::Of of : {Curve::Of::cosine_less_one, Curve::Of::sine}) {
    curve.of = of;
    model.curves.push_back(curve);
  }
  return static_cast<std::int32_t>(model.curves.size()) - 2;
}

/// The value that an entry prescribes for one component of one node.
struct Wish {
  const std::string* entry = nullptr;  ///< its JSON pointer
  bool turned = false;
  double target = 0, sine = 0;  ///< [m]
  std::int32_t curve = 0;
};

/// The constraints collected so far, at most one per slot.
class Constraints {
 public:
  explicit Constraints(std::int32_t slots) : at_(static_cast<std::size_t>(slots), -1) {}

  void add(const Model& model, const ModelBody& body, std::int32_t node, int axis, const Wish& wish) {
    const std::int32_t slot = body.slot[node];
    if (at_[slot] < 0) {
      at_[slot] = static_cast<std::int32_t>(all_.size());
      all_.emplace_back().slot = slot;
      wishes_.emplace_back();
    }
    Constraint& c = all_[at_[slot]];
    Wish& before = wishes_[at_[slot]][axis];
    if (before.entry != nullptr && !agree(model, before, wish)) refuse(body, node, axis, before, wish);
    before = wish;
    c.axes |= 1 << axis;
    c.turned = wish.turned ? c.turned | 1 << axis : c.turned & ~(1 << axis);
    c.target[axis] = wish.target;
    c.sine[axis] = wish.sine;
    c.curve[axis] = wish.curve;
  }

  [[nodiscard]] std::vector<Constraint> by_slot() && {
    std::sort(all_.begin(), all_.end(), [](const Constraint& a, const Constraint& b) { return a.slot < b.slot; });
    return std::move(all_);
  }

 private:
  static bool still(const Wish& w) { return w.target == 0 && w.sine == 0; }
  static bool agree(const Model& model, const Wish& a, const Wish& b) {
    if (still(a) && still(b)) return true;
    return a.turned == b.turned && a.target == b.target && a.sine == b.sine && model.curves[a.curve] == model.curves[b.curve];
  }
  static std::string told(const Wish& w) {
    if (still(w)) return fmt::format("{} holds it", *w.entry);
    return w.turned ? fmt::format("{} rotates it", *w.entry) : fmt::format("{} moves it by {:.6g} m", *w.entry, w.target);
  }
  [[noreturn]] static void refuse(const ModelBody& body, std::int32_t node, int axis, const Wish& a, const Wish& b) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: got the {} component of node {} of body '{}', at [{:.6g}] m, which two entries move "
                            "differently: {}, {}; expected one motion per component (take the node out of one selection, or "
                            "leave the component free there)",
                            *b.entry, "xyz"[axis], node, body.name, fmt::join(body.rest[node], ", "), told(a), told(b)));
  }

  std::vector<std::int32_t> at_;  ///< index in all_ for each slot, or -1
  std::vector<Constraint> all_;
  std::vector<std::array<Wish, 3>> wishes_;  ///< parallel to all_
};

void rotate(const Prescribed& prescribed, const ModelBody& placed, Model& model, Constraints& all) {
  const std::int32_t curve = add_turn(model, prescribed.curve, prescribed.rotate->angle);
  for (const std::int32_t n : select_nodes(prescribed.where, placed, Virtual::with_anchors)) {
    const Circle circle = circle_of(*prescribed.rotate, placed.rest[n]);
    for (int axis = 0; axis < 3; ++axis) {
      if (!prescribed.moves(axis)) continue;
      all.add(model, placed, n, axis, {&prescribed.where.pointer, true, circle.cosine[axis], circle.sine[axis], curve});
    }
  }
}

void constrain(const Body& body, const ModelBody& placed, Model& model, Constraints& all) {
  for (const Fixed& fixed : body.fixed) {
    for (const std::int32_t n : select_nodes(fixed.where, placed, Virtual::with_anchors)) {
      for (int axis = 0; axis < 3; ++axis) {
        if (fixed.axes[axis]) all.add(model, placed, n, axis, {&fixed.where.pointer});
      }
    }
  }
  for (const Prescribed& prescribed : body.prescribed) {
    if (prescribed.rotate) {
      rotate(prescribed, placed, model, all);
      continue;
    }
    const std::int32_t curve = add_curve(model, prescribed.curve);
    for (const std::int32_t n : select_nodes(prescribed.where, placed, Virtual::with_anchors)) {
      for (int axis = 0; axis < 3; ++axis) {
        if (prescribed.moves(axis))
          all.add(model, placed, n, axis, {&prescribed.where.pointer, false, *prescribed.displacement[axis], 0, curve});
      }
    }
  }
}

void load(const Body& body, const ModelBody& placed, Model& model) {
  for (const Force& force : body.forces) {
    const std::int32_t curve = add_curve(model, force.curve);
    const auto nodes = select_nodes(force.where, placed, Virtual::never);
    // In a lattice in proportion to mass, so that a node of nearly empty cells gets almost nothing and a face gets the
    // equivalent of a traction. In a volume mesh every original node gets the same, and nodes that a tear made of one share
    // it by mass, so that the forces on other nodes do not change.
    const bool by_mass = placed.spacing > 0;
    double whole = 0;
    std::map<Vec3d, double> mass_at;
    for (const std::int32_t n : nodes) {
      const double mass = model.own_mass(placed.slot[n]);
      whole += mass;
      if (!by_mass) mass_at[placed.rest[n]] += mass;
    }
    for (const std::int32_t n : nodes) {
      const double mass = model.own_mass(placed.slot[n]);
      if (!(mass > 0)) continue;  // all its elements were removed
      const double share = by_mass ? mass / whole : mass / mass_at[placed.rest[n]] / static_cast<double>(mass_at.size());
      model.forces.push_back({placed.slot[n], {force.force[0] * share, force.force[1] * share, force.force[2] * share}, curve});
    }
  }
  for (const Pressure& pressure : body.pressures) {
    const std::int32_t curve = add_curve(model, pressure.curve);
    bool any = false;
    NearestPoint nearest(pressure.where);
    for (std::int32_t t = placed.first_triangle; t < placed.first_triangle + placed.triangles; ++t) {
      Vec3d centre{};
      for (const std::int32_t v : model.surface.triangles[t]) {
        for (int c = 0; c < 3; ++c) centre[c] += model.surface.rest[v][c] / 3;
      }
      if (!placed.triangle_middle.empty()) centre = placed.triangle_middle[t - placed.first_triangle];
      if (!pressure.where.contains(centre, t - placed.first_triangle)) {
        if (!any) nearest.add(centre);
        continue;
      }
      model.pressures.push_back({t, pressure.pressure, curve});
      any = true;
    }
    if (!any && !placed.remade)  // a blade may remove all that a pressure acts on
      throw Error(ErrorCode::bad_input, fmt::format("{}: no surface triangle has its centre in this set; {}{}",
                                                    pressure.where.pointer, extent_of(placed), nearest.text("centre")));
  }
}

/// All mass accelerates with gravity; this compensates the weight of added inertia.
void weigh_added_inertia(const Scene& scene, Model& model) {
  if (scene.gravity == Vec3d{}) return;
  for (std::size_t s = 0; s < model.added.size(); ++s) {
    const double m = model.added[s];
    if (m > 0) {
      model.forces.push_back({static_cast<std::int32_t>(s),
                              {-m * scene.gravity[0], -m * scene.gravity[1], -m * scene.gravity[2]},
                              model.gravity_curve});
    }
  }
}

/// Adds zero forces that the host may change between steps, one per node that moves the surface or is at the boundary of a
/// lattice, after the scene's own forces on that node.
void reserve_forces(Model& model) {
  std::vector<bool> used(static_cast<std::size_t>(model.slots));
  for (std::size_t v = 0; v < model.surface.rest.size(); ++v) {
    for (std::size_t a = 0; a < 8; ++a) {
      if (model.surface.weights[v][a] != 0) used[static_cast<std::size_t>(model.surface.nodes[v][a])] = true;
    }
  }
  for (const ModelBody& body : model.bodies) {  // a surface of few triangles passes cells that hold none of its vertices
    if (!(body.spacing > 0)) continue;
    std::vector<int> cells(body.slot.size());
    for (const auto& hex : body.hexes) {
      for (const std::int32_t n : hex) ++cells[static_cast<std::size_t>(n)];
    }
    for (std::size_t n = 0; n < cells.size(); ++n) {
      if (cells[n] < 8) used[static_cast<std::size_t>(body.slot[n])] = true;
    }
  }
  for (std::int32_t slot = 0; slot < model.slots; ++slot) {
    if (used[static_cast<std::size_t>(slot)]) model.forces.push_back({slot, {}, 0, true});
  }
}

}  // namespace

bool needs_surface(const Scene& scene) {
  return scene.interactive || !scene.tools.empty() || scene.contact.has_value() ||
         std::any_of(scene.bodies.begin(), scene.bodies.end(),
                     [](const Body& b) { return !b.pressures.empty() || b.membrane; });
}

void add_boundary_conditions(const Scene& scene, Model& model) {
  model.curves.assign(1, Curve{});  // curve 0: constant 1
  model.gravity_curve = scene.gravity == Vec3d{} ? 0 : add_curve(model, scene.gravity_curve);
  model.forces.clear();
  model.pressures.clear();
  Constraints constraints(model.slots);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    try {
      constrain(scene.bodies[b], model.bodies[b], model, constraints);
      load(scene.bodies[b], model.bodies[b], model);
    } catch (const Error& error) {
      if (scene.file.empty()) throw;
      throw Error(error.code(), fmt::format("{}: {}", scene.file.string(), error.what()));
    }
  }
  model.constraints = std::move(constraints).by_slot();
  for (FlsmBatch& batch : model.flsm) make_elastic(batch, model);  // needs the constraints
  weigh_added_inertia(scene, model);
  add_contact(scene, model);
  if (scene.interactive) reserve_forces(model);
  std::stable_sort(model.forces.begin(), model.forces.end(),
                   [](const NodeForce& a, const NodeForce& b) { return a.slot < b.slot; });
  std::stable_sort(model.pressures.begin(), model.pressures.end(),
                   [](const TrianglePressure& a, const TrianglePressure& b) { return a.triangle < b.triangle; });
}

}  // namespace pliant
