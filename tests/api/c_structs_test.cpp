// The types of the C API: structs between programs and libraries of different versions, and the names of status codes.
#include <gtest/gtest.h>

#include <cctype>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>

#include "c_struct_checks.h"
#include "scenes.h"
#include "support/source_dir.h"

namespace pliant {
namespace {

using test::expect_checked;
using test::Later;

class CStructs : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(open(&options, &surface, 1), PLIANT_OK) << pliant_last_error(); }
  void TearDown() override { pliant_world_destroy(world); }

  pliant_status open(const pliant_options* with, const pliant_surface* surfaces, std::size_t count, char used = '0') {
    std::string text = R"({"format": "pliant-scene/1", "gravity": [0, -9.81, 0], "bodies": [{"name": "a",
      "surface": "memory:0", "lattice": {"spacing": 0.05}, "material": {"young": 3000, "poisson": 0.45}}]})";
    text.insert(
        text.size() - 1,
        R"(, "probes": [{"name": "p", "point": [0.05, 0.05, 0.05]}], "tools": [{"shape": {"sphere": 0.01}, "path": [[0, 1, 1, 1]]}])");
    text[text.find("memory:") + 7] = used;
    pliant_world_destroy(world);
    return pliant_world_parse(text.c_str(), nullptr, surfaces, count, with, &world);
  }
  [[nodiscard]] pliant_surface of(const SurfaceSpec& s) const {
    return {sizeof(pliant_surface), s.vertices[0].data(), s.vertices.size(), s.triangles[0].data(), s.triangles.size()};
  }

  SurfaceSpec box = box_surface({0, 0, 0}, {0.1, 0.1, 0.1});
  pliant_surface surface = of(box);
  pliant_options options = PLIANT_OPTIONS_INIT;
  pliant_world world{0};
};

/// Sizes of 0.2.0, which never change again, on machines of 64 bits.
TEST(CStructSizes, AreThoseOfTheFirstVersion) {
  if (sizeof(void*) != 8) GTEST_SKIP() << "the numbers are those of 64 bits";
  EXPECT_EQ(api::CStruct<pliant_options>::first_size, 40U);
  EXPECT_EQ(api::CStruct<pliant_surface>::first_size, 40U);
  EXPECT_EQ(api::CStruct<pliant_info>::first_size, 56U);
  EXPECT_EQ(api::CStruct<pliant_body>::first_size, 72U);
  EXPECT_EQ(api::CStruct<pliant_report>::first_size, 56U);
  EXPECT_EQ(api::CStruct<pliant_frame>::first_size, 136U);
  EXPECT_EQ(api::CStruct<pliant_cut>::first_size, 56U);
  EXPECT_EQ(api::CStruct<pliant_probe_value>::first_size, 40U);
  EXPECT_EQ(api::CStruct<pliant_tool_force>::first_size, 144U);
  EXPECT_EQ(api::CStruct<pliant_blade_force>::first_size, 152U);
  EXPECT_EQ(api::CStruct<pliant_cut_attempt>::first_size, 104U);
  EXPECT_EQ(api::CStruct<pliant_interpenetration>::first_size, 112U);
  EXPECT_EQ(api::CStruct<pliant_picked_point>::first_size, 112U);
  EXPECT_EQ(api::CStruct<pliant_live_options>::first_size, 24U);
  EXPECT_EQ(api::CStruct<pliant_live_state>::first_size, 64U);
  EXPECT_EQ(api::CStruct<pliant_event>::first_size, 88U);
  EXPECT_EQ(api::CStruct<pliant_force_sample>::first_size, 72U);
  EXPECT_EQ(api::CStruct<pliant_device_sample>::first_size, 88U);
  EXPECT_EQ(api::CStruct<pliant_device_wrench>::first_size, 72U);
  EXPECT_EQ(api::CStruct<pliant_device_limits>::first_size, 24U);
  EXPECT_EQ(api::CStruct<pliant_device_counts>::first_size, 32U);
  EXPECT_EQ(api::CStruct<pliant_device_callbacks>::first_size, 40U);
  EXPECT_EQ(api::CStruct<pliant_haptic_options>::first_size, 160U);
  EXPECT_EQ(api::CStruct<pliant_haptic_sample>::first_size, 120U);
  EXPECT_EQ(api::CStruct<pliant_haptic_state>::first_size, 192U);
}

TEST_F(CStructs, WhatIsFilledInFitsTheCaller) {
  const double triangle[9]{0.04, -1, -1, 0.04, 1, -1, 0.04, 1, 1}, a[3]{1, 0, 0}, b[3]{1, 0, 1}, above[3]{0.05, 1, 0.05},
      down[3]{0, -1, 0};
  std::int64_t step = -1;
  expect_checked<pliant_report>(PLIANT_REPORT_INIT, [&](pliant_report* r) { return pliant_world_step(world, 2, r); });
  ASSERT_EQ(pliant_world_step_number(world, &step), PLIANT_OK);
  EXPECT_EQ(step, 4) << "refused calls made no step";
  expect_checked<pliant_report>(PLIANT_REPORT_INIT, [&](pliant_report* r) { return pliant_world_advance(world, 0.01, r); });
  expect_checked<pliant_report>(PLIANT_REPORT_INIT, [&](pliant_report* r) { return pliant_world_wait(world, r); });
  expect_checked<pliant_info>(PLIANT_INFO_INIT, [&](pliant_info* i) { return pliant_world_info(world, i); });
  expect_checked<pliant_body>(PLIANT_BODY_INIT, [&](pliant_body* i) { return pliant_world_body(world, 0, i); });
  expect_checked<pliant_frame>(PLIANT_FRAME_INIT, [&](pliant_frame* f) { return pliant_world_frame(world, f); });
  expect_checked<pliant_frame>(PLIANT_FRAME_INIT, [&](pliant_frame* f) { return pliant_world_frame_since(world, 1, f); });
  int hit = 0;
  expect_checked<pliant_picked_point>(PLIANT_PICKED_POINT_INIT,
                                      [&](pliant_picked_point* p) { return pliant_world_pick(world, above, down, &hit, p); });
  EXPECT_EQ(hit, 1);
  expect_checked<pliant_cut>(PLIANT_CUT_INIT, [&](pliant_cut* c) { return pliant_world_cut(world, triangle, 1, c); });
  expect_checked<pliant_probe_value>(PLIANT_PROBE_VALUE_INIT,
                                     [&](pliant_probe_value* v) { return pliant_world_probes(world, v, 1, nullptr); });
  expect_checked<pliant_tool_force>(PLIANT_TOOL_FORCE_INIT,
                                    [&](pliant_tool_force* f) { return pliant_world_tool_forces(world, f, 1, nullptr); });
  expect_checked<pliant_cut>(PLIANT_CUT_INIT, [&](pliant_cut* c) { return pliant_world_move_blade(world, "b", a, b, c); });
}

TEST_F(CStructs, WhatIsToldMustBeKnown) {
  for (const std::size_t size : {std::size_t{0}, sizeof(pliant_options) - 1, std::size_t{5000}}) {
    options.size = size;
    EXPECT_EQ(open(&options, &surface, 1), PLIANT_USAGE);
    EXPECT_NE(std::string(pliant_last_error()).find("pliant_options::size is"), std::string::npos);
  }
  options.size = sizeof options;
  Later<pliant_options> later{options, {}};
  later.known.size = sizeof later;
  EXPECT_EQ(open(&later.known, &surface, 1), PLIANT_OK) << pliant_last_error();
  later.more[7] = 1;
  EXPECT_EQ(open(&later.known, &surface, 1), PLIANT_USAGE);
  EXPECT_NE(std::string(pliant_last_error()).find("the member at byte 47 is set"), std::string::npos) << pliant_last_error();
  options.reserved = 1;
  EXPECT_EQ(open(&options, &surface, 1), PLIANT_USAGE);
}

TEST_F(CStructs, AnArrayOfLaterSurfacesIsReadByItsOwnStride) {
  const SurfaceSpec other = box_surface({0, 0, 0}, {0.2, 0.1, 0.1});
  Later<pliant_surface> both[2]{{of(other), {}}, {of(box), {}}};
  for (auto& s : both) s.known.size = sizeof s;
  ASSERT_EQ(open(nullptr, &both[0].known, 2, '1'), PLIANT_OK) << pliant_last_error();
  pliant_body body = PLIANT_BODY_INIT;
  ASSERT_EQ(pliant_world_body(world, 0, &body), PLIANT_OK);
  EXPECT_NEAR(body.mass, 1, 1e-6) << "the second one is a cube of a litre";
  both[1].known.size = sizeof(pliant_surface);
  EXPECT_EQ(open(nullptr, &both[0].known, 2), PLIANT_USAGE);
  EXPECT_NE(std::string(pliant_last_error()).find("in surfaces[1]"), std::string::npos) << pliant_last_error();
  both[0].known.size = 0;
  EXPECT_EQ(open(nullptr, &both[0].known, 2), PLIANT_USAGE);
}

/// Names and numbers of the enumerators in a header of include/pliant, in lower case.
std::map<std::string, int> enumerators(const std::string& header, const std::string& begin, const std::string& prefix) {
  std::ifstream in(test::source_dir() + "/include/pliant/" + header);
  std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const std::size_t first = text.find(begin);
  if (first == std::string::npos) return {};
  text = text.substr(first, text.find('}', first) - first);
  std::map<std::string, int> found;
  const std::regex entry(prefix + "([A-Za-z]+) = ([0-9]+)");
  for (std::sregex_iterator at(text.begin(), text.end(), entry), end; at != end; ++at) {
    std::string name = (*at)[1];
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    found[name] = std::stoi((*at)[2]);
  }
  return found;
}

/// Names come from the header, so that a new code without a name, and two codes of one name, are seen here.
TEST(CApiNames, EveryStatusHasOne) {
  const std::map<std::string, int> codes = enumerators("c/types.h", "typedef enum pliant_status", "PLIANT_");
  EXPECT_GE(codes.size(), 8U);
  std::set<int> numbers;
  for (const auto& [name, number] : codes) {
    EXPECT_EQ(pliant_status_name(static_cast<pliant_status>(number)), name);
    EXPECT_TRUE(numbers.insert(number).second) << number << " stands twice";
  }
  for (int number = -1; number < 40; ++number) {
    if (numbers.contains(number)) continue;
    EXPECT_STREQ(pliant_status_name(static_cast<pliant_status>(number)), "unknown") << number;
  }
  for (const auto& [name, number] : enumerators("error.h", "enum class ErrorCode", "")) {
    if (name == "difference") continue;  // of the command `compare`
    EXPECT_TRUE(numbers.contains(number)) << "ErrorCode::" << name << " has no pliant_status";
  }
  const std::string expected = std::to_string(PLIANT_VERSION_MAJOR) + "." + std::to_string(PLIANT_VERSION_MINOR) + "." +
                               std::to_string(PLIANT_VERSION_PATCH);
  EXPECT_EQ(pliant_version(), expected);
}

}  // namespace
}  // namespace pliant
