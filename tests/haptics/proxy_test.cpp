// The proxy on planes, edges, grooves and spheres, in closed form.
#include "haptics/proxy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "geometry/vec.h"
#include "support/unit_ball.h"

namespace pliant::haptics::proxy_test {
namespace {

using Triangles = std::vector<ProxyForce::Triangle>;
constexpr double kRadius = 4e-3, kStiffness = 700;

/// A strip of squares of 5 mm in the plane through `edge` along y, `across` away from it; outside is across x y.
void add_strip(Triangles& out, const Vec3d& edge, const Vec3d& across, bool towards) {
  const double size = 5e-3;
  for (int i = 0; i < 5; ++i) {
    for (int j = -4; j < 4; ++j) {
      const auto at = [&](int a, int b) { return vec::add(edge, vec::add(vec::mul(across, a * size), Vec3d{0, b * size, 0})); };
      const Vec3d p = at(i, j), q = at(i + 1, j), r = at(i + 1, j + 1), s = at(i, j + 1);
      if (towards) {
        out.push_back({p, r, q});
        out.push_back({p, s, r});
      } else {
        out.push_back({p, q, r});
        out.push_back({p, r, s});
      }
    }
  }
}

/// Two half planes that meet in the y axis; slopes along +x and -x.
Triangles roof(double right, double left) {
  Triangles out;
  add_strip(out, {}, {std::cos(right), 0, std::sin(right)}, false);
  add_strip(out, {}, {-std::cos(left), 0, std::sin(left)}, true);
  return out;
}

Pose at(double x, double y, double z) { return {{x, y, z}}; }

TEST(Proxy, SlidesOnAPlane) {
  ProxyForce model(kRadius, kStiffness);
  ASSERT_TRUE(model.surface(roof(0, 0)));
  EXPECT_EQ(model.tick(at(0, 0, 0.01), 1e-3).force, Vec3d{});
  for (int k = 0; k < 400; ++k) {  // down, then across edges and corners of the triangles
    const double x = 0.02 * std::sin(0.03 * k), y = 0.012 * std::sin(0.05 * k), z = 0.004 - 0.006 * std::sin(0.01 * k);
    const Wrench w = model.tick(at(x, y, z), 1e-3);
    ASSERT_NEAR(w.force[0], 0, 1e-9) << k;
    ASSERT_NEAR(w.force[1], 0, 1e-9) << k;
    ASSERT_NEAR(w.force[2], kStiffness * std::max(kRadius - z, 0.0), 1e-8) << k;
    ASSERT_EQ(w.torque, Vec3d{});
  }
}

TEST(Proxy, RestsInAGroove) {
  const double slope = 0.5;
  ProxyForce model(kRadius, kStiffness);
  model.surface(roof(slope, slope));
  model.tick(at(0, 0, 0.02), 1e-3);
  Wrench w;
  for (int k = 0; k <= 100; ++k) w = model.tick(at(1e-3, 0, 0.02 - 2.2e-4 * k), 1e-3);
  EXPECT_NEAR(model.proxy()[0], 0, 1e-9);
  EXPECT_NEAR(model.proxy()[2], kRadius / std::cos(slope), 1e-8) << "touches both sides";
  EXPECT_NEAR(w.force[0], -kStiffness * 1e-3, 1e-5);
  EXPECT_NEAR(w.force[2], kStiffness * (kRadius / std::cos(slope) + 0.002), 1e-5);
}

/// Over a ridge the sphere rolls: its centre is on the circle about the edge, towards the instrument.
TEST(Proxy, RollsOverARidge) {
  ProxyForce model(kRadius, kStiffness);
  model.surface(roof(-0.9, -0.9));
  model.tick(at(0, 0, 0.01), 1e-3);
  for (int k = -100; k <= 100; ++k) {
    const double angle = 0.8 * std::sin(k * M_PI / 200), depth = 0.6 * kRadius;
    Wrench w;
    for (int again = 0; again < 20; ++again) w = model.tick(at(depth * std::sin(angle), 0, depth * std::cos(angle)), 1e-3);
    ASSERT_NEAR(w.force[0], kStiffness * (kRadius - depth) * std::sin(angle), 1e-6) << k;
    ASSERT_NEAR(w.force[2], kStiffness * (kRadius - depth) * std::cos(angle), 1e-6) << k;
  }
}

/// It stays on the side where it came from, however far the instrument goes, and slides over the edge of a facet without a
/// jump.
TEST(Proxy, DoesNotFallThrough) {
  ProxyForce model(kRadius, kStiffness);
  model.surface(roof(-0.3, 0.1));
  model.tick(at(-0.01, 0.001, 0.01), 1e-3);
  Vec3d before = model.proxy();
  for (int k = 0; k <= 250; ++k) {
    const Pose tool = at(-0.01 + 1e-4 * k, 0.001, 0.01 - 1e-4 * k);
    model.tick(tool, 1e-3);
    ASSERT_GT(model.proxy()[2], -0.01) << k;
    ASSERT_LT(vec::norm(vec::sub(model.proxy(), before)), 1e-3) << k;
    before = model.proxy();
  }
}

/// Half a ball of 180 facets, whose distance from the centre differs from the radius by up to 3 %.
TEST(Proxy, OnASphereIsTowardsItsCentre) {
  const double ball = 0.02, distance = 0.022;
  const TriangleMesh mesh = test::unit_ball(20);
  Triangles triangles;
  for (const auto& t : mesh.triangles) {
    ProxyForce::Triangle corners;
    for (std::size_t c = 0; c < 3; ++c) corners[c] = vec::mul(mesh.vertices[static_cast<std::size_t>(t[c])], ball);
    if (corners[0][2] + corners[1][2] + corners[2][2] > 0) triangles.push_back(corners);
  }
  ProxyForce model(kRadius, kStiffness);
  ASSERT_TRUE(model.surface(triangles));
  model.tick(at(0, 0, 0.04), 1e-3);
  for (int k = 0; k <= 300; ++k) {
    const double along = 0.004 * k, around = 0.05 * k;
    const Vec3d direction{std::sin(along) * std::cos(around), std::sin(along) * std::sin(around), std::cos(along)};
    const Wrench w = model.tick({vec::mul(direction, distance)}, 1e-3);
    ASSERT_NEAR(vec::norm(w.force), kStiffness * (ball + kRadius - distance), kStiffness * 0.03 * ball) << k;
    ASSERT_GE(vec::dot(w.force, direction), 0.97 * vec::norm(w.force)) << k;
  }
}

TEST(Proxy, IsPutInFrontOfASurfaceThatMoved) {
  ProxyForce model(kRadius, kStiffness);
  Triangles flat = roof(0, 0);
  model.surface(flat);
  model.tick(at(0.001, 0, 0.005), 1e-3);
  for (auto& t : flat) {
    for (Vec3d& corner : t) corner[2] += 0.007;  // 2 mm beyond the centre
  }
  model.surface(flat);
  EXPECT_NEAR(model.tick(at(0.001, 0, 0.005), 1e-3).force[2], kStiffness * (0.007 + kRadius - 0.005), 1e-8);
  model.surface({});
  EXPECT_EQ(model.tick(at(0.001, 0, 0.005), 1e-3).force, Vec3d{});
}

TEST(Proxy, IgnoresWhatIsNoNumber) {
  ProxyForce model(kRadius, kStiffness);
  model.surface(roof(0, 0));
  model.tick(at(0, 0, 0.005), 1e-3);
  EXPECT_EQ(model.tick(at(0, std::nan(""), 0), 1e-3).force, Vec3d{});
  EXPECT_NEAR(model.tick(at(0, 0, 0.003), 1e-3).force[2], kStiffness * 1e-3, 1e-8);
}

TEST(Proxy, SaysWhatDoesNotFit) {
  ProxyForce model(kRadius, kStiffness);
  Triangles many(ProxyForce::kTriangles + 1, {Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}});
  EXPECT_FALSE(model.surface(many));
  EXPECT_NEAR(model.tick(at(0.2, 0.2, kRadius / 2), 1e-3).force[2], kStiffness * kRadius / 2, 1e-8);
}

}  // namespace
}  // namespace pliant::haptics::proxy_test
