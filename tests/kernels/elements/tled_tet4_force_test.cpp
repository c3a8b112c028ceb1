// tled_tet4_force: kernel and twin give the same bits; the double twin gives what continuum mechanics says.
#include "kernels/elements/oracle_element.h"

namespace pliant::kernel_test {
namespace {

class TledTet4Force : public TwinTest {};

TEST_F(TledTet4Force, TwinGivesTheSameBits) {
  std::uint32_t seed = 1;
  for (const Law law : all_laws()) {
    for (int averaged = 0; averaged < 2; ++averaged) {
      for (const ElementSizes size : element_sizes) {
        for (const Data data : all_data) expect_same_bits(tet4_force_case(law, averaged, size, data, seed++), name_of(data));
      }
    }
  }
}

/// An inverted element is only marked as one where its law goes on, and is a fault where the law ends.
TEST_F(TledTet4Force, AnInvertedElementIsAFaultOnlyWhereTheLawEnds) {
  for (const Law law : all_laws()) {
    for (const double low : {0.0, low_volume}) {
      const auto bits = expect_same_bits(tet4_force_case(law, 0, {2064, 528}, Data::large, 77, low), to_string(law));
      const auto count = [&](std::int32_t mark) {
        return std::count(bits[5].begin(), bits[5].end(), static_cast<std::uint32_t>(mark));
      };
      const bool goes_on = law_info(law).invertible || low > 0;
      EXPECT_EQ(count(test_step + 1) > 100, !goes_on) << to_string(law);
      EXPECT_EQ(count(-test_step - 1) > 100, goes_on) << to_string(law);
    }
  }
}

/// An element keeps the step of its first fault; what was only inverted before takes that of its first fault.
TEST_F(TledTet4Force, MarksTheFirstFaultOnly) {
  for (const double low : {0.0, low_volume}) {
    KernelCase test = tet4_force_case(Law::neo_hookean, 0, {2064, 528}, Data::large, 77, low);
    const Ints before = test.program().buffers[5].ints;
    const auto bits = expect_same_bits(test, "faults");
    const std::int32_t mark = low > 0 ? -test_step - 1 : test_step + 1;
    int marked = 0, kept = 0, sound = 0, raised = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const auto after = static_cast<std::int32_t>(bits[5][i]);
      if (before[i] > 0 || after == before[i]) {
        EXPECT_EQ(after, before[i]);
        ++(before[i] != 0 ? kept : sound);
      } else {
        EXPECT_EQ(after, mark);
        EXPECT_TRUE(before[i] == 0 || low == 0);
        ++(before[i] == 0 ? marked : raised);
      }
    }
    EXPECT_GT(marked, 100);
    EXPECT_GT(kept, 100);
    EXPECT_GT(sound, 100);
    EXPECT_EQ(raised > 3, low == 0) << raised;
  }
}

struct Tetrahedra {
  Tile tile;
  std::vector<Point> points;
};

Tetrahedra random_tetrahedra(double size, std::uint32_t seed) {
  Random random(seed);
  Tetrahedra t;
  for (int e = 0; e < 16; ++e) {
    t.points.push_back(random_tetrahedron(random));
    t.tile.u.push_back(random_shift(random, 4, size));
    Reals record;
    for (std::size_t a = 1; a < 4; ++a) {
      for (int c = 0; c < 3; ++c) record.push_back(t.points.back().gradient[a][c]);
    }
    record.push_back(t.points.back().weight);
    t.tile.record.push_back(record);
  }
  t.tile.node_pressure = random.reals(64, Data::large, 5000);
  return t;
}

int low_elements(const Tetrahedra& t) {
  int low = 0;
  for (std::size_t e = 0; e < 16; ++e) low += deformation_gradient(t.points[e], t.tile.u[e]).determinant() < low_volume;
  return low;
}

/// Displacements of corners in edges: gently deformed elements, and such that many are inverted or nearly so.
constexpr double gentle = 0.2, violent = 0.9;

TEST(TledTet4ForceOracle, IsTheForceOfTheTextbookStress) {
  for (const Law law : all_laws()) {
    for (const auto& [averaged, size] : {std::pair(false, gentle), {true, gentle}, {false, violent}, {true, violent}}) {
      const Tetrahedra t = random_tetrahedra(size, 5);
      EXPECT_EQ(low_elements(t) > 3, size == violent);
      const auto forces = element_forces("tled_tet4_force", law, {{"AVERAGED", averaged ? 1 : 0}}, t.tile);
      for (std::size_t e = 0; e < 16; ++e) {
        const Matrix3d f = deformation_gradient(t.points[e], t.tile.u[e]);
        std::optional<double> pressure;
        if (averaged) {
          pressure = 0;
          for (std::size_t a = 0; a < 4; ++a) *pressure += t.tile.node_pressure[4 * e + a] / 4;
        }
        const Matrix3d p = piola_stress(law, f, oracle_material(law).parameters, pressure);
        Shift expected;
        for (const Vector3d& gradient : t.points[e].gradient) expected.emplace_back(t.points[e].weight * p * gradient);
        expect_forces(forces[e], expected, 1e-12);
      }
    }
  }
}

TEST(TledTet4ForceOracle, IsTheDerivativeOfTheEnergy) {
  for (const Law law : all_laws()) {
    for (const double size : {gentle, violent}) {
      const Tetrahedra t = random_tetrahedra(size, 6);
      const auto forces = element_forces("tled_tet4_force", law, {{"AVERAGED", 0}}, t.tile);
      for (std::size_t e = 0; e < 16; ++e) {
        const auto energy = [&](const Shift& u) {
          return t.points[e].weight *
                 energy_density(law, deformation_gradient(t.points[e], u), oracle_material(law).parameters);
        };
        expect_derivative(forces[e], t.tile.u[e], energy, 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace pliant::kernel_test
