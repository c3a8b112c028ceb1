// What is said of a scene before its first step.
#include "physics/harness.h"
#include "simulation/simulation.h"

namespace pliant::physics {
namespace {

std::vector<std::string> remarks(double stretch, double distortion, ElementKind element) {
  const Discretization cut = element == ElementKind::tet4 ? Discretization::tet4 : Discretization::hex8;
  VolumeMesh mesh = make_mesh({{4, 2, 2}, 0.01, distortion, 3}, is_tet(cut));
  for (Vec3d& x : mesh.vertices) x[1] *= stretch;
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

TEST(Remarks, HexahedraThatAreNoCubes) {
  EXPECT_TRUE(remarks(1, 0, ElementKind::hex8).empty());
  EXPECT_TRUE(remarks(1, 0.05, ElementKind::hex8).empty()) << "distorted, but nearly as long as wide";
  for (const double stretch : {2.0, 0.5}) {
    const std::vector<std::string> said = remarks(stretch, 0, ElementKind::hex8);
    ASSERT_EQ(said.size(), 1U) << stretch;
    EXPECT_NE(said[0].find("body 'bar' has hex8 elements up to 2 times as long as wide"), std::string::npos) << said[0];
    EXPECT_NE(said[0].find("hex8full"), std::string::npos) << said[0];
    EXPECT_TRUE(remarks(stretch, 0, ElementKind::hex8full).empty());
    EXPECT_TRUE(remarks(stretch, 0, ElementKind::tet4).empty());
  }
}

}  // namespace
}  // namespace pliant::physics
