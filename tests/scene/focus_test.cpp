// The key "focus": what arrives, what is refused and with which words.
#include "scene/patched_scene.h"

namespace pliant::model_test {
namespace {

TEST(SceneFocus, PathIsHeldOutsideAndLinearInBetween) {
  const Focus focus =
      parse_scene(patched(R"({"focus": {"path": [[1, 0, 10, -4], [3, 1, 20, -8], [3.5, 2, 20, 0]]}})"), "s").focus;
  ASSERT_EQ(focus.path.size(), 3U);
  EXPECT_EQ(focus.path[1], (std::array<double, 4>{3, 1, 20, -8}));
  EXPECT_EQ(focus.position(-5), (Vec3d{0, 10, -4}));
  EXPECT_EQ(focus.position(1), (Vec3d{0, 10, -4}));
  EXPECT_EQ(focus.position(1.5), (Vec3d{0.25, 12.5, -5}));
  EXPECT_EQ(focus.position(3), (Vec3d{1, 20, -8}));
  EXPECT_EQ(focus.position(3.25), (Vec3d{1.5, 20, -4}));
  EXPECT_EQ(focus.position(3.5), (Vec3d{2, 20, 0}));
  EXPECT_EQ(focus.position(100), (Vec3d{2, 20, 0}));
}

TEST(SceneFocus, OneRowStaysPut) {
  const Focus focus = parse_scene(patched(R"({"focus": {"path": [[1, 2, 3, 4]]}})"), "s").focus;
  for (const double time : {0.0, 1.0, 2.0}) EXPECT_EQ(focus.position(time), (Vec3d{2, 3, 4}));
  EXPECT_EQ(Focus().position(1), (Vec3d{0, 0, 0}));
}

TEST(SceneFocus, MistakesAreNamed) {
  const char* const rows = "/focus/path: got ";
  expect_refused(patched(R"({"focus": 1})"), "/focus: got 1, expected an object with the keys path");
  expect_refused(patched(R"({"focus": {}})"), R"(/focus: got no "path", expected a list of at least one row [time, x, y, z])");
  expect_refused(patched(R"({"focus": {"path": []}})"), std::string(rows) + "[], expected a list of at least one row");
  expect_refused(patched(R"({"focus": {"path": 0}})"), std::string(rows) + "0, expected a list of at least one row");
  expect_refused(patched(R"({"focus": {"path": [[0, 1, 2]]}})"),
                 "/focus/path/0: got [0,1,2], expected a row [time, x, y, z] in seconds and metres");
  expect_refused(patched(R"({"focus": {"path": [[0, 1, 2, "3"]]}})"), R"(/focus/path/0/3: got "3", expected a number)");
  expect_refused(patched(R"({"focus": {"path": [[0, 1, 2, 1e31]]}})"),
                 "/focus/path/0/3: got 1e+31, expected a number of magnitude");
  // An order between rows is more than a JSON schema can say.
  EXPECT_EQ(message(patched(R"({"focus": {"path": [[0, 1, 2, 3], [0, 1, 2, 3]]}})")),
            "dir/s.json: /focus/path/1/0: got 0, expected a time after the previous row's 0");
  EXPECT_EQ(message(patched(R"({"focus": {"path": [[1, 1, 2, 3], [0.5, 1, 2, 3]]}})")),
            "dir/s.json: /focus/path/1/0: got 0.5, expected a time after the previous row's 1");
}

}  // namespace
}  // namespace pliant::model_test
