// Hexahedra of known shape for both hex8 kernels.
#pragma once
#include "oracle_element.h"

namespace pliant::kernel_test {

struct Hexahedra {
  Tile tile;
  std::vector<std::vector<Point>> points;                   ///< per element
  std::vector<std::array<std::array<double, 8>, 4>> gamma;  ///< per element, only of the one-point element
  double stiffness = 0;                                     ///< [N/m]
};

inline void append(Reals& record, const Point& point) {
  for (const Vector3d& g : point.gradient) record.insert(record.end(), {g[0], g[1], g[2]});
}

/// One point: gradients at the centre, hourglass vectors made orthogonal to linear fields (Flanagan and Belytschko).
inline Hexahedra one_point_hexahedra(double size, std::uint32_t seed) {
  Random random(seed);
  Hexahedra h;
  h.stiffness = 7;
  for (std::size_t e = 0; e < 16; ++e) {
    const auto x = random_hexahedron(random);
    const Point point = hexahedron_point(x, Vector3d::Zero(), 8);
    std::array<std::array<double, 8>, 4> gamma{};
    Reals record;
    append(record, point);
    for (std::size_t m = 0; m < 4; ++m) {
      constexpr int masks[4] = {3, 5, 6, 7};  // xy, xz, yz, xyz
      Vector3d moment = Vector3d::Zero();
      for (int a = 0; a < 8; ++a) {
        double sign = 1;
        for (int axis = 0; axis < 3; ++axis) {
          if ((masks[m] >> axis & 1) != 0) sign *= (a >> axis & 1) != 0 ? 1 : -1;
        }
        gamma[m][static_cast<std::size_t>(a)] = sign;
        moment += sign * x[static_cast<std::size_t>(a)];
      }
      for (std::size_t a = 0; a < 8; ++a) gamma[m][a] -= moment.dot(point.gradient[a]);
      record.insert(record.end(), gamma[m].begin(), gamma[m].end());
    }
    record.insert(record.end(), {point.weight, h.stiffness});
    h.points.push_back({point});
    h.gamma.push_back(gamma);
    h.tile.record.push_back(record);
    h.tile.u.push_back(random_shift(random, 8, size));
    h.tile.fill[e] = random.uniform(0.1, 1);
  }
  return h;
}

inline Hexahedra eight_point_hexahedra(double size, std::uint32_t seed) {
  Random random(seed);
  Hexahedra h;
  for (std::size_t e = 0; e < 16; ++e) {
    const auto x = random_hexahedron(random);
    std::vector<Point> points;
    Reals record;
    for (int g = 0; g < 8; ++g) {
      const double r = 1 / std::sqrt(3.0);
      const Vector3d at((g & 1) != 0 ? r : -r, (g & 2) != 0 ? r : -r, (g & 4) != 0 ? r : -r);
      points.push_back(hexahedron_point(x, at, 1));
      append(record, points.back());
      record.push_back(points.back().weight);
    }
    h.points.push_back(points);
    h.tile.record.push_back(record);
    h.tile.u.push_back(random_shift(random, 8, size));
    h.tile.fill[e] = random.uniform(0.1, 1);
  }
  return h;
}

/// fill (sum_g w_g W + k/2 sum_m |q_m|^2) of element e.
inline double hexahedron_energy(const Hexahedra& h, std::size_t e, Law law, const Shift& u) {
  double energy = 0;
  for (const Point& point : h.points[e])
    energy += point.weight * energy_density(law, deformation_gradient(point, u), oracle_material(law).parameters);
  if (!h.gamma.empty()) {
    for (const auto& gamma : h.gamma[e]) {
      Vector3d q = Vector3d::Zero();
      for (std::size_t a = 0; a < 8; ++a) q += gamma[a] * u[a];
      energy += h.stiffness / 2 * q.squaredNorm();
    }
  }
  return h.tile.fill[e] * energy;
}

/// The forces of the textbook stress and of the hourglass springs.
inline Shift hexahedron_forces(const Hexahedra& h, std::size_t e, Law law) {
  Shift f(8, Vector3d::Zero());
  const Shift& u = h.tile.u[e];
  for (const Point& point : h.points[e]) {
    const Matrix3d p = piola_stress(law, deformation_gradient(point, u), oracle_material(law).parameters);
    for (std::size_t a = 0; a < 8; ++a) f[a] += h.tile.fill[e] * point.weight * p * point.gradient[a];
  }
  if (!h.gamma.empty()) {
    for (const auto& gamma : h.gamma[e]) {
      Vector3d q = Vector3d::Zero();
      for (std::size_t a = 0; a < 8; ++a) q += gamma[a] * u[a];
      for (std::size_t a = 0; a < 8; ++a) f[a] += h.tile.fill[e] * h.stiffness * gamma[a] * q;
    }
  }
  return f;
}

/// How many points of the elements are inverted, or nearly.
inline int low_points(const Hexahedra& h) {
  int low = 0;
  for (std::size_t e = 0; e < 16; ++e) {
    for (const Point& p : h.points[e]) low += deformation_gradient(p, h.tile.u[e]).determinant() < low_volume;
  }
  return low;
}

inline void expect_textbook_and_energy(const std::string& stem, const Hexahedra& h) {
  for (const Law law : all_laws()) {
    const auto forces = element_forces(stem, law, {{"UNIFORM", 0}}, h.tile);
    for (std::size_t e = 0; e < 16; ++e) {
      expect_forces(forces[e], hexahedron_forces(h, e, law), 1e-12);
      expect_derivative(
          forces[e], h.tile.u[e], [&](const Shift& u) { return hexahedron_energy(h, e, law, u); }, 1e-6);
    }
  }
}

/// One record for all elements gives what a record per element gives.
inline void expect_uniform_record(const std::string& stem, Hexahedra h) {
  for (Reals& record : h.tile.record) record = h.tile.record[0];
  const auto each = element_forces(stem, Law::neo_hookean, {{"UNIFORM", 0}}, h.tile);
  Tile one = h.tile;
  KernelCase test(stem, with_law(Law::neo_hookean, {{"UNIFORM", 1}}), Shape::lanes, 16);
  test.exact("node_u", texels_of(one.u)).ints("nodes", own_nodes(8)).exact("data", one.record[0]).exact("fill", one.fill);
  test.exact("corner_force", Reals(16 * 24)).ints("fault", Ints(16));
  test.exact("law_parameters", law_constants(oracle_material(Law::neo_hookean))).integer(0).integer(0).step();
  const Reals out = run_in_double(test, "corner_force");
  for (std::size_t e = 0; e < 16; ++e) {
    for (std::size_t a = 0; a < 8; ++a) {
      EXPECT_EQ(each[e][a], Vector3d(out[48 * a + e], out[48 * a + 16 + e], out[48 * a + 32 + e]));
    }
  }
}

}  // namespace pliant::kernel_test
