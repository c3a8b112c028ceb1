// tled_tet4_force: kernel and twin give the same bits; the double twin gives what continuum mechanics says.
#include "oracle_element.h"

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

/// A law that is finite for J <= 0 finds no fault in the inverted elements of the case before.
TEST_F(TledTet4Force, AnInvertedElementIsNoFaultForAnInvertibleLaw) {
  for (const Law law : all_laws()) {
    const auto bits = expect_same_bits(tet4_force_case(law, 0, {2064, 528}, Data::large, 77), to_string(law));
    const bool marked = std::count(bits[5].begin(), bits[5].end(), static_cast<std::uint32_t>(test_step + 1)) > 100;
    EXPECT_EQ(marked, !law_info(law).invertible) << to_string(law);
  }
}

/// Only elements without a fault so far take the present step, and only if J is not positive.
TEST_F(TledTet4Force, MarksTheFirstFaultOnly) {
  const KernelCase test = tet4_force_case(Law::neo_hookean, 0, {2064, 528}, Data::large, 77);
  const auto bits = expect_same_bits(test, "faults");
  const Ints& before = test.program().buffers[5].ints;
  int marked = 0, kept = 0, sound = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const auto after = static_cast<std::int32_t>(bits[5][i]);
    if (before[i] != 0) {
      EXPECT_EQ(after, before[i]);
      ++kept;
    } else {
      EXPECT_TRUE(after == 0 || after == test_step + 1);
      ++(after == 0 ? sound : marked);
    }
  }
  EXPECT_GT(marked, 100);
  EXPECT_GT(kept, 100);
  EXPECT_GT(sound, 100);
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

TEST(TledTet4ForceOracle, IsTheForceOfTheTextbookStress) {
  for (const Law law : all_laws()) {
    for (const bool averaged : {false, true}) {
      const Tetrahedra t = random_tetrahedra(0.2, 5);
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
    const Tetrahedra t = random_tetrahedra(0.2, 6);
    const auto forces = element_forces("tled_tet4_force", law, {{"AVERAGED", 0}}, t.tile);
    for (std::size_t e = 0; e < 16; ++e) {
      const auto energy = [&](const Shift& u) {
        return t.points[e].weight * energy_density(law, deformation_gradient(t.points[e], u), oracle_material(law).parameters);
      };
      expect_derivative(forces[e], t.tile.u[e], energy, 1e-6);
    }
  }
}

}  // namespace
}  // namespace pliant::kernel_test
