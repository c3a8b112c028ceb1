// The engine at rest after dynamic relaxation and the static solver give the same displacements on the same mesh: two programs
// that share no line between the Model and the answer.
#include "problems.h"
#include "support/error_of.h"

namespace pliant::statics_test {
namespace {

using physics::Discretization;

Scene loaded(Discretization cut, Law law) {
  Scene scene;
  scene.gravity = {0, -8, 0};
  scene.gravity_curve.kind = Curve::Kind::table;
  scene.gravity_curve.table = {{0, 0}, {0.05, 1}, {0.1, 0.5}};  // both count what is left in the end
  Body body = physics::box_body({{4, 2, 2}, 0.05, 0.2, 5}, cut, physics::material_young(law, 10000, 0.4));
  body.fixed.push_back({physics::face(0, 0)});
  Prescribed pull;
  pull.where = physics::face(0, 0.2);
  pull.displacement = {0.02, std::nullopt, 0.01};
  pull.curve = physics::smooth(0.1);
  body.prescribed.push_back(pull);
  Inclusion stiff;
  stiff.where.kind = Selection::Kind::box;
  stiff.where.a = {0, 0, 0};
  stiff.where.b = {0.1, 0.05, 0.1};
  stiff.material = physics::material_young(law, 30000, 0.3);
  body.inclusions.push_back(stiff);
  Pressure squeeze;
  squeeze.where = physics::face(1, 0.1);
  squeeze.pressure = 100;
  body.pressures.push_back(squeeze);
  Force push;
  push.where = physics::face(2, 0.1);
  push.force = {0, 0.05, 0};
  body.forces.push_back(push);
  scene.bodies.push_back(body);
  scene.relaxation.enabled = true;
  scene.relaxation.tolerance = 1e-7;
  scene.relaxation.max_steps = 200000;
  return scene;
}

/// Pressure as the engine applies it: on two flat triangles of a hexahedron's face.
Problem on_flat_triangles(Problem problem) {
  std::vector<std::int32_t> point(problem.mesh.nodes.size(), -1);
  for (std::size_t v = 0; v < problem.surface.size(); ++v) point[problem.surface[v].nodes[0]] = static_cast<std::int32_t>(v);
  for (const statics::FacePressure& face : problem.face_pressures) {
    statics::Pressure flat{{}, face.pressure};
    for (std::size_t v = 0; v < 3; ++v) flat.points[v] = point[problem.mesh.nodes_of(face.element)[face.corners[v]]];
    problem.pressures.push_back(flat);
  }
  problem.face_pressures.clear();
  return problem;
}

TEST(Engine, ComesToRestWhereTheStaticSolverSays) {
  for (const Discretization cut : {Discretization::tet4, Discretization::hex8full, Discretization::hex8full_lattice}) {
    for (const Law law : all_laws()) {
      const Scene scene = loaded(cut, law);
      const auto sim = physics::simulate(scene, "cpu:double");
      physics::settle(*sim);
      const Solution s = solved(on_flat_triangles(statics::problem_of(scene, sim->model(), 0)));
      const std::vector<Vec3d> u = sim->displacements(0);
      double most = 0, largest = 0;
      for (std::size_t n = 0; n < u.size(); ++n) {
        most = std::max(most, vec::norm(vec::sub(u[n], s.displacement[n])));
        largest = std::max(largest, vec::norm(u[n]));
      }
      physics::check(std::string(physics::name_of(cut)) + " " + to_string(law), most / largest, 1e-6);
    }
  }
}

TEST(Engine, BricksBecomeFullHexahedraAndShapeMatchingIsRefused) {
  Scene scene = loaded(Discretization::hex8_bricks, Law::neo_hookean);
  const Model bricks = build_model(scene);
  const Problem a = statics::problem_of(scene, bricks, 0);
  scene.bodies[0].element = ElementKind::hex8full;
  const Problem b = statics::problem_of(scene, build_model(scene), 0);
  EXPECT_EQ(a.mesh.element, Element::hex8full);
  EXPECT_EQ(a.mesh.corners, b.mesh.corners);
  EXPECT_EQ(a.mesh.fill, b.mesh.fill);
  const Solution x = solved(a), y = solved(b);
  EXPECT_LE(largest_miss(a, x, [&](const Eigen::Vector3d&) { return Eigen::Vector3d::Zero().eval(); }), 0.1);
  for (std::size_t n = 0; n < x.displacement.size(); ++n)
    EXPECT_LE(vec::norm(vec::sub(x.displacement[n], y.displacement[n])), 1e-9);
  scene.bodies[0].model.type = ModelType::hybrid;
  EXPECT_NE(test::error_of([&] { statics::problem_of(scene, bricks, 0); }).find("takes tled only"), std::string::npos);
}

}  // namespace
}  // namespace pliant::statics_test
