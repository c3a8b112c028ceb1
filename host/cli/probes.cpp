#include "cli/probes.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "cutting/topology/cut_topology.h"
#include "geometry/triangle_tree.h"
#include "geometry/vec.h"
#include "io/atomic_file.h"
#include "pliant/error.h"

namespace pliant::cli {
namespace {

constexpr double kOnFace = 1e-9;  ///< of an element's size: a point on its face is in it

using Weights = std::array<double, 8>;

/// Barycentric coordinates, and the distance to the tetrahedron: 0 inside.
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

/// The same for a cell of a lattice, in the order of VTK.
std::pair<Weights, double> in_cell(const Vec3d& low, const Vec3d& high, const Vec3d& p) {
  Weights w{};
  Vec3d share{}, away{};
  for (std::size_t a = 0; a < 3; ++a) {
    share[a] = (p[a] - low[a]) / (high[a] - low[a]);
    if (share[a] < -kOnFace) away[a] = low[a] - p[a];
    if (share[a] > 1 + kOnFace) away[a] = p[a] - high[a];
  }
  constexpr int kCorner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
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

}  // namespace

ProbePoint parse_probe(const std::string& text) {
  const auto refuse = [&](const char* what) {
    throw Error(
        ErrorCode::bad_input,
        fmt::format("--probe is \"{}\": {}; expected NAME=x,y,z with a point at rest in m, such as tip=0,0.05,0", text, what));
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) refuse("there is no name");
  ProbePoint point{text.substr(0, equals), {}};
  if (point.name.find_first_of(",\"\n\r") != std::string::npos) refuse("a name has no comma, quotation mark or line break");
  const char *at = text.data() + equals + 1, *end = text.data() + text.size();
  for (std::size_t a = 0; a < 3; ++a) {
    const auto read = std::from_chars(at, end, point.rest[a]);
    if (read.ec != std::errc() || !std::isfinite(point.rest[a])) refuse("three finite numbers are needed");
    at = read.ptr;
    if (a < 2 && (at == end || *at++ != ',')) refuse("three finite numbers are needed");
  }
  if (at != end) refuse("three finite numbers are needed");
  return point;
}

Probes::Probes(std::vector<ProbePoint> points, const Model& uncut) {
  for (ProbePoint& point : points) {
    for (const Place& other : places_) {
      if (other.point.name == point.name)
        throw Error(ErrorCode::bad_input, fmt::format("--probe: two are named \"{}\"; names must differ", point.name));
    }
    Place place{point, 0, 0, {}};
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t b = 0; b < uncut.bodies.size() && nearest > 0; ++b) {
      const ModelBody& body = uncut.bodies[b];
      for (std::size_t e = 0; e < static_cast<std::size_t>(body.elements()) && nearest > 0; ++e) {
        const auto [weights, distance] = in_element(body, e, point.rest);
        if (distance >= nearest) continue;
        nearest = distance;
        place.body = b, place.element = e, place.weights = weights;
      }
    }
    if (nearest > 0) {
      const std::string body = std::isfinite(nearest) ? uncut.bodies[place.body].name : "none";
      throw Error(ErrorCode::bad_input,
                  fmt::format("--probe {}: [{}, {}, {}] m is in no body at rest; the nearest, '{}', is {:.4g} m away",
                              point.name, point.rest[0], point.rest[1], point.rest[2], body, nearest));
    }
    places_.push_back(place);
  }
}

std::size_t Probes::element_now(const Simulation& simulation, const Place& place) {
  const CutTopology* topology = simulation.cut_topology(place.body);
  if (topology == nullptr) return place.element;
  const ModelBody& body = simulation.model().bodies[place.body];
  // A cell of a lattice may stand for six tetrahedra.
  const std::size_t parts = static_cast<std::size_t>(body.elements()) / topology->elements().nodes.size();
  const auto cell = static_cast<std::int32_t>(place.element / parts);
  if (!topology->divided(cell)) return place.element;
  const std::int32_t copy = topology->element_of(cell, topology->label_at(cell, place.point.rest));
  return copy < 0 ? place.element : parts * static_cast<std::size_t>(copy) + place.element % parts;
}

std::vector<ProbeState> Probes::states(const Simulation& simulation) const {
  std::vector<ProbeState> states(places_.size());
  for (std::size_t b = 0; b < simulation.model().bodies.size(); ++b) {
    if (std::none_of(places_.begin(), places_.end(), [&](const Place& p) { return p.body == b; })) continue;
    const std::vector<Vec3d> u = simulation.displacements(b), v = simulation.velocities(b);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const Place& place = places_[i];
      if (place.body != b) continue;
      const auto nodes = corners(simulation.model().bodies[b], element_now(simulation, place));
      states[i].displacement = interpolate(nodes, place.weights, u);
      states[i].velocity = interpolate(nodes, place.weights, v);
      states[i].position = vec::add(place.point.rest, states[i].displacement);
    }
  }
  return states;
}

void Probes::write(const Simulation& simulation, const std::filesystem::path& file) {
  if (empty() || simulation.step() == last_step_) return;
  last_step_ = simulation.step();
  if (table_.empty()) table_ = "time,step,probe,x,y,z,ux,uy,uz,vx,vy,vz\n";
  const std::vector<ProbeState> now = states(simulation);
  for (std::size_t i = 0; i < now.size(); ++i) {
    table_ += fmt::format("{:.9g},{},{}", simulation.time(), simulation.step(), places_[i].point.name);
    for (const Vec3d& value : {now[i].position, now[i].displacement, now[i].velocity}) {
      table_ += fmt::format(",{:.9g},{:.9g},{:.9g}", value[0], value[1], value[2]);
    }
    table_ += '\n';
  }
  write_file(file, table_);
}

}  // namespace pliant::cli
