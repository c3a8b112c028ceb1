// A run whose tools came, went and were parked on the way goes on from a checkpoint with the bits of one that was not
// interrupted.
#include <gtest/gtest.h>

#include "io/save.h"
#include "model/contact/contact.h"
#include "pliant/error.h"
#include "scene/tool_entry.h"
#include "solver/scenes.h"
#include "support/error_of.h"
#include "support/temp_folder.h"

namespace pliant::resume_tools_test {
namespace {

struct Case {
  const char* backend;
  const char* element;
  const char* model;
  const char* top;  ///< further keys of the scene
};

constexpr const char* kContact = R"("contact": {"friction": 0.3},)";
constexpr const char* kContactAndTool =
    R"("contact": {"friction": 0.3}, "tools": [{"name": "own", "shape": {"sphere": 0.02}, "friction": 0.4, "path": [[0, 0.07, 0, 0], [0.02, 0.064, 0, 0.01]]}],)";

/// Two cubes of 0.1 m in cells of 0.02 m, one on the other.
Scene stack(const Case& c) {
  const auto body = [&](const char* name, double height, const char* held) {
    return std::string(R"({"name": ")") + name + R"(", "surface": "meshes/cube.obj", "translate": [0, )" +
           std::to_string(height) + R"(, 0], "lattice": {"spacing": 0.02}, "element": ")" + c.element + R"(", "model": )" +
           c.model + held + R"(, "material": {"young": 5000, "poisson": 0.4, "damping": 5}})";
  };
  return parse_scene(std::string(R"({"format": "pliant-scene/1", "dt": 5e-4, )") + c.top + R"("bodies": [)" +
                         body("lower", 0, R"(, "fixed": [{"plane": [[0, -0.049, 0], [0, -1, 0]]}])") + "," +
                         body("upper", 0.1, R"(, "fixed": [{"box": [[-0.021, 0.079, -0.021], [0.021, 0.121, 0.021]]}])") + "]}",
                     test::source_dir() + "/scenes/stack.json");
}

ContactTool ball(const std::string& name, const Vec3d& at) {
  ContactTool tool;
  tool.name = name;
  tool.radius = 0.02;
  tool.friction = 0.4;
  tool.path = {{0, at[0], at[1], at[2], 0, 0, 0, 1}};
  return tool;
}

/// What the host does before a step.
void at_step(Simulation& s) {
  ToolEdits& tools = s.tools();
  const auto add = [&](const ContactTool& tool) { tools.add(tool, tool_form(tool)); };
  switch (s.step()) {
    case 37:
      add(ball("top", {0.01, 0.171, 0}));
      return tools.drive("top", {{0.015, 0.163, 0}}, 0.015);
    case 70:
      add(ball("side", {-0.071, 0.1, 0}));
      return tools.drive("side", {{-0.064, 0.1, 0.01}}, 0.015);
    case 101:
      if (!s.scene().tools.empty()) tools.remove("own");
      return tools.park("top");
    case 133:
      return tools.park("side");
    case 150:
      return tools.place("top", {{0, 0.172, 0.01}});
    case 171:
      tools.remove("side");
      add(ball("own", {0.071, 0.1, 0}));
      return tools.drive("own", {{0.065, 0.1, 0.004}}, 0.02);
    default:
      return;
  }
}

constexpr std::int64_t kEvents[] = {37, 70, 101, 133, 150, 171, 220};

/// Goes on to step `end`; what is done before that is part of it.
void run_to(Simulation& s, std::int64_t end) {
  for (const std::int64_t event : kEvents) {
    if (event <= s.step()) continue;
    s.advance(std::min(event, end) - s.step());
    if (s.step() == event) at_step(s);
    if (s.step() == end) return;
  }
}

class ResumeTools : public ::testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    if (std::string(GetParam().backend) == "opencl:0" && !testing::has_opencl()) GTEST_SKIP() << "there is no OpenCL device";
  }
};

TEST_P(ResumeTools, HasTheBitsOfAnUninterruptedRun) {
  const Scene scene = stack(GetParam());
  const test::TempFolder folder;
  const auto file = folder.path() / "state.pckpt";
  Simulation whole(scene, open_backend(GetParam().backend));
  run_to(whole, 220);
  ASSERT_EQ(whole.contact().tools().back().name, "own");
  EXPECT_GT(whole.report().tools.back().touched, 0) << "it touches nothing";
  for (const std::int64_t at : {37, 41, 75, 101, 140, 150, 171, 199}) {
    SCOPED_TRACE(at);
    Simulation part(scene, open_backend(GetParam().backend));
    run_to(part, at);
    write_checkpoint(file, take_checkpoint(part));
    Simulation resumed(scene, open_backend(GetParam().backend));
    restore_checkpoint(resumed, read_checkpoint(file), file);
    EXPECT_EQ(resumed.deep_hash(), part.deep_hash());
    run_to(resumed, 220);
    EXPECT_EQ(resumed.hash(), whole.hash());
    EXPECT_EQ(resumed.deep_hash(), whole.deep_hash());
  }
}

INSTANTIATE_TEST_SUITE_P(On, ResumeTools,
                         ::testing::Values(Case{"cpu", "hex8", R"({"type": "tled"})", kContactAndTool},
                                           Case{"cpu:double", "tet4", R"({"type": "tled"})", kContact},
                                           Case{"cpu", "hex8", R"({"type": "flsm"})", ""},
                                           Case{"cpu", "hex8full", R"({"type": "tled"})", ""},
                                           Case{"cpu", "hex8", R"({"type": "hybrid", "ratio": 0.5})", kContactAndTool},
                                           Case{"opencl:0", "hex8", R"({"type": "tled"})", kContactAndTool},
                                           Case{"opencl:0", "tet4anp", R"({"type": "tled"})", ""}));

TEST(ToolsOfAState, ThatCannotBeAreRefused) {
  const Scene scene = stack({"cpu", "hex8", R"({"type": "tled"})", kContactAndTool});
  Simulation source(scene, open_backend("cpu")), target(scene, open_backend("cpu"));
  run_to(source, 140);
  target.advance(3);
  const auto refusal = [&](auto&& damage) {
    Snapshot snapshot = source.snapshot();
    damage(snapshot.state.tools);
    const std::uint64_t before = target.deep_hash();
    const std::string message = test::error_of([&] { target.restore(snapshot); });
    EXPECT_EQ(target.deep_hash(), before) << message;
    return message;
  };
  const auto has = [](const std::string& message, const char* part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  has(refusal([](ToolChanges& t) { t.added[0].radius = -1; }), "/shape/sphere: got -1");
  has(refusal([](ToolChanges& t) { t.added[0].friction = NAN; }), "friction");
  has(refusal([](ToolChanges& t) { t.added[0].path[0][2] = INFINITY; }), "path");
  has(refusal([](ToolChanges& t) { t.added[1].name = t.added[0].name; }), "two tools");
  has(refusal([](ToolChanges& t) { t.removed = {"nobody"}; }), "nobody");
  has(refusal([](ToolChanges& t) { t.parked = {"top", "side"}; }), "order");
  has(refusal([](ToolChanges& t) { t.parked = {"nobody"}; }), "nobody");
  has(refusal([](ToolChanges& t) { t.parked.clear(); }), "not the same");
}

}  // namespace
}  // namespace pliant::resume_tools_test
