// Whole runs of shape matching and hybrids: the ends of `ratio`, both backends, what is refused, and resumed runs.
#include <gtest/gtest.h>

#include <cstring>

#include "io/save.h"
#include "physics/flsm_harness.h"
#include "pliant/error.h"
#include "simulation/state/compare.h"
#include "solver/scenes.h"
#include "support/error_of.h"
#include "support/source_dir.h"
#include "support/temp_folder.h"

namespace pliant::physics {
namespace {

/// A bar that is held at one end, falls, and is pulled at the other, where the loads meet both models.
Body busy_bar(ModelType type, ElementKind element = ElementKind::hex8) {
  const Box box{{7, 4, 3}, 0.01};
  Body body = matched_box(box, type, 0.035, element);
  body.material.damping = 2;
  Selection near = face(2, 0), far = near;
  near.b[0] = 0.069;  // where the pull moves nodes they are held across it
  far.a[0] = 0.069;
  body.fixed = {{near, {true, true, true}}, {far, {false, true, true}}};
  body.prescribed = {pull(0, 0.07, 0.004, smooth(0.05))};
  body.forces.push_back({face(1, 0.04), {0, 0.02, 0.01}, smooth(0.03)});
  body.angular_velocity = {1, 2, -1};
  return body;
}

Scene scene_of(std::vector<Body> bodies, double dt = 0) {
  Scene scene;
  scene.gravity = {0.5, -9.81, 1};
  scene.dt = dt;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    bodies[i].name += std::to_string(i);
    bodies[i].model.pointer = "/bodies/" + std::to_string(i) + "/model";
  }
  scene.bodies = std::move(bodies);
  return scene;
}

std::vector<Vec3d> motion(const Scene& scene, const char* backend, std::int64_t steps) {
  Simulation sim(scene, open_backend(backend));
  EXPECT_EQ(sim.advance(steps), steps);
  std::vector<Vec3d> out = sim.displacements(0);
  const std::vector<Vec3d> v = sim.velocities(0);
  out.insert(out.end(), v.begin(), v.end());
  return out;
}

TEST(FlsmRun, RatioOneIsTledAndRatioZeroIsFlsm) {
  for (const char* backend : {"cpu", "opencl:0"}) {
    if (std::string(backend) == "opencl:0" && !testing::has_opencl()) continue;
    for (const double ratio : {1.0, 0.0}) {
      Body hybrid = busy_bar(ModelType::hybrid);
      hybrid.model.region.reset();
      hybrid.model.ratio = ratio;
      const Body pure = busy_bar(ratio == 1 ? ModelType::tled : ModelType::flsm);
      const auto a = motion(scene_of({hybrid}, 5e-4), backend, 200), b = motion(scene_of({pure}, 5e-4), backend, 200);
      ASSERT_EQ(a.size(), b.size());
      EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]), 0) << backend << ", ratio " << ratio;
      EXPECT_GT(largest(a), 1e-3);
    }
  }
}

void expect_identical(const std::string& what, const Scene& scene) {
  Simulation a(scene, open_backend("opencl:0"));
  Simulation b(scene, a.shared_model(), open_backend("cpu"));
  std::int64_t values = 0;
  // After every pass for a while, then after whole steps.
  for (const int steps : {20, 180}) {
    CompareOptions options;
    options.steps = steps;
    options.every_pass = steps == 20;
    const ComparisonResult result = compare(a, b, options);
    EXPECT_TRUE(result.identical) << what << ": " << (result.first_difference ? result.first_difference->message() : "");
    EXPECT_EQ(result.steps, steps) << what;
    values += result.values_compared;
  }
  EXPECT_GT(largest(a.displacements(0)), 1e-3) << what;
  std::printf("  %-58s %lld values\n", what.c_str(), static_cast<long long>(values));
}

class FlsmCompare : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!testing::has_opencl()) GTEST_SKIP() << "there is no OpenCL device";
  }
};

TEST_F(FlsmCompare, PureOfEveryWidth) {
  for (int width = 1; width <= 5; ++width) {
    Body body = busy_bar(ModelType::flsm);
    body.model.width = width;
    expect_identical("flsm, w = " + std::to_string(width), scene_of({body}, 1e-3));
  }
}

TEST_F(FlsmCompare, HybridOfEveryElement) {
  for (const ElementKind element : {ElementKind::hex8, ElementKind::hex8full, ElementKind::tet4, ElementKind::tet4anp}) {
    expect_identical(std::string("hybrid, ") + to_string(element), scene_of({busy_bar(ModelType::hybrid, element)}));
  }
}

TEST_F(FlsmCompare, Substeps) {
  for (const int substeps : {3, 4}) {
    for (const bool extrapolate : {false, true}) {
      Body body = busy_bar(ModelType::hybrid);
      body.model.substeps = substeps;
      body.model.extrapolate = extrapolate;
      expect_identical("substeps " + std::to_string(substeps) + (extrapolate ? ", extrapolated" : ", held"), scene_of({body}));
    }
  }
}

TEST_F(FlsmCompare, FourBodiesAndAGivenBeta) {
  Body second = busy_bar(ModelType::hybrid, ElementKind::tet4);
  second.model.substeps = 4;
  second.model.alpha = 0.8;
  second.model.beta = 3;
  expect_identical("two hybrids, tled, flsm",
                   scene_of({busy_bar(ModelType::hybrid), second, busy_bar(ModelType::tled), busy_bar(ModelType::flsm)}));
}

/// Steps of TLED per step of FLSM are counted from the start of the run, whatever the batches: a run in pieces is the same.
/// The far end, of shape matching, is moved at 80 mm/s in every substep.
TEST(FlsmRun, VelocitiesOfPrescribedNodes) {
  Body body = busy_bar(ModelType::hybrid);
  body.prescribed = {pull(0, 0.07, 0.004, {Curve::Kind::ramp, 0, 0.05, {}})};
  body.model.substeps = 4;
  Simulation sim(scene_of({body}, 5e-4), open_backend("cpu"));
  sim.advance(40);
  const std::vector<Vec3d> v = sim.velocities(0);
  int pulled = 0;
  for (std::size_t n = 0; n < v.size(); ++n) {
    if (sim.model().bodies[0].rest[n][0] < 0.0699) continue;
    EXPECT_NEAR(v[n][0], 0.08, 1e-5);
    ++pulled;
  }
  EXPECT_EQ(pulled, 20);
}

TEST(FlsmRun, PiecesOfARunGiveTheSameBits) {
  Body body = busy_bar(ModelType::hybrid);
  body.model.substeps = 3;
  body.model.extrapolate = true;
  const Scene scene = scene_of({body}, 5e-4);
  Simulation whole(scene, open_backend("cpu")), pieces(scene, open_backend("cpu"));
  whole.advance(200);
  for (const int n : {1, 1, 5, 63, 64, 65, 1}) pieces.advance(n);
  ASSERT_EQ(pieces.step(), whole.step());
  EXPECT_EQ(pieces.hash(), whole.hash());
}

class FlsmResume : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (std::string(GetParam()) == "opencl:0" && !testing::has_opencl()) GTEST_SKIP() << "there is no OpenCL device";
  }
  void expect_same_bits(const Scene& scene, std::int64_t first, std::int64_t second) {
    Simulation whole(scene, open_backend(GetParam()));
    ASSERT_EQ(whole.advance(first + second), first + second);
    const auto file = folder_.path() / "state.pckpt";
    {
      Simulation part(scene, open_backend(GetParam()));
      ASSERT_EQ(part.advance(first), first);
      write_checkpoint(file, take_checkpoint(part));
    }
    Simulation resumed(scene, open_backend(GetParam()));
    restore_checkpoint(resumed, read_checkpoint(file), file);
    ASSERT_EQ(resumed.advance(second), second);
    EXPECT_EQ(resumed.hash(), whole.hash()) << "resumed at " << first;
    EXPECT_EQ(resumed.dt(), whole.dt());
    EXPECT_EQ(resumed.time(), whole.time());
    EXPECT_EQ(write_state(resumed.state()), write_state(whole.state()));
    EXPECT_EQ(resumed.deep_hash(), whole.deep_hash());
  }
  test::TempFolder folder_;
};

TEST_P(FlsmResume, SubstepsExtrapolated) {
  Body body = busy_bar(ModelType::hybrid);
  body.model.substeps = 3;
  body.model.extrapolate = true;
  // A simulation on OpenCL builds its kernels anew.
  const bool quick = std::string(GetParam()) == "cpu";
  for (const std::int64_t at : quick ? std::vector<std::int64_t>{36, 37, 38, 64} : std::vector<std::int64_t>{38})
    expect_same_bits(scene_of({body}, 5e-4), at, 63);
}

Scene stretched_cube(double press, double young, double duration) {
  Scene scene = testing::pressed_cube(press, "", young, "neo-hookean", duration);
  DeformationModel& m = scene.bodies[0].model;
  m.type = ModelType::hybrid;
  m.ratio = 0.6;
  m.seed = Vec3d{0, 0.05, 0};
  m.substeps = 3;
  m.extrapolate = true;
  return scene;
}

TEST_P(FlsmResume, AutomaticStep) {
  if (std::string(GetParam()) != "cpu") GTEST_SKIP() << "the host's part is the same on every backend";
  const Scene scene = stretched_cube(-0.03, 30000, 0.5);
  Simulation probe(scene, open_backend(GetParam()));
  const double first = probe.dt();
  probe.advance(520);
  ASSERT_FALSE(probe.divergence()) << probe.divergence()->message();
  ASSERT_LT(probe.dt(), first) << "the scene must be stretched far enough for the step to change";
  for (const std::int64_t at : {255, 257, 512}) expect_same_bits(scene, at, 520 - at);
}

TEST_P(FlsmResume, AutomaticStepThatWasTriedAgain) {
  if (std::string(GetParam()) != "cpu") GTEST_SKIP() << "the host's part is the same on every backend";
  Scene scene = stretched_cube(0.06, 3000, 0.1);
  scene.inverted = Inverted::stop;
  Simulation probe(scene, open_backend(GetParam()));
  probe.advance(300);
  ASSERT_FALSE(probe.divergence()) << probe.divergence()->message();
  ASSERT_GT(probe.state().limit.hold, 0) << "the scene must be fast enough to overtake its step";
  for (const std::int64_t at : {17, 64, 131}) expect_same_bits(scene, at, 300 - at);
}

std::string label(const ::testing::TestParamInfo<const char*>& backend) {
  return std::string(backend.param) == "cpu" ? "cpu" : "opencl";
}
INSTANTIATE_TEST_SUITE_P(On, FlsmResume, ::testing::Values("cpu", "opencl:0"), label);

/// A box of 0.1 x 0.1 x 0.1 m in 5 x 5 x 5 cells with this text as its model.
std::string scene_text(const std::string& model, const std::string& extra = "") {
  return R"({"format": "pliant-scene/1", )" + extra + R"("bodies": [{"name": "cube", "surface": "meshes/cube.obj",
    "lattice": {"spacing": 0.02}, "material": {"young": 3000, "poisson": 0.4}, "model": )" +
         model + "}]}";
}

/// What `pliant run` says of shape matching before the first step.
TEST(FlsmRun, RemarksOnStiffnessAndWeight) {
  const auto remarks = [](const std::string& model, const std::string& extra) {
    const Scene scene = parse_scene(scene_text(model, extra), test::source_dir() + "/scenes/hybrid.json");
    return Simulation(scene, open_backend("cpu")).remarks();
  };
  const std::string hybrid = R"({"type": "hybrid"})", weight = R"("gravity": [0, -9.81, 0], )";
  EXPECT_TRUE(remarks(hybrid, "").empty()) << "its stiffness is the material's, and nothing weighs on it";
  EXPECT_TRUE(remarks(R"({"type": "hybrid", "stiffness": {"young": 90000}})", weight).size() == 1)
      << "too stiff, but strong enough";
  const std::vector<std::string> heavy = remarks(hybrid, weight);
  ASSERT_EQ(heavy.size(), 1U);
  EXPECT_NE(heavy[0].find("its weight strains its shape matching"), std::string::npos) << heavy[0];
  const std::vector<std::string> soft = remarks(R"({"type": "hybrid", "stiffness": {"young": 300}})", "");
  ASSERT_EQ(soft.size(), 1U);
  EXPECT_NE(soft[0].find("0.1 times that of its material"), std::string::npos) << soft[0];
}

TEST(FlsmRun, WhatIsRefused) {
  struct Case {
    const char* model;
    const char* extra;
    std::vector<const char*> words;  // the pointer, the value, what is allowed
  };
  const Case cases[]{
      {R"({"type": "hybrid", "ratio": 1.5})", "", {"/bodies/0/model/ratio", "1.5", "0 <= ratio <= 1"}},
      {R"({"type": "hybrid", "ratio": -0.1})", "", {"/bodies/0/model/ratio", "-0.1", "0 <= ratio <= 1"}},
      {R"({"type": "flsm", "width": 0})", "", {"/bodies/0/model/width", "got 0", "1 to 5"}},
      {R"({"type": "flsm", "width": 6})", "", {"/bodies/0/model/width", "got 6", "1 to 5"}},
      {R"({"type": "hybrid", "region": {"box": [[-1, -1, -1], [0.019, 1, 1]]}, "width": 3})",
       R"("dt": 0.001, )",
       {}},  // five cells remain along y and z
      {R"({"type": "hybrid", "region": {"sphere": [[1, 2, 3], 0.1]}})",
       "",
       {"/bodies/0/model/region", "(1, 2, 3)", "0.1", "-0.05"}},
      {R"({"type": "hybrid", "region": {"box": [[0.2, 0, 0], [0.3, 1, 1]]}})",
       "",
       {"/bodies/0/model/region", "0.2", "0.3", "0.05"}},
      {R"({"type": "hybrid", "seed": [5, 0, 0]})", "", {"/bodies/0/model/seed", "5", "allowed"}},
      {R"({"type": "flsm", "alpha": 0})", "", {"/bodies/0/model/alpha", "got 0", "1"}},
      {R"({"type": "flsm", "alpha": 1.01})", "", {"/bodies/0/model/alpha", "1.01", "1"}},
      {R"({"type": "hybrid", "substeps": 0})", "", {"/bodies/0/model/substeps", "got 0", "1 to 64"}},
      {R"({"type": "hybrid", "beta": -1})", "", {"/bodies/0/model/beta", "-1", "> 0"}},
      {R"({"type": "hybrid", "beta": 1e6})", R"("dt": 0.002, )", {"/bodies/0/model/beta", "1000000", "N/m", "at most", "dt"}},
      {R"({"type": "hybrid", "beta": 1})", R"("dt": 0.2, )", {"/bodies/0/model/beta", "got 1", "none", "dt up to"}},
  };
  const std::string file = test::source_dir() + "/scenes/refused.json";
  for (const Case& c : cases) {
    const std::string message = test::error_of([&] {
      const Scene scene = parse_scene(scene_text(c.model, c.extra), file);
      Simulation sim(scene, open_backend("cpu"));
    });
    EXPECT_EQ(message.empty(), c.words.empty()) << c.model << ": " << message;
    for (const char* word : c.words) EXPECT_NE(message.find(word), std::string::npos) << c.model << ": " << message;
    if (!message.empty()) std::printf("  %s\n", message.c_str());
  }
}

TEST(FlsmRun, AWidthMustFitTheBody) {
  Body body = matched_box({{3, 2, 2}, 0.02}, ModelType::flsm);
  body.model.width = 4;
  const std::string message = test::error_of([&] { Simulation sim(scene_of({body}, 1e-3), open_backend("cpu")); });
  for (const char* word : {"/bodies/0/model/width", "got 4", "1 to 3"}) {
    EXPECT_NE(message.find(word), std::string::npos) << message;
  }
  body.model.width = 3;
  Simulation fits(scene_of({body}, 1e-3), open_backend("cpu"));
}

/// The largest beta that a message names is accepted and stays stable; a hundredth more is refused.
TEST(FlsmRun, TheAdmissibleBetaIsStable) {
  Body body = matched_box({{8, 3, 3}, 0.02}, ModelType::hybrid, 0.08);
  body.angular_velocity = {1, 2, 3};
  body.model.beta = 1e6;
  Scene refused = scene_of({body}, 3e-3);
  refused.gravity = {};
  const std::string message = test::error_of([&] { Simulation sim(refused, open_backend("cpu")); });
  const std::string before = "allowed is at most ";
  ASSERT_NE(message.find(before), std::string::npos) << message;
  const double most = std::stod(message.substr(message.find(before) + before.size()));
  Scene scene = refused;
  scene.bodies[0].model.beta = 1.01 * most;
  EXPECT_NE(test::error_of([&] { Simulation sim(scene, open_backend("cpu")); }), "");
  scene.bodies[0].model.beta = 0.999 * most;
  Simulation sim(scene, open_backend("cpu"));
  const double start = largest(sim.velocities(0));
  EXPECT_EQ(sim.advance(5000), 5000);
  EXPECT_LT(largest(sim.velocities(0)), 3 * start) << "beta = " << scene.bodies[0].model.beta;
}

/// Bodies of shape matching alone, and what pulls at their nodes: a membrane, springs to another body, slack ones at that.
/// The step that both allow is stable, and not the least.
TEST(FlsmRun, WhatIsLinkedHasAStableStep) {
  const std::string head = R"({"format": "pliant-scene/1", "gravity": [0, 0, 0], "bodies": [)", tail = "]";
  const auto cube = [](const char* more) {
    return std::string(R"({"name": "cube)") + (*more == 't' ? "2" : "") + R"(", "surface": "meshes/cube.obj", "element": "hex8",
      "lattice": {"spacing": 0.02}, "material": {"young": 3000, "poisson": 0.3, "density": 1000}, "model": {"type": "flsm", "alpha": 1},
      "angular_velocity": [1, 2, 3])" +
           (*more == 't' ? R"(, "translate": [0, 0.15, 0]})" : std::string(more) + "}");
  };
  const std::string skin = R"(, "membrane": {"thickness": 1e-3, "young": 3e5, "poisson": 0.3})";
  const auto joined = [](const char* slack) {
    return std::string(R"(], "joins": [{"bodies": ["cube", "cube2"], "distance": 0.06, "spring": {"stiffness": 20)") + slack +
           "}}]}";
  };
  const std::string both = cube("") + "," + cube("t");
  for (const std::string& text :
       {head + cube(skin.c_str()) + tail + "}", head + both + joined(""), head + both + joined(R"(, "slack": true)")}) {
    Simulation sim(parse_scene(text, test::source_dir() + "/scenes/linked.json"), open_backend("cpu"));
    const double start = largest(sim.velocities(0));
    EXPECT_LE(sim.dt(), 1.0 / 60) << text;
    EXPECT_GT(sim.dt(), 1e-3) << text;
    EXPECT_EQ(sim.advance(3000), 3000) << text;
    EXPECT_LT(largest(sim.velocities(0)), 3 * start) << text;
  }
  // At a given step dt the membrane adds dt^2 w^2 to alpha on the same nodes.
  std::string loose = head + cube(skin.c_str()) + tail + "}";
  const auto step = [](const std::string& text) {
    return Simulation(parse_scene(text, test::source_dir() + "/scenes/linked.json"), open_backend("cpu")).dt();
  };
  const double pulled = step(loose);
  loose.replace(loose.find(R"("alpha": 1)"), 10, R"("alpha": 0.01)");
  EXPECT_LT(pulled, 0.95 * step(loose));
  EXPECT_GT(pulled, 0.8 * step(loose));
}

/// In this lattice one grid point holds two nodes, and all links to its neighbours belong to the other one.
TEST(FlsmRun, NoNodeFallsOutWhereTheLatticeBranches) {
  const Scene scene =
      parse_scene(R"({"format": "pliant-scene/1", "dt": 0.002, "gravity": [0, -9.81, 0], "bodies": [{"name": "kidney",
      "surface": "meshes/kidney.obj", "lattice": {"nodes": 3000}, "element": "hex8",
      "material": {"young": 3000, "poisson": 0.3, "density": 1000}, "model": {"type": "flsm", "alpha": 1, "width": 2},
      "fixed": [{"plane": [[0, 0, 0], [0, -1, 0]]}]}]})",
                  test::source_dir() + "/scenes/kidney_flsm.json");
  Simulation s(scene, open_backend("cpu"));
  const FlsmBatch& batch = s.model().flsm[0];
  const auto lone = std::count(batch.link.begin(), batch.link.begin() + static_cast<std::ptrdiff_t>(batch.slot.size()),
                               std::array<std::int32_t, 6>{-1, -1, -1, -1, -1, -1});
  EXPECT_GT(lone, 0);
  EXPECT_EQ(batch.branches.size(), static_cast<std::size_t>(lone));
  EXPECT_EQ(*std::min_element(batch.regions.size.begin(), batch.regions.size.end()) > 1, true);
  while (s.time() < 0.3) s.advance(1);
  EXPECT_LT(largest(s.displacements(0)), 0.1) << "free fall is 0.44 m";
}

}  // namespace
}  // namespace pliant::physics
