#include <gtest/gtest.h>

#include <filesystem>

#include "scene/scene.h"
#include "support/error_of.h"
#include "support/temp_folder.h"

namespace pliant {
namespace {

const char* const full = R"({
  "format": "pliant-scene/1", "name": "everything", "gravity": [0, -9.81, 0], "dt": 1e-4, "safety": 0.8, "duration": 2.5,
  "inverted": "stop", "least_fill": 0.1, "least_step": 0.2, "break_stretch": 3,
  "integrator": "textbook", "relaxation": {"tolerance": 1e-6, "max_steps": 500},
  "bodies": [
    {"name": "liver", "surface": "meshes/liver.obj", "scale": 0.001, "translate": [1, 2, 3], "lattice": {"spacing": 0.008},
     "element": "hex8full", "material": {"law": "isochoric-neo-hookean", "mu": 1000, "kappa": 50000, "density": 1060,
                                         "damping": 5, "hourglass": 0.5},
     "model": {"type": "tled"},
     "inclusions": [{"sphere": [[0, 0, 0], 0.01], "material": {"young": 50000, "poisson": 0.3}}],
     "fixed": [{"box": [[-1, -1, -1], [1, 0, 1]]}, {"nodes": [7, 3], "axes": "zx"}],
     "prescribed": [{"plane": [[0, 0.1, 0], [0, 1, 0]], "displacement": [null, -0.02, 0], "curve": "smooth", "start": 0.5,
                     "duration": 0.25}],
     "forces": [{"all": true, "force": [1, 2, 3], "table": [[0, 0], [1, 1]]}],
     "pressures": [{"all": true, "pressure": -200, "curve": "ramp", "duration": 1}],
     "velocity": [0.1, 0, 0], "angular_velocity": [0, 0, 6]},
    {"mesh": "/data/beam.msh", "material": {"lambda": 2000, "mu": 1000}}
  ]})";

TEST(Load, EveryKeyArrives) {
  const Scene s = parse_scene(full, "dir/scene.json");
  EXPECT_EQ(s.name, "everything");
  EXPECT_EQ(s.gravity, (Vec3d{0, -9.81, 0}));
  EXPECT_EQ(s.dt, 1e-4);
  EXPECT_EQ(s.safety, 0.8);
  EXPECT_EQ(s.inverted, Inverted::stop);
  EXPECT_EQ(s.least_fill, 0.1);
  EXPECT_EQ(s.least_step, 0.2);
  EXPECT_EQ(s.break_stretch, 3);
  EXPECT_EQ(s.duration, 2.5);
  EXPECT_EQ(s.integrator, Integrator::textbook);
  EXPECT_TRUE(s.relaxation.enabled);
  EXPECT_EQ(s.relaxation.tolerance, 1e-6);
  EXPECT_EQ(s.relaxation.max_steps, 500);
  ASSERT_EQ(s.bodies.size(), 2U);

  const Body& b = s.bodies[0];
  EXPECT_EQ(b.name, "liver");
  EXPECT_EQ(b.surface, "dir/meshes/liver.obj");
  EXPECT_TRUE(b.mesh.empty());
  EXPECT_EQ(b.scale, 0.001);
  EXPECT_EQ(b.translate, (Vec3d{1, 2, 3}));
  EXPECT_EQ(b.lattice.spacing, 0.008);
  EXPECT_EQ(b.lattice.nodes, 0);
  EXPECT_EQ(b.element, ElementKind::hex8full);
  EXPECT_EQ(b.velocity, (Vec3d{0.1, 0, 0}));
  EXPECT_EQ(b.angular_velocity, (Vec3d{0, 0, 6}));
  EXPECT_EQ(b.pointer, "/bodies/0");
}

TEST(Load, MaterialsArrive) {
  const Scene s = parse_scene(full, "dir/scene.json");
  const Material& m = s.bodies[0].material;
  EXPECT_EQ(m.law, Law::isochoric_neo_hookean);
  EXPECT_EQ(m.moduli.mu, 1000);
  EXPECT_EQ(m.moduli.kappa, 50000);
  EXPECT_DOUBLE_EQ(m.moduli.lambda, 50000 - 2000.0 / 3);
  EXPECT_EQ(m.density, 1060);
  EXPECT_EQ(m.damping, 5);
  EXPECT_EQ(m.hourglass, 0.5);
  const Material& stiff = s.bodies[0].inclusions.at(0).material;
  EXPECT_DOUBLE_EQ(stiff.moduli.mu, 50000 / 2.6);
  EXPECT_DOUBLE_EQ(stiff.moduli.lambda, 50000 * 0.3 / (1.3 * 0.4));
  EXPECT_DOUBLE_EQ(stiff.moduli.kappa, 50000 / (3 * 0.4));
  EXPECT_NEAR(stiff.moduli.young(), 50000, 1e-8);
  EXPECT_NEAR(stiff.moduli.poisson(), 0.3, 1e-14);
  const Material& lame = s.bodies[1].material;
  EXPECT_EQ(lame.moduli.lambda, 2000);
  EXPECT_DOUBLE_EQ(lame.moduli.kappa, 2000 + 2000.0 / 3);
}

TEST(Load, ConditionsArrive) {
  const Body b = parse_scene(full, "dir/scene.json").bodies[0];
  EXPECT_EQ(b.inclusions[0].where.kind, Selection::Kind::sphere);
  EXPECT_EQ(b.inclusions[0].where.radius, 0.01);
  ASSERT_EQ(b.fixed.size(), 2U);
  EXPECT_EQ(b.fixed[0].where.b, (Vec3d{1, 0, 1}));
  EXPECT_EQ(b.fixed[0].axes, (std::array<bool, 3>{true, true, true}));
  EXPECT_EQ(b.fixed[1].axes, (std::array<bool, 3>{true, false, true}));
  EXPECT_EQ(b.fixed[1].where.nodes, (std::vector<std::int64_t>{3, 7}));
  EXPECT_EQ(b.fixed[1].where.pointer, "/bodies/0/fixed/1");
  const Prescribed& p = b.prescribed.at(0);
  EXPECT_EQ(p.where.kind, Selection::Kind::plane);
  EXPECT_FALSE(p.displacement[0]);
  EXPECT_EQ(p.displacement[1], -0.02);
  EXPECT_EQ(p.displacement[2], 0.0);
  EXPECT_EQ(p.curve.kind, Curve::Kind::smooth);
  EXPECT_EQ(p.curve.start, 0.5);
  EXPECT_EQ(p.curve.duration, 0.25);
  EXPECT_EQ(b.forces.at(0).force, (Vec3d{1, 2, 3}));
  EXPECT_EQ(b.forces[0].curve.kind, Curve::Kind::table);
  EXPECT_EQ(b.forces[0].curve.table.size(), 2U);
  EXPECT_EQ(b.pressures.at(0).pressure, -200);
  EXPECT_EQ(b.pressures[0].curve.kind, Curve::Kind::ramp);
}

TEST(Load, Defaults) {
  const Scene s = parse_scene(R"({"format": "pliant-scene/1", "bodies": [
      {"surface": "a.obj", "lattice": {"nodes": 100}, "material": {"young": 1, "poisson": 0}}, {"mesh": "b.msh",
       "material": {"young": 1, "poisson": 0}}]})",
                              "dir/stem.json");
  EXPECT_EQ(s.name, "stem");
  EXPECT_EQ(s.dt, 0);
  EXPECT_EQ(s.integrator, Integrator::increment);
  EXPECT_FALSE(s.relaxation.enabled);
  EXPECT_EQ(s.bodies[0].name, "body0");
  EXPECT_EQ(s.bodies[0].element, ElementKind::hex8);
  EXPECT_EQ(s.bodies[0].lattice.nodes, 100);
  EXPECT_EQ(s.bodies[0].material.law, Law::neo_hookean);
  EXPECT_EQ(s.bodies[0].material.density, 1000);
  EXPECT_EQ(s.bodies[1].name, "body1");
  EXPECT_EQ(s.bodies[1].element, ElementKind::tet4);
}

TEST(Load, AbsolutePathsStay) { EXPECT_EQ(parse_scene(full, "dir/scene.json").bodies[1].mesh, "/data/beam.msh"); }

/// The moduli must come back to the last bit, whichever pair was given.
void expect_same(const Material& a, const Material& b) {
  EXPECT_EQ(a.law, b.law);
  EXPECT_EQ(a.parameters, b.parameters);
  EXPECT_EQ(a.moduli.mu, b.moduli.mu);
  EXPECT_EQ(a.moduli.lambda, b.moduli.lambda);
  EXPECT_EQ(a.moduli.kappa, b.moduli.kappa);
  EXPECT_EQ(a.density, b.density);
  EXPECT_EQ(a.damping, b.damping);
  EXPECT_EQ(a.hourglass, b.hourglass);
}

TEST(Write, RoundTripKeepsEverything) {
  const Scene a = parse_scene(full, "dir/scene.json");
  const std::string text = scene_to_json(a);
  const Scene b = parse_scene(text, "dir/scene.json");
  EXPECT_EQ(scene_to_json(b), text);
  EXPECT_EQ(b.dt, a.dt);
  EXPECT_EQ(b.relaxation.max_steps, 500);
  ASSERT_EQ(b.bodies.size(), 2U);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(b.bodies[i].surface, a.bodies[i].surface);
    EXPECT_EQ(b.bodies[i].mesh, a.bodies[i].mesh);
    EXPECT_EQ(b.bodies[i].element, a.bodies[i].element);
    expect_same(b.bodies[i].material, a.bodies[i].material);
  }
  expect_same(b.bodies[0].inclusions.at(0).material, a.bodies[0].inclusions[0].material);
  EXPECT_EQ(b.bodies[0].fixed.at(1).where.nodes, a.bodies[0].fixed[1].where.nodes);
  EXPECT_EQ(b.bodies[0].fixed[1].axes, a.bodies[0].fixed[1].axes);
  EXPECT_EQ(b.bodies[0].prescribed.at(0).displacement, a.bodies[0].prescribed[0].displacement);
  EXPECT_EQ(b.bodies[0].prescribed[0].curve.start, 0.5);
  EXPECT_EQ(b.bodies[0].forces.at(0).curve.table, a.bodies[0].forces[0].curve.table);
  EXPECT_EQ(b.bodies[0].pressures.at(0).pressure, -200);
  EXPECT_EQ(b.bodies[0].angular_velocity, a.bodies[0].angular_velocity);
}

TEST(Write, ModuliSurviveForManyPairs) {
  for (int i = 1; i < 200; ++i) {
    const std::string moduli = i % 2
                                   ? R"("young": )" + std::to_string(37.7 * i) + R"(, "poisson": )" + std::to_string(0.0024 * i)
                                   : R"("mu": )" + std::to_string(3.3 * i) + R"(, "kappa": )" + std::to_string(1e5 / i);
    const Scene a =
        parse_scene(R"({"format": "pliant-scene/1", "bodies": [{"mesh": "b.msh", "material": {)" + moduli + "}}]}", "s");
    expect_same(parse_scene(scene_to_json(a), "s").bodies[0].material, a.bodies[0].material);
  }
}

TEST(Load, FilesThatCannotBeRead) {
  const auto message = [](const std::filesystem::path& file) { return test::error_of([&] { load_scene(file); }); };
  EXPECT_EQ(message("no/such/scene.json"), "no/such/scene.json: no such file, expected a scene file");
  const test::TempFolder folder;
  EXPECT_NE(message(folder.path()).find("got a folder"), std::string::npos) << message(folder.path());
  const auto empty = folder.write("empty.json", "");
  EXPECT_NE(message(empty).find("line 1, column 1"), std::string::npos) << message(empty);
}

}  // namespace
}  // namespace pliant
