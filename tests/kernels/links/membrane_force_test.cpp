// membrane_force: kernel and twin give the same bits; the double twin gives the derivative of the energy, and no force under
// any rigid motion.
#include <Eigen/Dense>

#include "elements/membrane.h"
#include "kernels/elements/oracle_element.h"

namespace pliant::kernel_test {
namespace {

constexpr Membrane sheet{.thickness = 1e-4, .young = 2e6, .poisson = 0.4};

class MembraneForce : public TwinTest {};

KernelCase random_case(ElementSizes size, Data data, std::uint32_t seed) {
  Random random(seed);
  KernelCase test("membrane_force", {}, Shape::lanes, size.elements);
  test.reals("link_u", displacements(random, size.nodes, data))
      .ints("membrane_points", random.ints(3 * size.elements, 0, static_cast<int>(size.nodes) - 1))
      .reals("membrane_data", random.reals(PLIANT_MEMBRANE_DATA_PLANES * size.elements, data_for_constants(data), 1 / edge))
      .reals("link_force", random.reals(4 * (32 + 3 * size.elements), Data::large, 1))
      .real(sheet.stiffness())
      .real(sheet.poisson)
      .integer(32);
  return test;
}

TEST_F(MembraneForce, TwinGivesTheSameBits) {
  std::uint32_t seed = 7100;
  for (const ElementSizes size : element_sizes) {
    for (const Data data : all_data) expect_same_bits(random_case(size, data, seed++), name_of(data));
  }
}

struct Triangles {
  std::vector<Membrane::Corners> rest;
  std::vector<Reals> record;
};

Triangles random_triangles(Random& random) {
  Triangles t;
  const auto noise = [&] { return 0.2 * edge * random.uniform(-1, 1); };
  for (int e = 0; e < 16; ++e) {
    Membrane::Corners x{Vec3d{0, 0, 0}, Vec3d{edge, 0, 0.3 * edge}, Vec3d{0, edge, -0.2 * edge}};
    for (Vec3d& corner : x) corner = {corner[0] + noise(), corner[1] + noise(), corner[2] + noise()};
    const auto record = sheet.record(x, "test");
    t.record.emplace_back(record.begin(), record.end());
    t.rest.push_back(x);
  }
  return t;
}

Membrane::Record record_of(const Reals& record) {
  Membrane::Record out{};
  std::copy(record.begin(), record.end(), out.begin());
  return out;
}

std::vector<Shift> forces_of(const Triangles& t, const std::vector<Shift>& u) {
  KernelCase test("membrane_force", {}, Shape::lanes, 16);
  test.exact("link_u", texels_of(u)).ints("membrane_points", own_nodes(3)).exact("membrane_data", planes_of(t.record));
  test.exact("link_force", Reals(16 * 3 * 4)).exact(sheet.stiffness()).exact(sheet.poisson).integer(0);
  const Reals out = run_in_double(test, "link_force");
  std::vector<Shift> forces(16, Shift(3));
  for (std::size_t e = 0; e < 16; ++e) {
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t c = 0; c < 3; ++c) forces[e][a][static_cast<Eigen::Index>(c)] = out[4 * (16 * a + e) + c];
    }
  }
  return forces;
}

double energy_of(const Reals& record, const Shift& u) {
  Membrane::Corners corners{};
  for (std::size_t a = 0; a < 3; ++a) corners[a] = {u[a][0], u[a][1], u[a][2]};
  return sheet.energy(record_of(record), corners);
}

TEST(MembraneForceOracle, IsTheDerivativeOfTheEnergy) {
  Random random(3);
  const Triangles t = random_triangles(random);
  std::vector<Shift> u;
  for (int e = 0; e < 16; ++e) u.push_back(random_shift(random, 3, 0.3));
  const std::vector<Shift> forces = forces_of(t, u);
  for (std::size_t e = 0; e < 16; ++e) {
    expect_derivative(
        forces[e], u[e], [&](const Shift& v) { return energy_of(t.record[e], v); }, 1e-6);
  }
}

/// The energy of a strip pulled along x by the stretch s, free across it: E V (s^2 - 1)^2 / 8.
TEST(MembraneForceOracle, EnergyIsThatOfUniaxialTension) {
  const Membrane::Corners x{Vec3d{0, 0, 0}, Vec3d{0.02, 0, 0}, Vec3d{0.005, 0.01, 0}};
  const Membrane::Record record = sheet.record(x, "test");
  const double s = 1.3, strain = (s * s - 1) / 2, across = std::sqrt(1 - 2 * sheet.poisson * strain);
  Membrane::Corners u{};
  for (std::size_t a = 0; a < 3; ++a) u[a] = {(s - 1) * x[a][0], (across - 1) * x[a][1], 0};
  const double volume = 1e-4 * sheet.thickness;
  EXPECT_NEAR(sheet.energy(record, u), sheet.young * volume * strain * strain / 2, 1e-12 * sheet.young * volume);
}

TEST(MembraneForceOracle, ARigidMotionGivesNoForce) {
  Random random(4);
  const Triangles t = random_triangles(random);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  std::vector<Shift> u(16, Shift(3));
  for (std::size_t e = 0; e < 16; ++e) {
    for (std::size_t a = 0; a < 3; ++a) {
      const Vector3d x(t.rest[e][a][0], t.rest[e][a][1], t.rest[e][a][2]);
      u[e][a] = turn * x + Vector3d(0.1, -0.2, 0.3) - x;
    }
  }
  for (const Shift& triangle : forces_of(t, u)) {
    for (const Vector3d& f : triangle) EXPECT_LT(f.norm(), 1e-12 * sheet.young * sheet.thickness * edge);
  }
}

/// The stiffness of a triangle, from forces at small displacements, stays below its bound, and reaches most of it.
TEST(MembraneForceOracle, StiffnessStaysBelowItsBound) {
  Random random(5);
  const Triangles t = random_triangles(random);
  Eigen::Matrix<double, 9, 9> k[16];
  const double small = 1e-7 * edge;
  for (int column = 0; column < 9; ++column) {
    Shift moved(3, Vector3d::Zero());
    moved[static_cast<std::size_t>(column) / 3][column % 3] = small;
    const std::vector<Shift> forces = forces_of(t, std::vector<Shift>(16, moved));
    for (std::size_t e = 0; e < 16; ++e) {
      for (int row = 0; row < 9; ++row) k[e](row, column) = forces[e][static_cast<std::size_t>(row) / 3][row % 3] / small;
    }
  }
  for (std::size_t e = 0; e < 16; ++e) {
    const double largest = k[e].selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
    const double bound = sheet.stiffness_bound(record_of(t.record[e]));
    EXPECT_LE(largest, 1.001 * bound);
    EXPECT_GE(largest, 0.5 * bound);
  }
}

}  // namespace
}  // namespace pliant::kernel_test
