// Links: forces between material points, in addition to the elements. Every kind of link reads displacements of LinkPoints and
// gives forces on them.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "elements/membrane.h"
#include "geometry/vec.h"
#include "scene/spring.h"

namespace pliant {

/// The points that links join. A node is a point with one slot and weight 1; a point between nodes has up to 8, of any kind.
struct LinkPoints {
  std::vector<Vec3d> rest;                         ///< [m]
  std::vector<std::array<std::int32_t, 8>> slots;  ///< unused ones repeat the first one with weight 0
  std::vector<std::array<double, 8>> weights;      ///< sum 1
  [[nodiscard]] std::size_t size() const { return rest.size(); }
  /// Adds a node; returns its number.
  std::int32_t add_node(std::int32_t slot, const Vec3d& place);
  /// `of(slot)` is a vector [3]; the value at point p.
  template <class Of>
  [[nodiscard]] Vec3d value(std::size_t p, const Of& of) const {
    Vec3d sum{};
    for (std::size_t a = 0; a < 8; ++a) {
      if (weights[p][a] == 0) continue;
      const Vec3d v = of(slots[p][a]);
      for (std::size_t c = 0; c < 3; ++c) sum[c] += weights[p][a] * v[c];
    }
    return sum;
  }
};

/// Springs with one law, of a body or of a join.
struct SpringBatch {
  Spring law;
  std::int32_t body = -1;                           ///< -1: of a join
  std::int32_t join = -1;                           ///< index in Scene::joins, -1: of a body
  std::string label;                                ///< for reports and messages
  std::vector<std::array<std::int32_t, 2>> points;  ///< [springs] of LinkPoints
  std::vector<double> length;                       ///< [springs] l0, 0 where both ends rest at one place [m]
  std::vector<std::array<double, 2>> parameters;    ///< [springs] as kernels/links/spring_pull.cl has them
  std::vector<double> damper;                       ///< [springs] [N s/m]
  std::vector<char> broken;        ///< [springs] of a join, empty: none is. They stay in the lists, and give no force
  bool bars = false;               ///< of vessels: between points in elements, however short
  bool stiffness_damping = false;  ///< some dampers come from Material::stiffness_damping
  bool listed = false;             ///< of Body::springs
  bool network = false;            ///< nothing but springs holds the nodes that it joins (note_link_bounds)
  double radius = 0;               ///< of vessels [m]
  double omega2 = 0;               ///< of the edges of tetrahedra: at least their highest squared frequency [1/s^2]
  [[nodiscard]] std::size_t size() const { return points.size(); }
  [[nodiscard]] bool damped() const { return law.damping > 0 || stiffness_damping; }
  [[nodiscard]] bool whole(std::size_t s) const { return broken.empty() || broken[s] == 0; }
  /// The batch without its broken springs.
  [[nodiscard]] SpringBatch without_broken() const;
};

/// The triangles of one body's membrane.
struct MembraneBatch {
  Membrane law;
  std::int32_t body = -1;
  std::string label;                                ///< for reports and messages
  std::vector<std::array<std::int32_t, 3>> points;  ///< [triangles] of LinkPoints
  std::vector<Membrane::Record> records;            ///< [triangles]
  [[nodiscard]] std::size_t size() const { return points.size(); }
};

/// All links of a Model.
struct Links {
  LinkPoints points;
  std::vector<SpringBatch> springs;
  std::vector<MembraneBatch> membranes;
  [[nodiscard]] bool empty() const { return points.size() == 0; }
};

/// Of one spring with a batch's law: its force [N], the slope of the force [N/m], and its potential energy, which is 0 at e = 0
/// [J]. A slack spring has none of them for e <= 0. Damping is not included.
struct SpringState {
  double force = 0, slope = 0, energy = 0;
};
SpringState spring_state(const Spring& law, const std::array<double, 2>& parameters, double e);

/// The parameters of the kernel for a spring of rest length l0 that has `share` of the force of the law. `stiffness`: k of a
/// linear law [N/m].
std::array<double, 2> spring_parameters(const Spring& law, double l0, double share, double stiffness);

/// |D + u_b - u_a| - l0 of spring s, without cancellation; `of(slot)` is the displacement [m].
template <class Of>
double elongation(const LinkPoints& points, const SpringBatch& b, std::size_t s, const Of& of) {
  const Vec3d rest = vec::sub(points.rest[b.points[s][1]], points.rest[b.points[s][0]]);
  const Vec3d u = vec::sub(points.value(b.points[s][1], of), points.value(b.points[s][0], of)), d = vec::add(rest, u);
  const double l0 = b.length[s], both = vec::norm(d) + l0;
  return both > 0 ? (vec::dot(u, vec::add(rest, d)) + (vec::dot(rest, rest) - l0 * l0)) / both : 0;
}

/// Calls f(slot, share) for the slots that move spring s: its stiffness times `share` bounds what it adds to the sum of the
/// absolute values of a row of the stiffness matrix (Gershgorin). Between two nodes the share is 2. Between points of one
/// element, which move together, it falls as they come nearer: |g_i| sum_j |g_j|, with g the weights of one end less those of
/// the other.
template <class F>
void for_each_share(const LinkPoints& points, const SpringBatch& b, std::size_t s, const F& f) {
  std::array<std::int32_t, 16> slots{};
  std::array<double, 16> g{};
  std::size_t count = 0;
  for (const double sign : {-1.0, 1.0}) {
    const std::int32_t p = b.points[s][sign < 0 ? 0 : 1];
    for (std::size_t a = 0; a < 8; ++a) {
      if (points.weights[p][a] == 0) continue;
      std::size_t at = 0;
      while (at < count && slots[at] != points.slots[p][a]) ++at;
      if (at == count) slots[count++] = points.slots[p][a];
      g[at] += sign * points.weights[p][a];
    }
  }
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += std::abs(g[i]);
  for (std::size_t i = 0; i < count; ++i) f(slots[i], std::abs(g[i]) * sum);
}

/// Whether springs of a law may become stiffer than they are at rest.
bool stiffens(const Spring& law);

/// At least what the displacements `u` [slots][4] make of the squared frequency of a batch, relative to that at rest, in every
/// direction that its springs may turn to.
double stiffening(const LinkPoints& points, const SpringBatch& b, const std::vector<double>& u);

/// The slope of the force of a spring at its length at rest; of a slack one when it is longer; of a table that is flat there,
/// the least slope that it has [N/m].
double rest_stiffness(const Spring& law, const std::array<double, 2>& parameters);
inline double rest_stiffness(const SpringBatch& b, std::size_t s) { return rest_stiffness(b.law, b.parameters[s]); }

}  // namespace pliant
