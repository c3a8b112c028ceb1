// Hexahedra of known shape for both hex8 kernels.
#pragma once
#include "kernels/elements/oracle_element.h"

namespace pliant::kernel_test {

/// Hourglass control that follows the shape (kernels/elements/hex8_hourglass.cl): axes and stiffnesses, of no element in
/// particular.
struct HourglassShape {
  std::array<Vector3d, 3> axis;
  Vector3d normal, coupling, twist;  ///< D' of x, y, z; N of xy, xz, yz; A of x, y, z
};

struct Hexahedra {
  Tile tile;
  std::vector<std::vector<Point>> points;                   ///< per element
  std::vector<std::array<std::array<double, 8>, 4>> gamma;  ///< per element, only of the one-point element
  std::vector<std::array<Vector3d, 4>> moment;              ///< per element, sum of sign X over its corners [m]
  double stiffness = 0;                                     ///< [N/m]
  std::vector<HourglassShape> shape;                        ///< per element, where its hourglass control follows its shape
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
    std::array<Vector3d, 4> moments;
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
      moments[m] = moment;
      for (std::size_t a = 0; a < 8; ++a) gamma[m][a] -= moment.dot(point.gradient[a]);
      record.insert(record.end(), gamma[m].begin(), gamma[m].end());
    }
    record.insert(record.end(), {point.weight, h.stiffness});
    h.points.push_back({point});
    h.gamma.push_back(gamma);
    h.moment.push_back(moments);
    h.tile.record.push_back(record);
    h.tile.u.push_back(random_shift(random, 8, size));
    h.tile.fill[e] = random.uniform(0.1, 1);
  }
  return h;
}

/// The same with hourglass control that follows the shape.
inline Hexahedra shaped_hexahedra(double size, std::uint32_t seed) {
  Hexahedra h = one_point_hexahedra(size, seed);
  Random random(seed + 1000);
  for (std::size_t e = 0; e < 16; ++e) {
    Reals& record = h.tile.record[e];
    record.resize(24);
    for (const Vector3d& m : h.moment[e]) record.insert(record.end(), {m[0], m[1], m[2]});
    HourglassShape shape;
    const auto positive = [&] { return random.uniform(4, 8); };
    for (int i = 0; i < 3; ++i) {
      Vector3d axis = Vector3d::Unit(i) + 0.3 * Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      shape.axis[static_cast<std::size_t>(i)] = axis.normalized();
      shape.normal[i] = positive();
      shape.coupling[i] = random.uniform(-3, 3);
      shape.twist[i] = std::sqrt(positive());
      record.insert(record.end(), {shape.axis[i][0], shape.axis[i][1], shape.axis[i][2]});
    }
    for (const Vector3d& v : {shape.normal, shape.coupling, shape.twist}) record.insert(record.end(), {v[0], v[1], v[2]});
    record.insert(record.end(), {h.stiffness, h.points[e][0].weight});
    h.shape.push_back(shape);
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

/// The energy of bending and twisting in each direction, from q of xy, xz, yz, xyz and F.
inline double shape_energy(const HourglassShape& shape, double k, const std::array<Vector3d, 4>& q, const Matrix3d& f) {
  std::array<std::array<double, 4>, 3> p{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d moved = f * shape.axis[i];
    for (std::size_t a = 0; a < 4; ++a) p[i][a] = 2 * moved.dot(q[a]) / (1 + moved.squaredNorm());
  }
  const auto mode = [](std::size_t i, std::size_t j) { return i + j - 1; };  // xy 0, xz 1, yz 2
  double energy = 0;
  for (std::size_t d = 0; d < 3; ++d) {  // strains that are linear along d, in the plane of the two other axes
    const std::size_t i = d == 0 ? 1 : 0, j = d == 2 ? 1 : 2;
    const double along_i = p[i][mode(std::min(i, d), std::max(i, d))], along_j = p[j][mode(std::min(j, d), std::max(j, d))];
    energy += (shape.normal[i] * along_i * along_i + shape.normal[j] * along_j * along_j) / 2 +
              shape.coupling[mode(i, j)] * along_i * along_j;
    const double shear = shape.twist[i] * p[j][mode(std::min(i, d), std::max(i, d))] +
                         shape.twist[j] * p[i][mode(std::min(j, d), std::max(j, d))];
    energy += shear * shear / 2;
    energy += shape.normal[d] * p[d][3] * p[d][3] / 6;
    const double out_of_plane = p[d][mode(i, j)];
    energy -= k * out_of_plane * out_of_plane / 2;
  }
  return energy;
}

/// fill (sum_g w_g W + k/2 sum_m |q_m|^2) of element e, and what follows its shape.
inline double hexahedron_energy(const Hexahedra& h, std::size_t e, Law law, const Shift& u) {
  double energy = 0;
  for (const Point& point : h.points[e])
    energy += point.weight * energy_density(law, deformation_gradient(point, u), oracle_material(law).parameters);
  if (!h.gamma.empty()) {
    std::array<Vector3d, 4> q;
    for (std::size_t m = 0; m < 4; ++m) {
      q[m] = Vector3d::Zero();
      for (std::size_t a = 0; a < 8; ++a) q[m] += h.gamma[e][m][a] * u[a];
      energy += h.stiffness / 2 * q[m].squaredNorm();
    }
    if (!h.shape.empty()) energy += shape_energy(h.shape[e], h.stiffness, q, deformation_gradient(h.points[e][0], u));
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

/// Forces of each element from a launch in which its record serves all.
inline std::vector<Shift> uniform_forces(const std::string& stem, Law law, const Tile& tile, const Viscous* viscous = nullptr) {
  std::vector<Shift> forces(16, Shift(8));
  for (std::size_t e = 0; e < 16; ++e) {
    KernelCase test(stem, with_law(law, {{"UNIFORM", 1}, {"VISCOUS", viscous == nullptr ? 0 : 1}}), Shape::lanes, 16);
    test.exact("node_u", texels_of(tile.u)).ints("nodes", own_nodes(8)).exact("data", tile.record[e]).exact("fill", tile.fill);
    test.exact("corner_force", Reals(16 * 24)).ints("fault", Ints(16));
    test.exact("law_parameters", law_constants(oracle_material(law)));
    add_viscous(test, viscous);
    test.integer(0).integer(0).step();
    const Reals out = run_in_double(test, "corner_force");
    for (std::size_t a = 0; a < 8; ++a) forces[e][a] = Vector3d(out[48 * a + e], out[48 * a + 16 + e], out[48 * a + 32 + e]);
  }
  return forces;
}

inline void expect_textbook_and_energy(const std::string& stem, const Hexahedra& h, bool uniform = false) {
  for (const Law law : all_laws()) {
    const auto forces = uniform ? uniform_forces(stem, law, h.tile) : element_forces(stem, law, {{"UNIFORM", 0}}, h.tile);
    for (std::size_t e = 0; e < 16; ++e) {
      if (h.shape.empty()) expect_forces(forces[e], hexahedron_forces(h, e, law), 1e-12);
      expect_derivative(
          forces[e], h.tile.u[e], [&](const Shift& u) { return hexahedron_energy(h, e, law, u); }, 1e-6);
    }
  }
}

/// One record for all elements gives what a record per element gives.
inline void expect_uniform_record(const std::string& stem, Hexahedra h) {
  for (Reals& record : h.tile.record) record = h.tile.record[0];
  const auto each = element_forces(stem, Law::neo_hookean, {{"UNIFORM", 0}}, h.tile);
  EXPECT_EQ(each, uniform_forces(stem, Law::neo_hookean, h.tile));
}

}  // namespace pliant::kernel_test
