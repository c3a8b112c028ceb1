// spring_force: kernel and twin give the same bits; in double, the force is the slope of the energy of the law, along the
// spring.
#include <cmath>

#include "kernels/random_data.h"
#include "layout.h"
#include "model/links/links.h"

namespace pliant::kernel_test {
namespace {

class SpringForce : public TwinTest {};

Defines spring_defines(int law, int slack, int viscous) { return {{"LAW", law}, {"SLACK", slack}, {"VISCOUS", viscous}}; }

KernelCase spring_case(const Defines& defines, std::size_t count, Data data, std::uint32_t seed) {
  Random random(seed);
  constexpr int points = 200, segments = 3;
  KernelCase test("spring_force", defines, Shape::lanes, count);
  test.reals("link_u", random.reals(4 * points, data, 0.1)).reals("link_w", random.reals(4 * points, data, 1e-4));
  test.ints("spring_points", random.ints(2 * count, 0, points - 1));
  test.reals("spring_data", random.reals(PLIANT_SPRING_PLANES * count, data_for_constants(data), 1));
  test.reals("spring_curve", {-0.5, -3, 4, -0.1, -1.4, 14, 0.2, 2.8, 30});
  test.reals("link_force", Reals(4 * (count + 48))).reals("step_params", {1e-3, 0, 0, 0, 0, 0, 0, 0});
  test.integer(segments).integer(48);
  return test;
}

TEST_F(SpringForce, TwinGivesTheSameBits) {
  std::uint32_t seed = 4500;
  for (int kind = 0; kind < 8; ++kind) {  // of each law the least and the most
    const Defines defines = spring_defines(kind / 2, kind & 1, kind & 1);
    for (const std::size_t count : {16U, 80U, 1040U}) {
      for (const Data data : all_data) expect_same_bits(spring_case(defines, count, data, seed++), name_of(data));
    }
  }
}

/// One spring from (0, 0, 0) to (0.03, 0.04, 0), whose end moves by u, and in the last step by w.
struct OneSpring {
  Spring law;
  double l0 = 0.05;
  Vec3d u{}, w{};
};

Reals force_of(const OneSpring& s, int slack = 0) {
  const Vec3d d{0.03, 0.04, 0};
  const std::array<double, 2> p = spring_parameters(s.law, s.l0, 1, s.law.stiffness);
  Reals data(16 * PLIANT_SPRING_PLANES, 1.0), link_u(8, 0.0), link_w(8, 0.0), curve(3, 0.0);
  const double record[] = {d[0], d[1], d[2], s.l0, 0.05 * 0.05 - s.l0 * s.l0, p[0], p[1], s.law.damping};
  for (std::size_t k = 0; k < 8; ++k) data[16 * k] = record[k];
  for (std::size_t c = 0; c < 3; ++c) link_u[4 + c] = s.u[c], link_w[4 + c] = s.w[c];
  if (!s.law.curve.empty()) {
    curve.clear();
    for (std::size_t k = 0; k + 1 < s.law.curve.size(); ++k) {
      const auto &a = s.law.curve[k], &b = s.law.curve[k + 1];
      curve.insert(curve.end(), {a[0], a[1], (b[1] - a[1]) / (b[0] - a[0])});
    }
  }
  const auto segments = static_cast<std::int32_t>(curve.size() / 3);
  Ints ends(32, 0);
  ends[16] = 1;
  KernelCase test("spring_force", spring_defines(static_cast<int>(s.law.law), slack, s.law.damping > 0 ? 1 : 0), Shape::lanes,
                  16);
  test.exact("link_u", link_u).exact("link_w", link_w).ints("spring_points", ends).exact("spring_data", data);
  test.exact("spring_curve", curve).exact("link_force", Reals(64)).exact("step_params", {1e-3, 0, 0, 0, 0, 0, 0, 0});
  test.integer(segments).integer(0);
  const Reals all = run_in_double(test, "link_force");
  return {all[0], all[1], all[2]};
}

std::vector<Spring> every_law() {
  std::vector<Spring> laws(5);
  laws[0].stiffness = 120;
  laws[1].law = SpringLaw::cubic, laws[1].lambda1 = 40, laws[1].lambda2 = 6;
  laws[2].law = SpringLaw::measured, laws[2].a = -0.3, laws[2].b = 0.01;
  laws[3].law = SpringLaw::measured, laws[3].a = 0.5, laws[3].b = 0.01;
  laws[4].law = SpringLaw::curve, laws[4].curve = {{-0.01, -1}, {0, 0}, {0.004, 0.2}, {0.01, 3}};
  return laws;
}

TEST(SpringForceOracle, IsTheGradientOfTheEnergyOfTheLaw) {
  for (const Spring& law : every_law()) {
    for (const Vec3d& u :
         {Vec3d{0.011, -0.02, 0.007}, Vec3d{0.02, 0.03, 0}, Vec3d{0.004, 0.001, -0.03}, Vec3d{-0.05, -0.07, 0.01}}) {
      OneSpring s{law, 0.048, u, {}};
      const Reals force = force_of(s);
      for (std::size_t c = 0; c < 3; ++c) {
        const auto energy = [&](double more) {
          Vec3d d{0.03 + u[0], 0.04 + u[1], u[2]};
          d[c] += more;
          return spring_state(law, spring_parameters(law, 0.048, 1, law.stiffness), vec::norm(d) - 0.048).energy;
        };
        const double expected = (energy(1e-7) - energy(-1e-7)) / 2e-7;
        EXPECT_NEAR(force[c], expected, 1e-6 * (1 + std::fabs(expected))) << static_cast<int>(law.law) << " component " << c;
      }
    }
  }
}

TEST(SpringForceOracle, MeasuredLawIsThatOfTheSource) {
  Spring law;
  law.law = SpringLaw::measured, law.a = -0.3, law.b = 0.01;
  for (const double force : {0.1, 0.5, 2.0, -0.7}) {
    const double e = law.b * force / (1 - law.a * std::fabs(force));
    const Reals f = force_of({law, 0.05, {0.6 * e, 0.8 * e, 0}, {}});
    EXPECT_NEAR(std::hypot(f[0], f[1]), std::fabs(force), 1e-12);
    EXPECT_GT(f[0] * force, 0) << "towards the other end when longer";
  }
}

TEST(SpringForceOracle, SmallElongationsLoseNothing) {
  Spring law;
  law.stiffness = 1;
  const double e = 1e-17;  // 0.05 + e is 0.05
  EXPECT_NEAR(force_of({law, 0.05, {0.6 * e, 0.8 * e, 0}, {}})[0], 0.6 * e, 1e-15 * e);
}

TEST(SpringForceOracle, DamperActsAlongTheSpringAndSlackSpringsDoNotPush) {
  Spring law;
  law.stiffness = 100, law.damping = 2;
  const Reals f = force_of({law, 0.05, {}, {1e-6, 0, 5e-6}});  // rate 0.6 mm/s along the spring
  EXPECT_NEAR(f[0], 2 * 0.6e-3 * 0.6, 1e-15);
  EXPECT_NEAR(f[1], 2 * 0.6e-3 * 0.8, 1e-15);
  EXPECT_EQ(f[2], 0);
  law.damping = 0;
  EXPECT_LT(force_of({law, 0.05, {-0.006, -0.008, 0}, {}}, 0)[0], -0.5);
  EXPECT_EQ(force_of({law, 0.05, {-0.006, -0.008, 0}, {}}, 1)[0], 0);
  EXPECT_NEAR(force_of({law, 0.05, {0.006, 0.008, 0}, {}}, 1)[0], 0.6, 1e-14);
}

}  // namespace
}  // namespace pliant::kernel_test
