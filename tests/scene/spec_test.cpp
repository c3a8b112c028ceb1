// A scene in code becomes the Scene that the file with the same content becomes, and is refused with the same messages.
#include "scene/spec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "geometry/mesh.h"
#include "scene/keys.h"
#include "support/error_of.h"
#include "support/source_dir.h"

namespace pliant::spec_test {
namespace {

std::vector<ProbeSpec> two_probes() {
  ProbeSpec point, nodes;
  point.name = "tip";
  point.point = Vec3d{0, 0, 0.1};
  nodes.name = "held";
  nodes.where = RegionSpec::plane({0, 0, 0}, {0, -1, 0});
  nodes.body = "b";
  nodes.quantities = {"reaction", "force"};
  return {point, nodes};
}

/// Two bodies with one of everything.
SceneSpec everything() {
  SceneSpec s;
  s.name = "everything";
  s.gravity = {0, -9.81, 0};
  s.gravity_curve = {"smooth", 0.1, 0.3, {}};
  s.dt = 1e-4;
  s.safety = 0.8;
  s.inverted = "stop";
  s.least_fill = 0.1;
  s.least_step = 0.2;
  s.break_stretch = 3;
  s.focus_path = {{0, 0, 0.1, 0}, {1, 0.1, 0.1, 0}};
  BladeSpec blade;
  blade.path = {{0, 0, -0.1, 0, 0, 0.1, 0}, {1, 0.2, -0.1, 0, 0.2, 0.1, 0}};
  blade.start = 0.1;
  s.blades = {blade};
  BodySpec a;
  a.name = "a";
  a.surface_file = "a.obj";
  a.lattice_spacing = 0.01;
  a.scale = 2;
  a.translate = {1, 2, 3};
  a.material.law = "yeoh";
  a.material.parameters = {{"c10", 500}, {"c20", 20}, {"c30", 3}, {"kappa", 50000}};
  a.material.hourglass = 0.5;
  a.material.damping = 4;
  a.inclusions = {{RegionSpec::sphere({0, 0, 0}, 0.1), {}}};
  a.fixed = {{RegionSpec::plane({0, 0, 0}, {0, -1, 0}), "xz"}};
  a.prescribed = {{RegionSpec::of_nodes({7, 3}), {0.1, std::nullopt, 0}, {"smooth", 0.1, 2, {}}}};
  PrescribedSpec turn;
  turn.where = RegionSpec::inside("tumour.obj");
  turn.rotate = RotationSpec{{0, 1, 0}, {0, 0, 0.1}, 90};
  turn.axes = "xz";
  a.prescribed.push_back(turn);
  a.initial = {{RegionSpec::all(), FieldSpec{{1, 2, 3}, {{{0, 1, 0}, {0, 0, 0}, {0, 0, 0}}}, {0, 0, 1}},
                FieldSpec{{0, 0, 0.1}, {}, {}}}};
  a.forces = {{RegionSpec::box({0, 0, 0}, {1, 1, 1}), {0, 0, 1}, {"table", 0, 1, {{0, 0}, {1, 2}}}}};
  a.pressures = {{RegionSpec::all(), 100, {}}};
  a.model.type = "hybrid";
  a.model.ratio = 0.4;
  a.model.seed = Vec3d{0, 0, 0.1};
  a.model.follow = "focus";
  a.model.substeps = 4;
  a.model.goals = "extrapolated";
  a.model.coupling = "one-sided";
  a.model.cut = false;
  BodySpec b;
  b.name = "b";
  b.surface.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  b.surface.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  b.velocity = {1, 0, 0};
  s.bodies = {a, b};
  s.probes = two_probes();
  return s;
}

const char* const file =
    R"({"format": "pliant-scene/1", "name": "everything", "dt": 1e-4,
        "gravity": {"acceleration": [0, -9.81, 0], "curve": "smooth", "start": 0.1, "duration": 0.3}, "safety": 0.8,
        "inverted": "stop", "least_fill": 0.1, "least_step": 0.2, "break_stretch": 3,
  "focus": {"path": [[0, 0, 0.1, 0], [1, 0.1, 0.1, 0]]},
  "blades": [{"path": [[0, 0, -0.1, 0, 0, 0.1, 0], [1, 0.2, -0.1, 0, 0.2, 0.1, 0]], "start": 0.1}],
  "bodies": [{"name": "a", "surface": "a.obj", "lattice": {"spacing": 0.01}, "scale": 2, "translate": [1, 2, 3],
    "material": {"law": "yeoh", "c10": 500, "c20": 20, "c30": 3, "kappa": 50000, "hourglass": 0.5, "damping": 4},
    "inclusions": [{"sphere": [[0, 0, 0], 0.1], "material": {"young": 3000, "poisson": 0.45}}],
    "fixed": [{"plane": [[0, 0, 0], [0, -1, 0]], "axes": "xz"}],
    "prescribed": [{"nodes": [7, 3], "displacement": [0.1, null, 0], "curve": "smooth", "start": 0.1, "duration": 2},
      {"surface": "tumour.obj", "rotate": {"axis": [0, 1, 0], "about": [0, 0, 0.1], "angle": 90}, "axes": "xz"}],
    "initial": [{"all": true, "velocity": {"offset": [1, 2, 3], "linear": [[0, 1, 0], [0, 0, 0], [0, 0, 0]], "about": [0, 0, 1]},
      "displacement": [0, 0, 0.1]}],
    "forces": [{"box": [[0, 0, 0], [1, 1, 1]], "force": [0, 0, 1], "table": [[0, 0], [1, 2]]}],
    "pressures": [{"all": true, "pressure": 100}],
    "model": {"type": "hybrid", "ratio": 0.4, "seed": [0, 0, 0.1], "follow": "focus", "substeps": 4, "goals": "extrapolated",
      "coupling": "one-sided", "cut": false}},
   {"name": "b", "surface": "memory:0", "lattice": {"nodes": 2000}, "material": {"young": 3000, "poisson": 0.45},
    "velocity": [1, 0, 0]}],
  "probes": [{"name": "tip", "point": [0, 0, 0.1]},
    {"name": "held", "body": "b", "plane": [[0, 0, 0], [0, -1, 0]], "quantities": ["reaction", "force"]}]})";

TEST(Spec, IsTheSceneOfTheFileWithTheSameContent) {
  const Scene scene = scene_of(everything());
  EXPECT_EQ(scene_to_json(scene), scene_to_json(parse_scene(file, "")));
  EXPECT_EQ(scene.bodies[0].inclusions[0].where.pointer, "/bodies/0/inclusions/0");
  EXPECT_EQ(scene.bodies[0].model.pointer, "/bodies/0/model");
  ASSERT_TRUE(scene.bodies[1].surface_in_memory);
  EXPECT_EQ(scene.bodies[1].surface_in_memory->vertices.size(), 4U);
}

TEST(Spec, ToolsAreThoseOfTheFile) {
  SceneSpec s;
  s.name = "scene";
  s.bodies.emplace_back().surface_file = "a.obj";
  s.bodies[0].name = "a";
  ToolSpec rod;
  rod.shape = "capsule";
  rod.radius = 0.02;
  rod.path = {{0, 0, 0, 1, 0, 0, 0, 1}};
  rod.friction = 0.3;
  rod.stiffness = 1e6;
  rod.alpha = 0.5;
  ToolSpec hand;
  hand.name = "hand";
  hand.shape = "mesh";
  hand.mesh = "hand.obj";
  hand.scale = 0.001;
  s.tools = {rod, hand};
  const char* const text = R"({"format": "pliant-scene/1", "name": "scene",
  "tools": [{"shape": {"capsule": [[0, 0, 0], [0, 0.1, 0], 0.02]}, "path": [[0, 0, 0, 1]], "friction": 0.3,
    "contact": {"stiffness": 1e6, "alpha": 0.5}}, {"name": "hand", "shape": {"mesh": "hand.obj"}, "scale": 0.001}],
  "bodies": [{"name": "a", "surface": "a.obj", "lattice": {"nodes": 2000}, "material": {"young": 3000, "poisson": 0.45}}]})";
  EXPECT_EQ(scene_to_json(scene_of(s)), scene_to_json(parse_scene(text, "")));
  s.tools[0].shape = "cone";
  EXPECT_NE(test::error_of([&] { (void)scene_of(s); }).find("/tools/0/shape: got \"cone\""), std::string::npos);
  s.tools[0].shape = "sphere";
  s.tools[0].stiffness = 0;
  EXPECT_NE(test::error_of([&] { (void)scene_of(s); }).find("/tools/0/contact/alpha: got 0.5"), std::string::npos);
}

TEST(Spec, SheetsSpringsVesselsAndJoinsAreThoseOfTheFile) {
  SceneSpec s;
  s.name = "scene";
  BodySpec skin, organ;
  skin.name = "skin";
  skin.surface_file = "skin.obj";
  skin.thickness = 0.002;
  skin.element = "tet4";
  skin.model.type = "mass-spring";
  skin.model.spring.law = "cubic";
  skin.model.spring.lambda1 = 3;
  skin.model.spring.lambda2 = 2;
  organ.name = "organ";
  organ.surface_file = "a.obj";
  organ.vessels = {{{{0, 0, 0}, {0, 0, 0.1}}, {{0, 1}}, 0.003, 0.001, 6e5, 1050}};
  s.bodies = {skin, organ};
  JoinSpec join;
  join.bodies = {"skin", "organ"};
  join.distance = 0.004;
  join.spring.law = "table";
  join.spring.curve = {{-0.01, -2}, {0, 0}, {0.01, 1}};
  join.spring.damping = 0.1;
  join.break_force = 0.3;
  s.joins = {join};
  const char* const text = R"({"format": "pliant-scene/1", "name": "scene",
  "bodies": [
    {"name": "skin", "surface": "skin.obj", "thickness": 0.002, "material": {"young": 3000, "poisson": 0.45},
     "model": {"type": "mass-spring", "spring": {"law": "cubic", "lambda1": 3, "lambda2": 2}}},
    {"name": "organ", "surface": "a.obj", "lattice": {"nodes": 2000}, "material": {"young": 3000, "poisson": 0.45},
     "vessels": [{"points": [[0, 0, 0], [0, 0, 0.1]], "radius": 0.003, "wall": 0.001, "young": 6e5, "density": 1050}]}],
  "joins": [{"bodies": ["skin", "organ"], "distance": 0.004, "break_force": 0.3,
    "spring": {"law": "table", "table": [[-0.01, -2], [0, 0], [0.01, 1]], "damping": 0.1}}]})";
  EXPECT_EQ(scene_to_json(scene_of(s)), scene_to_json(parse_scene(text, "")));
  s.joins[0].bodies[1] = "spleen";
  EXPECT_NE(test::error_of([&] { (void)scene_of(s); }).find("/joins/0/bodies/1: got \"spleen\""), std::string::npos);
}

TEST(Spec, RegionsOfAMeshAreThoseOfTheFile) {
  SceneSpec spec;
  spec.name = "scene";
  BodySpec& b = spec.bodies.emplace_back();
  b.name = "organ";
  b.volume_file = "organ.msh";
  b.element = "tet4";
  b.inclusions = {{RegionSpec::tagged("tumour"), {}}};
  b.fixed = {{RegionSpec::tagged(-3)}};
  b.pressures = {{RegionSpec::tagged(7), 100, {}}};
  b.pressures[0].where.region_data = "part";
  b.pressures[0].where.region_dimension = 2;
  const Scene scene = scene_of(spec);
  const Scene same = parse_scene(
      R"({"format": "pliant-scene/1", "name": "scene", "bodies": [{"name": "organ", "mesh": "organ.msh", "element": "tet4",
    "material": {"young": 3000, "poisson": 0.45},
    "inclusions": [{"region": "tumour", "material": {"young": 3000, "poisson": 0.45}}], "fixed": [{"region": -3}],
    "pressures": [{"region": 7, "data": "part", "dimension": 2, "pressure": 100}]}]})",
      "");
  EXPECT_EQ(scene_to_json(scene), scene_to_json(same));
  EXPECT_NE(scene_to_json(same).find("\"data\": \"part\""), std::string::npos);
  spec.bodies[0].volume_file = "";
  spec.bodies[0].surface_file = "a.obj";
  spec.bodies[0].lattice_spacing = 0.1;
  EXPECT_NE(test::error_of([&] { scene_of(spec); }).find("/region: got"), std::string::npos);
}

TEST(Spec, TakesEveryLawByItsParameters) {
  for (const Law law : all_laws()) {
    const Material wanted = make_material(law, Moduli::from_bulk(1000, 50000));
    SceneSpec spec = everything();
    MaterialSpec& m = spec.bodies[1].material;
    m.law = to_string(law);
    for (std::size_t i = 0; i < wanted.parameters.size(); ++i)
      m.parameters[law_info(law).parameters[i].name] = wanted.parameters[i];
    const Material found = scene_of(spec).bodies[1].material;
    EXPECT_EQ(found.law, law);
    EXPECT_EQ(found.parameters, wanted.parameters) << to_string(law);
    spec.bodies[1].element = "tet4anp";
    EXPECT_EQ(test::error_of([&] { scene_of(spec); }).empty(), law_info(law).volumetric) << to_string(law);
  }
}

TEST(Spec, WorksForTearingAndRelaxationToo) {
  SceneSpec spec = everything();
  spec.blades.clear();
  spec.bodies.erase(spec.bodies.begin());
  spec.relaxation = RelaxationSpec{1e-5, 500};
  EXPECT_TRUE(scene_of(spec).relaxation.enabled);
  spec.relaxation.reset();
  BodySpec& b = spec.bodies[0];
  b.surface = {};
  b.volume_file = "b.msh";
  b.element = "tet4";
  b.material.toughness = 9000;
  b.material.integrity = 0.5;
  const Scene scene = scene_of(spec);
  EXPECT_EQ(scene.bodies[0].material.toughness, 9000);
  EXPECT_EQ(scene.bodies[0].material.integrity, 0.5);
}

struct Case {
  std::function<void(SceneSpec&)> spoil;
  const char* message;  ///< its beginning
};
const double kNan = std::numeric_limits<double>::quiet_NaN();

const std::vector<Case> of_scenes{
    {[](SceneSpec& s) { s.gravity[1] = kNan; }, "scene: /gravity/acceleration/1: got nan, expected a number"},
    {[](SceneSpec& s) { s.gravity_curve = {}, s.gravity[1] = kNan; }, "scene: /gravity/1: got nan, expected a number"},
    {[](SceneSpec& s) { s.gravity_curve.duration = 0; }, "scene: /gravity/duration: got 0, expected a number > 0"},
    {[](SceneSpec& s) { s.dt = -1; }, "scene: /dt: got -1, expected \"auto\" or a number > 0"},
    {[](SceneSpec& s) { s.safety = 1.5; }, "scene: /safety: got 1.5, expected a number with 0 < safety <= 1"},
    {[](SceneSpec& s) { s.integrator = "verlet"; }, "scene: /integrator: got \"verlet\", expected one of increment, textbook"},
    {[](SceneSpec& s) { s.integrator = "textbook"; }, "scene: /integrator: got \"textbook\", expected increment, because"},
    {[](SceneSpec& s) {
       s.relaxation = RelaxationSpec{2, 10};
     },
     "scene: /relaxation/tolerance: got 2, expected a number"},
    {[](SceneSpec& s) { s.focus_path.pop_back(), s.focus_path.pop_back(); }, "scene: /bodies/0/model/follow: got \"focus\""},
    {[](SceneSpec& s) { s.blades[0].path.pop_back(); }, "scene: /blades/0/path: got"},
    {[](SceneSpec& s) { s.blades[0].end = 0; }, "scene: /blades/0/end: got 0, expected a time after the start 0.1"},
    {[](SceneSpec& s) { s.bodies.clear(); }, "scene: /bodies: got [], expected a list of at least one body"},
    {[](SceneSpec& s) { s.bodies[1].name = "a"; }, "scene: /bodies/1: got the name \"a\", which /bodies/0 has already"},
    {[](SceneSpec& s) { s.bodies[0].name = "a/b"; }, "scene: /bodies/0/name: got \"a/b\", expected a name of 1 to 100"},
    {[](SceneSpec& s) { s.bodies[0].volume_file = "x"; }, "body \"a\": exactly one of surface, surface_file and volume_file"},
    {[](SceneSpec& s) { s.bodies[0].scale = 0; }, "scene: /bodies/0/scale: got 0, expected a number > 0"},
    {[](SceneSpec& s) { s.bodies[0].lattice_spacing = -1; }, "scene: /bodies/0/lattice/spacing: got -1, expected a number > 0"},
    {[](SceneSpec& s) { s.bodies[1].lattice_nodes = 3; },
     "scene: /bodies/1/lattice/nodes: got 3, expected a whole number from 8"},
    {[](SceneSpec& s) { s.bodies[0].element = "hex9"; }, "scene: /bodies/0/element: got \"hex9\", expected one of"},
};

const std::vector<Case> of_materials_and_entries{
    {[](SceneSpec& s) { s.bodies[0].material.law = "yeho"; }, "scene: /bodies/0/material/law: got \"yeho\", expected one of"},
    {[](SceneSpec& s) { s.bodies[0].material.parameters.erase("c20"); }, "scene: /bodies/0/material: got no \"c20\", expected"},
    {[](SceneSpec& s) { s.bodies[0].material.parameters.clear(); }, "scene: /bodies/0/material/young: got 3000, expected no"},
    {[](SceneSpec& s) { s.bodies[1].material.poisson = 0.5; }, "scene: /bodies/1/material/poisson: got 0.5, expected a number"},
    {[](SceneSpec& s) { s.bodies[1].material.density = 0; }, "scene: /bodies/1/material/density: got 0, expected a number > 0"},
    {[](SceneSpec& s) { s.bodies[1].material.hourglass = -1; }, "scene: /bodies/1/material/hourglass: got -1, expected"},
    {[](SceneSpec& s) { s.bodies[1].material.integrity = 0.5; }, "scene: /bodies/1/material/integrity: got 0.5, expected no"},
    {[](SceneSpec& s) { s.bodies[1].material.toughness = 1; }, "scene: /bodies/1/material/toughness: got 1, expected no"},
    {[](SceneSpec& s) { s.bodies[0].inclusions[0].material.young = -1; },
     "scene: /bodies/0/inclusions/0/material/young: got -1, expected a number > 0"},
    {[](SceneSpec& s) { s.bodies[0].inclusions[0].where.radius = 0; },
     "scene: /bodies/0/inclusions/0/sphere/1: got 0, expected a number > 0"},
    {[](SceneSpec& s) { s.bodies[0].fixed[0].where.b = {}; }, "scene: /bodies/0/fixed/0/plane/1: got"},
    {[](SceneSpec& s) { s.bodies[0].fixed[0].axes = "xx"; },
     "scene: /bodies/0/fixed/0/axes: got \"xx\", expected one to three"},
    {[](SceneSpec& s) { s.bodies[0].fixed[0].axes = ""; }, "scene: /bodies/0/fixed/0/axes: got \"\", expected one to three"},
    {[](SceneSpec& s) {
       s.bodies[0].prescribed[0].where.nodes = {3, 3};
     },
     "scene: /bodies/0/prescribed/0/nodes: got node 3"},
    {[](SceneSpec& s) { s.bodies[0].prescribed[0].curve.kind = "sine"; }, "scene: /bodies/0/prescribed/0/curve: got \"sine\""},
    {[](SceneSpec& s) { s.bodies[0].prescribed[0].curve.duration = 0; },
     "scene: /bodies/0/prescribed/0/duration: got 0, expected a number > 0"},
    {[](SceneSpec& s) { s.bodies[0].prescribed[0].displacement = {}; }, "scene: /bodies/0/prescribed/0/displacement: got"},
    {[](SceneSpec& s) {
       s.bodies[0].forces[0].where.b = {-1, 0, 0};
     },
     "scene: /bodies/0/forces/0/box: got x from 0 to -1"},
    {[](SceneSpec& s) { s.bodies[0].forces[0].curve.table[1][0] = 0; }, "scene: /bodies/0/forces/0/table/1/0: got 0, expected"},
    {[](SceneSpec& s) { s.bodies[0].pressures[0].pressure = kNan; }, "scene: /bodies/0/pressures/0/pressure: got nan"},
    {[](SceneSpec& s) { s.bodies[0].model.type = "fem"; }, "scene: /bodies/0/model/type: got \"fem\", expected one of"},
    {[](SceneSpec& s) { s.bodies[0].model.width = 9; }, "scene: /bodies/0/model/width: got 9, expected a whole number from 1"},
    {[](SceneSpec& s) { s.bodies[0].model.beta = -1; }, "scene: /bodies/0/model/beta: got -1, expected \"auto\" or"},
    {[](SceneSpec& s) { s.bodies[0].model.goals = "hold"; }, "scene: /bodies/0/model/goals: got \"hold\", expected one of"},
    {[](SceneSpec& s) { s.bodies[0].model.follow.clear(), s.bodies[0].model.region = RegionSpec::all(); },
     "scene: /bodies/0/model/region: got the unknown key \"all\", expected one of box, sphere"},
    {[](SceneSpec& s) {
       s.bodies[0].model.region = RegionSpec::sphere({0, 0, 0}, 1);
     },
     "scene: /bodies/0/model: got both \"region\" and \"follow\""},
    {[](SceneSpec& s) { s.bodies[0].model.alpha = 0.5, s.bodies[0].model.young = 3000; },
     "scene: /bodies/0/model: got both \"alpha\" and \"stiffness\""},
    {[](SceneSpec& s) { s.probes[0].name = "held"; }, "scene: /probes/1: got the name \"held\", which /probes/0 has already"},
    {[](SceneSpec& s) { s.probes[0].quantities = {"heat"}; }, "scene: /probes/0/quantities/0: got \"heat\", expected one of"},
    {[](SceneSpec& s) { s.probes[0].quantities = {"force"}; }, "scene: /probes/0/quantities/0: got \"force\", expected no"},
    {[](SceneSpec& s) { s.probes[0].point->at(1) = kNan; }, "scene: /probes/0/point/1: got nan, expected a number"},
    {[](SceneSpec& s) { s.probes[1].body = "c"; }, "scene: /probes/1/body: got \"c\", expected one of a, b"},
    {[](SceneSpec& s) { s.probes[1].body = ""; }, "scene: /probes/1: got no \"body\", expected the name of a body"},
    {[](SceneSpec& s) { s.probes[1].where.b = {}; }, "scene: /probes/1/plane/1: got"},
    {[](SceneSpec& s) { s.probes[1].body = "a"; }, "scene: /probes/1: got a reaction of body \"a\", whose model is hybrid"},
};

TEST(Spec, MistakesAreNamedAsInAFile) {
  for (const std::vector<Case>* cases : {&of_scenes, &of_materials_and_entries}) {
    for (const Case& c : *cases) {
      SceneSpec spec = everything();
      c.spoil(spec);
      const std::string message = test::error_of([&] { scene_of(spec); });
      EXPECT_EQ(message.substr(0, std::string(c.message).size()), c.message) << message;
    }
  }
}

TEST(Spec, TakesAModulusPerElement) {
  BodySpec body;
  body.volume_file = test::source_dir() + "/scenes/meshes/nodule_tet.vtu";
  body.element = "tet4";
  body.material.young_field = "E";
  body.material.poisson = 0.4;
  SceneSpec spec;
  spec.bodies = {body};
  const Material m = scene_of(spec).bodies[0].material;
  ASSERT_NE(m.young_field, nullptr);
  EXPECT_EQ(m.young_field->values.size(), 4800u);
  EXPECT_EQ(m.young_field->largest, *std::max_element(m.young_field->values.begin(), m.young_field->values.end()));
  EXPECT_NEAR(m.moduli.young(), m.young_field->largest, 1e-9 * m.young_field->largest);
}

}  // namespace
}  // namespace pliant::spec_test
