#include "simulation/measure/probing.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "cutting/topology/cut_topology.h"
#include "geometry/triangle_tree.h"
#include "geometry/vec.h"
#include "material/response.h"
#include "model/nodes/boundary_conditions.h"
#include "model/nodes/whereabouts.h"
#include "pliant/error.h"
#include "simulation/measure/energy.h"
#include "simulation/measure/reactions.h"
#include "simulation/step/applied_loads.h"

namespace pliant {
namespace {

constexpr double kOnFace = 1e-9;  ///< relative to the element's size: a point this close to a face is inside

using Weights = std::array<double, 8>;

/// Corners of a cell in VTK order.
constexpr int kCorner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

/// Returns barycentric coordinates, and the distance to the tetrahedron, which is 0 inside.
std::pair<Weights, double> in_tet(const std::array<Vec3d, 4>& x, const Vec3d& p) {
  std::array<Vec3d, 3> edge{};
  for (std::size_t a = 0; a < 3; ++a) edge[a] = vec::sub(x[a + 1], x[0]);
  const double volume = vec::dot(edge[0], vec::cross(edge[1], edge[2]));
  const Vec3d d = vec::sub(p, x[0]);
  Weights w{};
  w[1] = vec::dot(d, vec::cross(edge[1], edge[2])) / volume;
  w[2] = vec::dot(edge[0], vec::cross(d, edge[2])) / volume;
  w[3] = vec::dot(edge[0], vec::cross(edge[1], d)) / volume;
  w[0] = 1 - w[1] - w[2] - w[3];
  if (*std::min_element(w.begin(), w.begin() + 4) >= -kOnFace) return {w, 0};
  double distance = std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < 4; ++f) {
    const Vec3d on = closest_on_triangle(p, x[(f + 1) % 4], x[(f + 2) % 4], x[(f + 3) % 4]);
    distance = std::min(distance, vec::norm(vec::sub(p, on)));
  }
  return {w, distance};
}

/// The same for a lattice cell, in VTK order.
std::pair<Weights, double> in_cell(const Vec3d& low, const Vec3d& high, const Vec3d& p) {
  Weights w{};
  Vec3d share{}, away{};
  for (std::size_t a = 0; a < 3; ++a) {
    share[a] = (p[a] - low[a]) / (high[a] - low[a]);
    if (share[a] < -kOnFace) away[a] = low[a] - p[a];
    if (share[a] > 1 + kOnFace) away[a] = p[a] - high[a];
  }
  for (std::size_t c = 0; c < 8; ++c) {
    w[c] = 1;
    for (std::size_t a = 0; a < 3; ++a) w[c] *= kCorner[c][a] == 1 ? share[a] : 1 - share[a];
  }
  return {w, vec::norm(away)};
}

std::pair<Weights, double> in_element(const ModelBody& body, std::size_t e, const Vec3d& p) {
  if (body.tets.empty()) return in_cell(body.rest[body.hexes[e][0]], body.rest[body.hexes[e][6]], p);
  std::array<Vec3d, 4> x;
  for (std::size_t a = 0; a < 4; ++a) x[a] = body.rest[body.tets[e][a]];
  return in_tet(x, p);
}

std::span<const std::int32_t> corners(const ModelBody& body, std::size_t e) {
  if (body.tets.empty()) return body.hexes[e];
  return body.tets[e];
}

Vec3d interpolate(std::span<const std::int32_t> nodes, const Weights& weights, const std::vector<Vec3d>& values) {
  Vec3d out{};
  for (std::size_t c = 0; c < nodes.size(); ++c) {
    out = vec::add(out, vec::mul(values[static_cast<std::size_t>(nodes[c])], weights[c]));
  }
  return out;
}

/// H = F - I in a tetrahedron, or at these weights in a lattice cell.
Eigen::Matrix3d gradient(const ModelBody& body, std::size_t e, const Weights& weights, const std::vector<Vec3d>& u) {
  const auto nodes = corners(body, e);
  const auto column = [](const Vec3d& x) { return Eigen::Vector3d(x[0], x[1], x[2]); };
  Eigen::Matrix3d rest = Eigen::Matrix3d::Zero(), moved = Eigen::Matrix3d::Zero();  // tangents along the element's coordinates
  for (int a = 0; a < 3; ++a) {
    for (std::size_t c = 0; c < nodes.size(); ++c) {
      double slope = c == 0 ? -1 : static_cast<int>(c) == a + 1 ? 1 : 0;
      if (nodes.size() == 8) {
        // Weight of a corner in the other two coordinates: the sum of its weight and that of the corner at the other end of
        // the edge.
        std::size_t other = 0;
        for (std::size_t k = 0; k < 8; ++k) {
          bool edge = kCorner[k][a] != kCorner[c][a];
          for (int b = 0; b < 3; ++b) edge = edge && (b == a || kCorner[k][b] == kCorner[c][b]);
          if (edge) other = k;
        }
        slope = (kCorner[c][a] == 1 ? 1 : -1) * (weights[c] + weights[other]);
      }
      rest.col(a) += slope * column(body.rest[static_cast<std::size_t>(nodes[c])]);
      moved.col(a) += slope * column(u[static_cast<std::size_t>(nodes[c])]);
    }
  }
  return moved * rest.inverse();
}

bool asks(const SceneProbe& probe, Quantity quantity) {
  return std::find(probe.quantities.begin(), probe.quantities.end(), quantity) != probe.quantities.end();
}

/// NaN where there is no volume and so no centroid, or no vertex in the other and so no deepest one.
std::vector<double> numbers_of(const Interpenetration& o) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const Vec3d nowhere{none, none, none}, centroid = o.volume > 0 ? o.centroid : nowhere;
  const Vec3d deepest = o.depth > 0 ? o.deepest : nowhere;
  return {o.volume, centroid[0], centroid[1], centroid[2], o.area[0], o.area[1], o.depth, deepest[0], deepest[1], deepest[2]};
}

/// xx, yy, zz, xy, yz, zx of a symmetric tensor; NaN without one.
std::array<double, 6> components(const std::optional<Eigen::Matrix3d>& tensor) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  if (!tensor) return {none, none, none, none, none, none};
  const Eigen::Matrix3d& t = *tensor;
  return {t(0, 0), t(1, 1), t(2, 2), t(0, 1), t(1, 2), t(2, 0)};
}

template <class Numbers>
std::vector<double> list(const Numbers& numbers) {
  return {numbers->begin(), numbers->end()};
}

}  // namespace

std::vector<double> ProbeState::numbers(Quantity quantity) const {
  switch (quantity) {
    case Quantity::position:
      return list(position);
    case Quantity::displacement:
      return list(displacement);
    case Quantity::velocity:
      return list(velocity);
    case Quantity::stress:
      return list(stress);
    case Quantity::green_strain:
      return list(green_strain);
    case Quantity::almansi_strain:
      return list(almansi_strain);
    case Quantity::reaction:
      return list(reaction);
    case Quantity::force:
      return list(force);
    case Quantity::energy:
      return {energy->kinetic, energy->strain};
    case Quantity::interpenetration:
      return numbers_of(*interpenetration);
  }
  return {};
}

PlacedProbes::PlacedProbes(const std::vector<SceneProbe>& probes, const Model& uncut) {
  for (const SceneProbe& probe : probes) {
    for (const Place& other : places_) {
      if (other.probe.name == probe.name) {
        throw Error(ErrorCode::bad_input, fmt::format("{} and {}: two are named \"{}\"; names must differ", other.probe.pointer,
                                                      probe.pointer, probe.name));
      }
    }
    Place place{probe};
    if (!probe.between.empty()) {
      if (interpenetrations_ == nullptr) interpenetrations_ = std::make_shared<Interpenetrations>();
    } else if (probe.point) {
      find(place, uncut);
    } else {
      while (uncut.bodies.at(place.body).name != probe.body) ++place.body;
      (void)select_nodes(probe.where, uncut.bodies[place.body], Virtual::with_anchors);  // throws if nothing is selected
    }
    places_.push_back(std::move(place));
  }
}

void PlacedProbes::find(Place& place, const Model& uncut) {
  const Vec3d& point = *place.probe.point;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < uncut.bodies.size() && nearest > 0; ++b) {
    const ModelBody& body = uncut.bodies[b];
    for (std::size_t e = 0; e < static_cast<std::size_t>(body.elements()) && nearest > 0; ++e) {
      const auto [weights, distance] = in_element(body, e, point);
      if (distance >= nearest) continue;
      nearest = distance;
      place.body = b, place.element = e, place.weights = weights;
    }
  }
  if (nearest > 0) {
    const std::string body = std::isfinite(nearest) ? fmt::format("the nearest, '{}', is {:.4g} m away and lies between {}",
                                                                  uncut.bodies[place.body].name, nearest,
                                                                  corners_text(bounds_of(uncut.bodies[place.body].rest)))
                                                    : "there is none";
    throw Error(ErrorCode::bad_input, fmt::format("{}: [{}, {}, {}] m is in no body at rest; {}", place.probe.pointer, point[0],
                                                  point[1], point[2], body));
  }
}

std::size_t PlacedProbes::element_now(const Simulation& simulation, const Place& place) {
  const CutTopology* topology = simulation.cut_topology(place.body);
  if (topology == nullptr) return place.element;
  const ModelBody& body = simulation.model().bodies[place.body];
  // In a lattice cut into tetrahedra each cell is six consecutive elements, otherwise one.
  const std::size_t parts = static_cast<std::size_t>(body.elements()) / topology->elements().nodes.size();
  const auto cell = static_cast<std::int32_t>(place.element / parts);
  if (!topology->divided(cell)) return place.element;
  const std::int32_t copy = topology->element_of(cell, topology->label_at(cell, *place.probe.point));
  return copy < 0 ? place.element : parts * static_cast<std::size_t>(copy) + place.element % parts;
}

namespace {

/// Where a blade has removed the tissue: NaN in place of every number that a probe asks for.
ProbeState nowhere(const SceneProbe& probe) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  ProbeState state;
  state.displacement = state.velocity = state.position = Vec3d{none, none, none};
  if (asks(probe, Quantity::green_strain)) state.green_strain = components({});
  if (asks(probe, Quantity::almansi_strain)) state.almansi_strain = components({});
  if (asks(probe, Quantity::stress)) state.stress = components({});
  return state;
}

}  // namespace

ProbeState PlacedProbes::at_point(const Simulation& simulation, const Place& was, const std::vector<Vec3d>& u,
                                  const std::vector<Vec3d>& v) {
  const ModelBody& body = simulation.model().bodies[was.body];
  Place place = was;
  std::size_t element = 0;
  if (const auto now = simulation.element_at(was.body, static_cast<std::int32_t>(was.element), *was.probe.point)) {
    if (*now < 0) return nowhere(was.probe);
    element = static_cast<std::size_t>(*now);
    if (!body.tets.empty()) place.weights = in_element(body, element, *was.probe.point).first;
  } else {
    element = element_now(simulation, was);
  }
  const auto nodes = corners(body, element);
  ProbeState state;
  state.displacement = interpolate(nodes, place.weights, u);
  state.velocity = interpolate(nodes, place.weights, v);
  state.position = vec::add(*place.probe.point, *state.displacement);
  const Eigen::Matrix3d h = gradient(body, element, place.weights, u);
  if (asks(place.probe, Quantity::green_strain)) state.green_strain = components(green_strain(h));
  if (asks(place.probe, Quantity::almansi_strain)) state.almansi_strain = components(almansi_strain(h));
  if (asks(place.probe, Quantity::stress)) {
    Material material = material_of(simulation.scene().bodies[place.body], body.materials, element);
    material.low = simulation.model().recovers ? low_volume : 0;
    state.stress = components(cauchy_stress(material, h));
  }
  return state;
}

ProbeState PlacedProbes::of_nodes(Simulation& simulation, const Place& place, const std::vector<Vec3d>& u,
                                  const std::vector<Vec3d>& v) {
  const ModelBody& body = simulation.model().bodies[place.body];
  const std::vector<std::int32_t> nodes = select_nodes(place.probe.where, body, Virtual::with_anchors);
  const auto sum = [&](const std::vector<Vec3d>& values) {
    Vec3d total{};
    for (const std::int32_t n : nodes) total = vec::add(total, values[static_cast<std::size_t>(n)]);
    return total;
  };
  const auto mean = [&](const std::vector<Vec3d>& values) {
    return vec::mul(sum(values), 1 / static_cast<double>(nodes.size()));
  };
  ProbeState state;
  state.displacement = mean(u);
  state.velocity = mean(v);
  state.position = vec::add(mean(body.rest), *state.displacement);
  if (asks(place.probe, Quantity::reaction)) state.reaction = sum(reactions(simulation, place.body));
  if (asks(place.probe, Quantity::force)) state.force = sum(applied_loads(simulation, place.body));
  if (asks(place.probe, Quantity::energy)) {
    const Model& model = simulation.model();
    std::vector<Vec3d> u_of(static_cast<std::size_t>(model.slots)), v_of(u_of.size());
    std::vector<char> chosen(u_of.size(), 0);
    for (const std::int32_t n : nodes) {
      const auto slot = static_cast<std::size_t>(body.slot[static_cast<std::size_t>(n)]);
      chosen[slot] = 1;
      u_of[slot] = u[static_cast<std::size_t>(n)];
      v_of[slot] = v[static_cast<std::size_t>(n)];
    }
    const Energies e = energies_among(model, u_of, v_of, chosen);
    state.energy = ProbeState::Energy{e.kinetic, e.strain + e.hourglass};
  }
  return state;
}

std::vector<ProbeState> PlacedProbes::states(Simulation& simulation) const {
  std::vector<ProbeState> states(places_.size());
  if (interpenetrations_ != nullptr) {
    const std::vector<Interpenetration> found = interpenetrations_->now(simulation);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const std::vector<std::string>& names = places_[i].probe.between;
      if (!names.empty()) states[i].interpenetration = sum_between(found, names[0], names.size() > 1 ? names[1] : "");
    }
  }
  for (std::size_t b = 0; b < simulation.model().bodies.size(); ++b) {
    const auto is_here = [&](const Place& p) { return p.body == b && p.probe.between.empty(); };
    if (std::none_of(places_.begin(), places_.end(), is_here)) continue;
    const std::vector<Vec3d> u = simulation.displacements(b), v = simulation.velocities(b);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const Place& place = places_[i];
      if (!is_here(place)) continue;
      states[i] = place.probe.point ? at_point(simulation, place, u, v) : of_nodes(simulation, place, u, v);
    }
  }
  return states;
}

}  // namespace pliant
