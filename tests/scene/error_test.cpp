// Every mistake gets one message that names the file, the place, the value and what is allowed.
#include "pliant/error.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scene/keys.h"
#include "scene/scene.h"
#include "support/error_of.h"
#include "support/source_dir.h"

namespace pliant {
namespace {

using Json = nlohmann::json;

const char* const kGoodScene = R"({"format": "pliant-scene/1", "bodies": [
  {"name": "a", "surface": "a.obj", "lattice": {"spacing": 0.1}, "material": {"young": 3000, "poisson": 0.45},
   "inclusions": [{"all": true, "material": {"young": 3000, "poisson": 0.45}}],
   "fixed": [{"all": true}],
   "prescribed": [{"all": true, "displacement": [0, 0, 0], "curve": "smooth", "duration": 1}],
   "forces": [{"all": true, "force": [0, 0, 0]}],
   "pressures": [{"all": true, "pressure": 1}]}]})";

/// The message for a scene text, or "" if it loads.
std::string message(const std::string& text) {
  return test::error_of([&] { parse_scene(text, "dir/s.json"); });
}

/// The message after one member of the good scene is replaced; "" as value removes it.
std::string patched(const std::string& pointer, const std::string& value) {
  Json scene = Json::parse(kGoodScene);
  const Json::json_pointer place(pointer);
  if (value.empty()) {
    scene.at(place.parent_pointer()).erase(place.back());
  } else {
    scene[place] = Json::parse(value);
  }
  return message(scene.dump());
}

struct Case {
  const char* pointer;
  const char* value;
  std::string expected;  ///< the whole message after "dir/s.json: ", or its beginning
};

void expect_named(const std::vector<Case>& cases) {
  for (const Case& c : cases) {
    const std::string expected = std::string("dir/s.json: ") + c.expected;
    const std::string text = patched(c.pointer, c.value);
    EXPECT_EQ(text.substr(0, expected.size()), expected) << c.pointer << " = " << c.value << "\n" << text;
  }
}

const std::vector<Case> values{
    {"/format", "\"pliant-scene/2\"", "/format: got \"pliant-scene/2\", expected \"pliant-scene/1\""},
    {"/format", "", "top level: got no \"format\", expected"},
    {"/bodies", "", "top level: got no \"bodies\", expected a list of at least one body"},
    {"/bodies", "[]", "/bodies: got [], expected a list of at least one body"},
    {"/bodies/0", "3", "/bodies/0: got 3, expected an object with the keys name, surface"},
    {"/gravity", "[0, 1]", "/gravity: got [0,1], expected three numbers"},
    {"/gravity", "[0, 1, \"2\"]", "/gravity/2: got \"2\", expected a number"},
    {"/dt", "0", "/dt: got 0, expected \"auto\" or a number > 0"},
    {"/dt", "-1e-3", "/dt: got -0.001, expected \"auto\" or a number > 0"},
    {"/dt", "\"fast\"", "/dt: got \"fast\", expected \"auto\" or a number > 0"},
    {"/safety", "1.01", "/safety: got 1.01, expected a number with 0 < safety <= 1"},
    {"/safety", "0", "/safety: got 0, expected a number with 0 < safety <= 1"},
    {"/inverted", R"("ignore")", "/inverted: got \"ignore\", expected one of recover, stop"},
    {"/least_fill", "1.5", "/least_fill: got 1.5, expected a number with 0 <= least_fill <= 1"},
    {"/break_stretch", "1", "/break_stretch: got 1, expected a number > 1, or 0"},
    {"/least_step", "1.5", "/least_step: got 1.5, expected a number with 0 <= least_step <= 1"},
    {"/least_fill", "-1", "/least_fill: got -1, expected a number with 0 <= least_fill <= 1"},
    {"/duration", "0", "/duration: got 0, expected a number > 0"},
    {"/view", R"({"field_of_view": 1e-40})", "/view/field_of_view: got 1e-40, expected a number with 1 <= field_of_view"},
    {"/name", "\"\"", "/name: got \"\", expected"},
    {"/integrator", "\"verlet\"", "/integrator: got \"verlet\", expected one of increment, textbook"},
    {"/relaxation", "1", "/relaxation: got 1, expected true, false or an object"},
    {"/relaxation", "{\"tolerance\": 1}", "/relaxation/tolerance: got 1, expected a number with 0 < tolerance < 1"},
    {"/relaxation", "{\"max_steps\": 0.5}", "/relaxation/max_steps: got 0.5, expected a whole number from 1"},
    {"/bodies/0/name", "\"a/b\"", "/bodies/0/name: got \"a/b\", expected a name of 1 to 100"},
    {"/bodies/0/name", "7", "/bodies/0/name: got 7, expected a name"},
    {"/bodies/0/surface", "", "/bodies/0: got neither \"surface\" nor \"mesh\", expected exactly one"},
    {"/bodies/0/mesh", "\"a.msh\"", "/bodies/0: got both \"surface\" and \"mesh\", expected exactly one"},
    {"/bodies/0/surface", "\"\"", "/bodies/0/surface: got \"\", expected the path of a mesh file"},
    {"/bodies/0/scale", "0", "/bodies/0/scale: got 0, expected a number > 0"},
    {"/bodies/0/scale", "-2", "/bodies/0/scale: got -2, expected a number > 0"},
    {"/bodies/0/scale", "1e-40", "/bodies/0/scale: got 1e-40, expected a number of at least 1e-30"},
    {"/bodies/0/scale", "1e40", "/bodies/0/scale: got 1e+40, expected a number > 0 of magnitude at most 1e30"},
    {"/bodies/0/lattice", "", "/bodies/0: got no \"lattice\", expected a lattice to fill the surface"},
    {"/bodies/0/lattice", "{}", "/bodies/0/lattice: got neither \"spacing\" nor \"nodes\", expected exactly one"},
    {"/bodies/0/lattice/nodes", "9", "/bodies/0/lattice: got both \"spacing\" and \"nodes\", expected exactly one"},
    {"/bodies/0/lattice/spacing", "-0.1", "/bodies/0/lattice/spacing: got -0.1, expected a number > 0"},
    {"/bodies/0/lattice", "{\"nodes\": 7}", "/bodies/0/lattice/nodes: got 7, expected a whole number from 8"},
    {"/bodies/0/lattice", "{\"nodes\": 1e20}", "/bodies/0/lattice/nodes: got 1e+20, expected a whole number from 8"},
    {"/bodies/0/element", "\"hex9\"",
     "/bodies/0/element: got \"hex9\", expected one of tet4, tet4anp, hex8, hex8full (did you mean \"hex8\"?)"},
    {"/bodies/0/element", "8", "/bodies/0/element: got 8, expected one of tet4"},
    {"/bodies/0/model", "{\"type\": \"tlde\"}",
     "/bodies/0/model/type: got \"tlde\", expected one of tled, hybrid, flsm, mass-spring (did you mean \"tled\"?)"},
    {"/bodies/0/model", "{}", "/bodies/0/model: got no \"type\", expected"},
    {"/bodies/0/velocity", "null", "/bodies/0/velocity: got null, expected three numbers"},
};

const std::vector<Case> materials{
    {"/bodies/0/material", "", "/bodies/0: got no \"material\", expected a material"},
    {"/bodies/0/material", "{}",
     "/bodies/0/material: got no elastic constants, expected exactly one of the pairs young + poisson"},
    {"/bodies/0/material/poisson", "",
     "/bodies/0/material: got the elastic constants young, expected exactly one of the pairs"},
    {"/bodies/0/material/mu", "1", "/bodies/0/material: got the elastic constants young, poisson, mu, expected exactly one"},
    {"/bodies/0/material/law", "\"neohookean\"",
     "/bodies/0/material/law: got \"neohookean\", expected one of " + listed(words_only(law_words())) +
         " (did you mean \"neo-hookean\"?)"},
    {"/bodies/0/material/young", "0", "/bodies/0/material/young: got 0, expected a number > 0"},
    {"/bodies/0/material/young", "\"3 kPa\"", "/bodies/0/material/young: got \"3 kPa\", expected a number > 0"},
    {"/bodies/0/material/poisson", "0.5", "/bodies/0/material/poisson: got 0.5, expected a number with -1 < poisson < 0.5"},
    {"/bodies/0/material/poisson", "-1", "/bodies/0/material/poisson: got -1, expected a number with -1 < poisson < 0.5"},
    {"/bodies/0/material", "{\"mu\": 3, \"lambda\": -2}",
     "/bodies/0/material/lambda: got -2, expected a number > -2 mu / 3 = -2"},
    {"/bodies/0/material", "{\"mu\": 3, \"kappa\": 0}", "/bodies/0/material/kappa: got 0, expected a number > 0"},
    {"/bodies/0/material", "{\"young\": 1e30, \"poisson\": 0.49999999}", "/bodies/0/material: got mu = "},
    {"/bodies/0/material/density", "0", "/bodies/0/material/density: got 0, expected a number > 0"},
    {"/bodies/0/material/density", "-1000", "/bodies/0/material/density: got -1000, expected a number > 0"},
    {"/bodies/0/material/damping", "-1", "/bodies/0/material/damping: got -1, expected a number >= 0"},
    {"/bodies/0/material/hourglass", "-1", "/bodies/0/material/hourglass: got -1, expected a number >= 0"},
    {"/bodies/0/inclusions/0/material/young", "-1", "/bodies/0/inclusions/0/material/young: got -1, expected a number > 0"},
};

const std::vector<Case> entries{
    {"/bodies/0/fixed", "{}", "/bodies/0/fixed: got {}, expected a list of objects"},
    {"/bodies/0/fixed/0", "{}",
     "/bodies/0/fixed/0: got no selection, expected exactly one of box, sphere, plane, surface, region, nodes, all"},
    {"/bodies/0/fixed/0/nodes", "[1]", "/bodies/0/fixed/0: got nodes, all, expected exactly one of box"},
    {"/bodies/0/fixed/0/all", "false", "/bodies/0/fixed/0/all: got false, expected true"},
    {"/bodies/0/fixed/0/axes", "\"xw\"", "/bodies/0/fixed/0/axes: got \"xw\", expected one to three different letters"},
    {"/bodies/0/fixed/0/axes", "\"xx\"", "/bodies/0/fixed/0/axes: got \"xx\", expected one to three different letters"},
    {"/bodies/0/fixed/0/axes", "\"\"", "/bodies/0/fixed/0/axes: got \"\", expected one to three different letters"},
    {"/bodies/0/fixed/0", "{\"box\": [[0, 0, 0]]}", "/bodies/0/fixed/0/box: got [[0,0,0]], expected two corners"},
    {"/bodies/0/fixed/0", "{\"box\": [[0, 2, 0], [1, 1, 1]]}",
     "/bodies/0/fixed/0/box: got y from 2 to 1, expected the lower corner"},
    {"/bodies/0/fixed/0", "{\"sphere\": [[0, 0, 0], 0]}", "/bodies/0/fixed/0/sphere/1: got 0, expected a number > 0"},
    {"/bodies/0/fixed/0", "{\"plane\": [[0, 0, 0], [0, 0, 0]]}",
     "/bodies/0/fixed/0/plane/1: got [0,0,0], expected a normal that is not zero"},
    {"/bodies/0/fixed/0", "{\"nodes\": []}", "/bodies/0/fixed/0/nodes: got [], expected a list of at least one node index"},
    {"/bodies/0/fixed/0", "{\"nodes\": [-1]}", "/bodies/0/fixed/0/nodes/0: got -1, expected a whole number from 0"},
    {"/bodies/0/fixed/0", "{\"nodes\": [3, 1, 3]}",
     "/bodies/0/fixed/0/nodes: got node 3 twice, expected every index at most once"},
    {"/bodies/0/inclusions/0/nodes", "[1]", "/bodies/0/inclusions/0: got the unknown key \"nodes\", expected one of box"},
    {"/bodies/0/inclusions/0/material", "", "/bodies/0/inclusions/0: got no \"material\", expected"},
    {"/bodies/0/prescribed/0/displacement", "",
     "/bodies/0/prescribed/0: got neither \"displacement\" nor \"rotate\", expected"},
    {"/bodies/0/prescribed/0/rotate", R"({"axis": [0, 0, 1], "angle": 90})",
     "/bodies/0/prescribed/0: got both \"displacement\" and \"rotate\", expected exactly one of them"},
    {"/bodies/0/prescribed/0/axes", "\"x\"", "/bodies/0/prescribed/0/axes: got \"x\", expected no axes with a displacement"},
    {"/bodies/0/prescribed/0", R"({"all": true, "rotate": {"axis": [0, 0, 0], "angle": 90}})",
     "/bodies/0/prescribed/0/rotate/axis: got [0,0,0], expected a direction that is not zero"},
    {"/bodies/0/prescribed/0", R"({"all": true, "rotate": {"axis": [0, 0, 1]}})",
     "/bodies/0/prescribed/0/rotate: got no \"angle\", expected the angle at factor 1 [degrees]"},
    {"/bodies/0/prescribed/0", R"({"all": true, "rotate": {"axis": [0, 0, 1], "angle": 9}, "axes": "yy"})",
     "/bodies/0/prescribed/0/axes: got \"yy\", expected one to three different letters of xyz"},
    {"/bodies/0/initial", R"([{"all": true}])",
     "/bodies/0/initial/0: got neither \"velocity\" nor \"displacement\", expected one of them, or both"},
    {"/bodies/0/initial", R"([{"velocity": [0, 0, 1]}])", "/bodies/0/initial/0: got no selection, expected exactly one of box"},
    {"/bodies/0/initial", R"([{"all": true, "velocity": {"about": [0, 0, 0]}}])",
     "/bodies/0/initial/0/velocity: got no \"linear\", expected the matrix of the field"},
    {"/bodies/0/initial", R"([{"all": true, "velocity": {"linear": [[0, 0, 1], [0, 0, 0]]}}])",
     "/bodies/0/initial/0/velocity/linear: got [[0,0,1],[0,0,0]], expected three rows of three numbers"},
    {"/bodies/0/initial", R"([{"all": true, "displacement": {"linear": [[-1.5, 0, 0], [0, 0, 0], [0, 0, 0]]}}])",
     "/bodies/0/initial/0/displacement: got a field with det(I + linear) = -0.5, expected one above 0"},
    {"/bodies/0/fixed/0", R"({"surface": ""})", "/bodies/0/fixed/0/surface: got \"\", expected the path of a closed surface"},
    {"/bodies/0/fixed/0", R"({"region": 3})",
     "/bodies/0/fixed/0/region: got 3, expected no region in a body that is a surface filled with a lattice"},
    {"/bodies/0/fixed/0", R"({"all": true, "data": "x"})",
     "/bodies/0/fixed/0/data: got \"x\", expected no \"data\" with \"all\""},
    {"/probes", R"([{"name": "p", "point": [0, 0, 0], "region": 3}])",
     "/probes/0/region: got 3, expected no \"region\" with a"},
    {"/probes", R"([{"point": [0, 0, 0]}])", "/probes/0: got no \"name\", expected a name of 1 to 100"},
    {"/probes", R"([{"name": "a/b", "point": [0, 0, 0]}])", "/probes/0/name: got \"a/b\", expected a name of 1 to 100"},
    {"/probes", R"([{"name": "p"}])", "/probes/0: got no selection, expected exactly one of box"},
    {"/probes", R"([{"name": "p", "point": [0, 0, 0], "all": true}])", "/probes/0/all: got true, expected no \"all\" with a"},
    {"/probes", R"([{"name": "p", "all": true, "body": "b"}])", "/probes/0/body: got \"b\", expected one of a"},
    {"/probes", R"([{"name": "p", "point": [0, 0, 0], "quantities": ["reaction"]}])",
     "/probes/0/quantities/0: got \"reaction\", expected no reaction of a point"},
    {"/probes", R"([{"name": "p", "all": true, "quantities": ["almansi_strain"]}])",
     "/probes/0/quantities/0: got \"almansi_strain\", expected no almansi_strain of a selection"},
    {"/probes", R"([{"name": "p", "all": true, "quantities": ["stress"]}])",
     "/probes/0/quantities/0: got \"stress\", expected no stress of a selection"},
    {"/probes", R"([{"name": "p", "all": true, "quantities": ["velocity", "velocity"]}])",
     "/probes/0/quantities/1: got \"velocity\", expected every quantity at most once"},
    {"/probes", R"([{"name": "p", "all": true, "quantities": ["interpenetration"]}])",
     "/probes/0/quantities/0: got \"interpenetration\", expected no interpenetration of a point or a selection"},
    {"/probes", R"([{"name": "p", "between": ["a"], "quantities": ["force"]}])",
     "/probes/0/quantities/0: got \"force\", expected no force between tools and bodies"},
    {"/probes", R"([{"name": "p", "between": ["a"], "all": true}])",
     "/probes/0/all: got true, expected no \"all\" with \"between\""},
    {"/probes", R"([{"name": "p", "between": ["a"], "point": [0, 0, 0]}])",
     "/probes/0/between: got [\"a\"], expected no \"between\" with a \"point\""},
    {"/probes", R"([{"name": "p", "between": ["knife"]}])", "/probes/0/between/0: got \"knife\", expected one of"},
    {"/probes", R"([{"name": "p", "between": ["a", "a"]}])", "/probes/0/between: got"},
    {"/probes", R"([{"name": "p", "between": []}])", "/probes/0/between: got []"},
    {"/probes", R"([{"name": "p", "all": true}, {"name": "p", "all": true}])",
     "/probes/1: got the name \"p\", which /probes/0 has already, expected a different name for every probe"},
    {"/probe_every", "0.1", "/probe_every: got 0.1, expected \"probes\" with it"},
    {"/gravity", "9.81", "/gravity: got 9.81, expected three numbers [x, y, z], or an object with acceleration and a curve"},
    {"/gravity", R"({"curve": "ramp", "duration": 1})", "/gravity: got no \"acceleration\", expected the acceleration"},
    {"/gravity", R"({"acceleration": [0, 0, 1], "curve": "ramp"})", "/gravity: got no \"duration\", expected the duration"},
    {"/bodies/0/prescribed/0/displacement", "[null, null, null]",
     "/bodies/0/prescribed/0/displacement: got [null,null,null], expected at least one component"},
    {"/bodies/0/prescribed/0/displacement", "[0, true, 0]",
     "/bodies/0/prescribed/0/displacement/1: got true, expected a number or null"},
    {"/bodies/0/prescribed/0/duration", "", "/bodies/0/prescribed/0: got no \"duration\", expected the duration of the curve"},
    {"/bodies/0/prescribed/0/duration", "0", "/bodies/0/prescribed/0/duration: got 0, expected a number > 0"},
    {"/bodies/0/prescribed/0/table", "[[0, 0]]", "/bodies/0/prescribed/0/curve: got \"smooth\", expected table"},
    {"/bodies/0/prescribed/0/curve", "\"smoth\"",
     "/bodies/0/prescribed/0/curve: got \"smoth\", expected one of constant, ramp, smooth, table (did you mean \"smooth\"?)"},
    {"/bodies/0/forces/0/force", "5", "/bodies/0/forces/0/force: got 5, expected three numbers"},
    {"/bodies/0/forces/0/force", "", "/bodies/0/forces/0: got no \"force\", expected the total force at factor 1 [N]"},
    {"/bodies/0/forces/0/duration", "5", "/bodies/0/forces/0/duration: got 5, expected no duration with a constant curve"},
    {"/bodies/0/forces/0/curve", "\"table\"", "/bodies/0/forces/0: got no \"table\", expected"},
    {"/bodies/0/forces/0/table", "[[0, 0], [1, 1], [1, 2]]",
     "/bodies/0/forces/0/table/2/0: got 1, expected a time after the previous row's 1"},
    {"/bodies/0/forces/0/table", "[]", "/bodies/0/forces/0/table: got [], expected a list of rows"},
    {"/bodies/0/pressures/0/pressure", "\"high\"", "/bodies/0/pressures/0/pressure: got \"high\", expected a number"},
};

TEST(Mistakes, InValuesAreNamed) { expect_named(values); }
TEST(Mistakes, InMaterialsAreNamed) { expect_named(materials); }
TEST(Mistakes, InEntriesAreNamed) { expect_named(entries); }

TEST(Mistakes, TheUnpatchedSceneLoads) { EXPECT_EQ(message(kGoodScene), ""); }

TEST(Mistakes, UnknownKeysSuggestTheNearest) {
  EXPECT_NE(patched("/bodies/0/materail", "1").find("/bodies/0: got the unknown key \"materail\", expected one of"),
            std::string::npos);
  EXPECT_NE(patched("/bodies/0/materail", "1").find("(did you mean \"material\"?)"), std::string::npos);
  EXPECT_NE(patched("/Gravity", "1").find("(did you mean \"gravity\"?)"), std::string::npos);
  EXPECT_NE(patched("/bodies/0/material/desnity", "1").find("(did you mean \"density\"?)"), std::string::npos);
  EXPECT_EQ(patched("/xylophone", "1").find("did you mean"), std::string::npos);
  EXPECT_EQ(nearest("xyzzy", {"name", "mesh"}), "");
}

TEST(Mistakes, AveragedPressureNeedsAVolumetricLaw) {
  Json scene = Json::parse(kGoodScene);
  scene["bodies"][0]["element"] = "tet4anp";
  EXPECT_EQ(message(scene.dump()), "");
  scene["bodies"][0]["inclusions"][0]["material"]["law"] = "saint-venant-kirchhoff";
  EXPECT_NE(message(scene.dump())
                .find("/bodies/0/inclusions/0/material: got the law saint-venant-kirchhoff with the element tet4anp, "
                      "expected " +
                      laws_with(&LawInfo::volumetric) +
                      ": the averaged nodal pressure needs a law whose "
                      "volumetric part depends on J alone"),
            std::string::npos);
  scene["bodies"][0]["element"] = "tet4";
  EXPECT_EQ(message(scene.dump()), "");
}

TEST(Mistakes, ALatticeBesideAMesh) {
  Json scene = Json::parse(kGoodScene);
  scene["bodies"][0].erase("surface");
  scene["bodies"][0]["mesh"] = "a.msh";
  EXPECT_NE(message(scene.dump()).find("/bodies/0/lattice: got an object with 1 key, expected no lattice with a volume mesh"),
            std::string::npos);
}

TEST(Mistakes, RegionsOfAMesh) {
  Json scene = Json::parse(kGoodScene);
  scene["bodies"][0].erase("surface");
  scene["bodies"][0].erase("lattice");
  scene["bodies"][0]["mesh"] = "a.msh";
  scene["bodies"][0]["element"] = "tet4";
  scene["bodies"][0].erase("model");
  const auto with = [&](const char* selection) {
    scene["bodies"][0]["fixed"] = Json::array({Json::parse(selection)});
    return message(scene.dump());
  };
  EXPECT_EQ(with(R"({"region": 3, "data": "part", "dimension": 2})"), "");
  EXPECT_EQ(with(R"({"region": "tumour"})"), "");
  const std::vector<std::array<const char*, 2>> wrong{
      {R"({"region": 1.5})", "/region: got 1.5, expected a tag of the mesh file"},
      {R"({"region": true})", "/region: got true, expected a tag of the mesh file"},
      {R"({"region": ""})", "/region: got \"\", expected the name of a physical"},
      {R"({"region": 3, "dimension": 1})", "/dimension: got 1, expected a whole number from 2"},
      {R"({"region": 3, "data": 4})", "/data: got 4, expected the name of an array"},
      {R"({"region": 1e300})", "/region: got 1e+300, expected a tag of the mesh file"}};
  for (const auto& [selection, text] : wrong)
    EXPECT_NE(with(selection).find(std::string("dir/s.json: /bodies/0/fixed/0") + text), std::string::npos) << with(selection);
}

TEST(Mistakes, FieldsOfAMesh) {
  EXPECT_NE(
      patched("/bodies/0/material/young", R"({"field": "E"})").find("expected a number: only the elements of a volume mesh"),
      std::string::npos);
  Json scene = Json::parse(kGoodScene);
  Json& body = scene["bodies"][0];
  body.erase("surface"), body.erase("lattice"), body.erase("model");
  body["mesh"] = test::source_dir() + "/scenes/meshes/nodule_tet.vtu";
  body["element"] = "tet4";
  const auto with = [&](const char* young) {
    body["material"] = {{"young", Json::parse(young)}, {"poisson", 0.4}};
    return message(scene.dump());
  };
  EXPECT_EQ(with(R"({"field": "E"})"), "");
  const std::vector<std::array<const char*, 2>> wrong{
      {R"({"field": "F"})", "/young/field: got \"F\": "},
      {R"({"field": "F"})", "has \"E\", expected an array with one number per element"},
      {R"({"field": 3})", "/young/field: got 3, expected the name of an array of the mesh"},
      {R"({"feild": "E"})", "did you mean \"field\"?"},
      {R"({})", "/young: got no \"field\", expected the name of an array of the mesh"}};
  for (const auto& [young, text] : wrong) EXPECT_NE(with(young).find(text), std::string::npos) << with(young);
  body["material"] = {{"law", "yeoh"}, {"young", {{"field", "E"}}}, {"poisson", 0.4}};
  EXPECT_NE(message(scene.dump()).find("expected no \"young\" with the law yeoh"), std::string::npos);
}

TEST(Mistakes, TwoBodiesOfOneName) {
  Json scene = Json::parse(kGoodScene);
  scene["bodies"].push_back(scene["bodies"][0]);
  EXPECT_EQ(message(scene.dump()),
            "dir/s.json: /bodies/1: got the name \"a\", which /bodies/0 has already, expected a different name for every body");
}

TEST(Mistakes, SyntaxErrorsHaveLineAndColumn) {
  EXPECT_EQ(message("{\n  \"format\": nul\n}").substr(0, 45), "dir/s.json: line 2, column 16: not valid JSON");
  EXPECT_EQ(message("{\"a\" 1}").substr(0, 44), "dir/s.json: line 1, column 6: not valid JSON");
  EXPECT_NE(message("").find("line 1, column 1: not valid JSON"), std::string::npos);
  EXPECT_NE(message("{} x").find("not valid JSON"), std::string::npos);
  EXPECT_NE(message("{\"a\": NaN}").find("not valid JSON"), std::string::npos);
  EXPECT_NE(message(std::string("{}\0{}", 5)).find("NUL byte at offset 2"), std::string::npos);
}

TEST(Mistakes, NumbersBeyondDouble) {
  EXPECT_EQ(message("{\n\"dt\": 1e999}"),
            "dir/s.json: line 2, column 11: got '1e999', expected a number that a double can hold");
  EXPECT_NE(message("{\"dt\": -1e999}").find("got '-1e999'"), std::string::npos);
}

TEST(Mistakes, DuplicateKeys) {
  EXPECT_EQ(message(R"({"bodies": [{"name": "a"}, {"x": {"mu": 1, "mu": 2}}]})"),
            "dir/s.json: /bodies/1/x/mu: got the key a second time, expected every key at most once");
}

TEST(Mistakes, DepthAndSizeAreLimited) {
  const std::string deep = message(std::string(100000, '['));
  EXPECT_NE(deep.find("nested deeper than 64"), std::string::npos) << deep;
  EXPECT_LT(deep.size(), 300U);
  EXPECT_NE(message(std::string((16 << 20) + 1, ' ')).find("more than 16 MiB"), std::string::npos);
}

TEST(Mistakes, MessagesStayShort) {
  EXPECT_LT(patched("/dt", "\"" + std::string(5000, '1') + "\"").size(), 300U);
  EXPECT_LT(patched("/" + std::string(5000, 'k'), "1").size(), 400U);
  EXPECT_LT(message("{\"" + std::string(5000, 'k') + "\": x}").size(), 400U);
}

}  // namespace
}  // namespace pliant
