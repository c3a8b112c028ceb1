// What is said of a scene before its first step.

#include "physics/harness.h"
#include "simulation/simulation.h"

namespace pliant::physics {
namespace {

/// Of a bar of 4 x 2 x 2 cells, its nodes moved.
std::vector<std::string> remarks(ElementKind element, const std::function<Vec3d(const Vec3d&)>& moved, double distortion = 0) {
  const Discretization cut = element == ElementKind::tet4 ? Discretization::tet4 : Discretization::hex8;
  VolumeMesh mesh = make_mesh({{4, 2, 2}, 0.01, distortion, 3}, is_tet(cut));
  for (Vec3d& x : mesh.vertices) x = moved(x);
  Body body;
  body.name = "bar";
  body.mesh = save(mesh);
  body.element = element;
  body.material = material_young(Law::neo_hookean, 3000, 0.3);
  body.pointer = "/bodies/0";
  Scene scene;
  scene.bodies.push_back(std::move(body));
  return Simulation(scene, open_backend("cpu")).remarks();
}

TEST(Remarks, HexahedraFarFromBricks) {
  for (const double stretch : {1.0, 2.0, 0.25}) {
    const auto moved = [&](const Vec3d& x) { return Vec3d{x[0], x[1] * stretch, x[2]}; };
    EXPECT_TRUE(remarks(ElementKind::hex8, moved).empty()) << stretch;
  }
  EXPECT_TRUE(remarks(
                  ElementKind::hex8, [](const Vec3d& x) { return x; }, 0.05)
                  .empty())
      << "distorted, but nearly bricks";
  const auto sheared = [](double by) { return [=](const Vec3d& x) { return Vec3d{x[0] + by * x[1], x[1], x[2]}; }; };
  EXPECT_TRUE(remarks(ElementKind::hex8, sheared(0.8)).empty());
  const auto tapered = [](double by) {  // every other plane of nodes leans to the other side
    return [=](const Vec3d& x) {
      return Vec3d{x[0] + (std::lround(x[0] / 0.01) % 2 != 0 ? by : -by) * (x[1] - 0.01), x[1], x[2]};
    };
  };
  EXPECT_TRUE(remarks(ElementKind::hex8, tapered(0.15)).empty());
  const std::vector<std::string> skewed = remarks(ElementKind::hex8, sheared(1)),
                                 wedges = remarks(ElementKind::hex8, tapered(0.4));
  ASSERT_EQ(skewed.size(), 1U);
  EXPECT_NE(skewed[0].find("body 'bar': 16 of 16 hex8 elements"), std::string::npos) << skewed[0];
  EXPECT_NE(skewed[0].find("up to 45 degrees"), std::string::npos) << skewed[0];
  ASSERT_EQ(wedges.size(), 1U);
  EXPECT_NE(wedges[0].find("differ by up to 0.67 of"), std::string::npos) << wedges[0];
  for (const ElementKind other : {ElementKind::hex8full, ElementKind::tet4}) {
    EXPECT_TRUE(remarks(other, sheared(1)).empty());
    EXPECT_TRUE(remarks(other, tapered(0.4)).empty());
  }
}

}  // namespace
}  // namespace pliant::physics
