// Viscous stress in tled_tet4_force, tled_hex8_force and tled_hex8full_force: kernel and twin give the same bits; the double
// twin gives Kelvin and Voigt's stress, none for rigid motion, and never work.
#include "kernels/elements/hex8_oracle.h"

namespace pliant::kernel_test::viscous_test {
namespace {

class ViscousForce : public TwinTest {};

TEST_F(ViscousForce, TwinsGiveTheSameBits) {
  std::uint32_t seed = 4400;
  for (const Law law : {Law::neo_hookean, Law::yeoh}) {
    for (const ElementSizes size : element_sizes) {
      for (const Data data : all_data) {
        for (const int kind : {0, 1}) {
          expect_same_bits(tet4_force_case(law, kind, size, data, seed++, low_volume, 1), name_of(data));
          expect_same_bits(hex8_case("tled_hex8_force", kind == 1 ? PLIANT_HEX_CUBE_RECORD : PLIANT_HEX_DATA_PLANES, law, kind,
                                     size, data, seed++, 1),
                           name_of(data));
          expect_same_bits(hex8_case("tled_hex8full_force", PLIANT_HEXFULL_DATA_PLANES, law, kind, size, data, seed++, 1),
                           name_of(data));
        }
      }
    }
  }
}

/// Sixteen elements of a kind.
struct Elements {
  const char* name;
  Tile tile;
  std::vector<std::vector<Point>> points;
  std::function<std::vector<Shift>(const Tile&, const Viscous*)> forces;
};

Elements tetrahedra(Random& random) {
  Elements out{"tet4", {}, {}, [](const Tile& tile, const Viscous* v) {
                 return element_forces("tled_tet4_force", Law::neo_hookean, {{"AVERAGED", 0}}, tile, v);
               }};
  for (int e = 0; e < 16; ++e) {
    const Point p = random_tetrahedron(random);
    Reals record;
    for (std::size_t a = 1; a < 4; ++a) record.insert(record.end(), {p.gradient[a][0], p.gradient[a][1], p.gradient[a][2]});
    record.push_back(p.weight);
    out.tile.record.push_back(record);
    out.tile.u.push_back(random_shift(random, 4, 0.2));
    out.points.push_back({p});
  }
  out.tile.node_pressure = Reals(64);
  return out;
}

Elements hexahedra(const char* name, const Hexahedra& h,
                   std::function<std::vector<Shift>(const Tile&, const Viscous*)> forces) {
  return {name, h.tile, h.points, std::move(forces)};
}

std::vector<Elements> all_elements() {
  Random random(31);
  std::vector<Elements> all{tetrahedra(random)};
  all.push_back(hexahedra("hex8 of a lattice", one_point_hexahedra(0.2, 41), [](const Tile& tile, const Viscous* v) {
    return uniform_forces("tled_hex8_force", Law::neo_hookean, tile, v);
  }));
  all.push_back(hexahedra("hex8", shaped_hexahedra(0.2, 42), [](const Tile& tile, const Viscous* v) {
    return element_forces("tled_hex8_force", Law::neo_hookean, {{"UNIFORM", 0}}, tile, v);
  }));
  all.push_back(hexahedra("hex8full", eight_point_hexahedra(0.2, 43), [](const Tile& tile, const Viscous* v) {
    return element_forces("tled_hex8full_force", Law::neo_hookean, {{"UNIFORM", 0}}, tile, v);
  }));
  return all;
}

/// What the viscosity adds, [element][corner].
std::vector<Shift> added(const Elements& elements, const Viscous& viscous) {
  std::vector<Shift> with = elements.forces(elements.tile, &viscous);
  const std::vector<Shift> without = elements.forces(elements.tile, nullptr);
  for (std::size_t e = 0; e < 16; ++e) {
    for (std::size_t a = 0; a < with[e].size(); ++a) with[e][a] -= without[e][a];
  }
  return with;
}

double largest(const Shift& forces) {
  double most = 0;
  for (const Vector3d& f : forces) most = std::max(most, f.norm());
  return most;
}

/// P_v = M S_v by the two configurations, in Eigen.
Matrix3d viscous_stress(const Matrix3d& now, const Matrix3d& before, const Viscous& v) {
  const Matrix3d rate = (now.transpose() * now - before.transpose() * before) / (2 * Viscous::h);
  const Matrix3d stress =
      2 * v.eta * (rate - rate.trace() / 3 * Matrix3d::Identity()) + v.zeta * rate.trace() * Matrix3d::Identity();
  return (now + before) / 2 * stress;
}

TEST(ViscousForceOracle, IsKelvinAndVoigtsStressAndTakesEnergy) {
  Random random(7);
  for (const Elements& elements : all_elements()) {
    for (const auto& [eta, zeta] : {std::pair(20.0, 0.0), {0.0, 50.0}, {20.0, 50.0}}) {
      Viscous viscous{eta, zeta, {}};
      for (const Shift& u : elements.tile.u) viscous.w.push_back(random_shift(random, u.size(), 0.1));
      const std::vector<Shift> forces = added(elements, viscous);
      for (std::size_t e = 0; e < 16; ++e) {
        Shift expected(forces[e].size(), Vector3d::Zero()), before = elements.tile.u[e];
        for (std::size_t a = 0; a < before.size(); ++a) before[a] -= viscous.w[e][a];
        for (const Point& p : elements.points[e]) {
          const Matrix3d stress =
              viscous_stress(deformation_gradient(p, elements.tile.u[e]), deformation_gradient(p, before), viscous);
          for (std::size_t a = 0; a < before.size(); ++a)
            expected[a] += elements.tile.fill[e] * p.weight * stress * p.gradient[a];
        }
        double taken = 0;  // by the motion of the step
        for (std::size_t a = 0; a < before.size(); ++a) {
          EXPECT_LT((forces[e][a] - expected[a]).norm(), 1e-10 * largest(expected)) << elements.name;
          taken += forces[e][a].dot(viscous.w[e][a]);
        }
        EXPECT_GE(taken, 0) << elements.name;
      }
    }
  }
}

/// Corners at rest that have these gradients at all points: sum_a X_a (x) grad N_a = I.
Eigen::MatrixXd corners_at_rest(const std::vector<Point>& points) {
  const auto rows = static_cast<Eigen::Index>(3 * points.size()),
             corners = static_cast<Eigen::Index>(points[0].gradient.size());
  Eigen::MatrixXd gradients(rows, corners), identities(rows, 3);
  for (Eigen::Index p = 0; 3 * p < rows; ++p) {
    for (Eigen::Index a = 0; a < corners; ++a)
      gradients.block<3, 1>(3 * p, a) = points[static_cast<std::size_t>(p)].gradient[static_cast<std::size_t>(a)];
    identities.block<3, 3>(3 * p, 0).setIdentity();
  }
  return gradients.completeOrthogonalDecomposition().solve(identities);
}

/// A step that turns the deformed element by any angle, and moves it.
TEST(ViscousForceOracle, FeelsNoRigidMotion) {
  for (const Elements& elements : all_elements()) {
    for (const double angle : {1e-3, 0.5, 2.0}) {
      const Matrix3d turn = Eigen::AngleAxisd(angle, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
      Viscous rigid{20, 50, {}}, stretch = rigid;
      for (std::size_t e = 0; e < 16; ++e) {
        const Eigen::MatrixXd rest = corners_at_rest(elements.points[e]);
        Shift turned = elements.tile.u[e], stretched = turned;
        for (std::size_t a = 0; a < turned.size(); ++a) {
          const Vector3d now = rest.row(static_cast<Eigen::Index>(a)).transpose() + elements.tile.u[e][a];
          turned[a] = now - turn.transpose() * now + Vector3d(1e-3, 0, 2e-3);
          stretched[a] = 0.3 * angle * Vector3d(now[0], 0, 0);
        }
        rigid.w.push_back(turned);
        stretch.w.push_back(stretched);
      }
      const std::vector<Shift> none = added(elements, rigid), some = added(elements, stretch);
      for (std::size_t e = 0; e < 16; ++e) EXPECT_LT(largest(none[e]), 1e-9 * largest(some[e])) << elements.name;
    }
  }
}

}  // namespace
}  // namespace pliant::kernel_test::viscous_test
