// The C API: what it computes, and that no misuse gets past it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "api/c_handles.h"
#include "pliant/c/pliant.h"
#include "scenes.h"
#include "support/source_dir.h"

namespace pliant {
namespace {

const std::string kScene = R"({"format": "pliant-scene/1", "gravity": [0, -9.81, 0], "bodies": [{"name": "block",
  "surface": "memory:0", "lattice": {"spacing": 0.02}, "material": {"young": 3000, "poisson": 0.45, "damping": 5},
  "fixed": [{"plane": [[0, 0.001, 0], [0, -1, 0]]}]}]})";

class CApi : public ::testing::Test {
 protected:
  void SetUp() override {
    options.backend = "cpu";
    options.interactive = 1;
    const pliant_surface surface{sizeof(pliant_surface), box.vertices[0].data(), box.vertices.size(), box.triangles[0].data(),
                                 box.triangles.size()};
    ASSERT_EQ(pliant_world_parse(kScene.c_str(), nullptr, &surface, 1, &options, &world), PLIANT_OK) << pliant_last_error();
  }
  void TearDown() override { pliant_world_destroy(world); }

  SurfaceSpec box = box_surface({0, 0, 0}, {0.1, 0.08, 0.06});
  pliant_options options = PLIANT_OPTIONS_INIT;
  pliant_world world{0};
};

TEST_F(CApi, ComputesWhatTheCppApiComputes) {
  World other(test::block(0), test::on("cpu", true));
  other.step(100);
  pliant_report report = PLIANT_REPORT_INIT;
  ASSERT_EQ(pliant_world_step(world, 100, &report), PLIANT_OK);
  EXPECT_EQ(report.done, 100);
  EXPECT_EQ(report.step, 100);
  EXPECT_EQ(report.diverged, 0);
  std::uint64_t hash = 0;
  ASSERT_EQ(pliant_world_hash(world, &hash), PLIANT_OK);
  EXPECT_EQ(hash, other.hash());
  pliant_info info = PLIANT_INFO_INIT;
  ASSERT_EQ(pliant_world_info(world, &info), PLIANT_OK);
  EXPECT_EQ(info.vertices, 8U);
  EXPECT_EQ(info.triangles, 12U);
  EXPECT_EQ(info.nodes, other.info().nodes);
  std::vector<float> x(24), n(24);
  std::vector<std::int32_t> t(36);
  std::vector<double> u(3 * static_cast<std::size_t>(info.nodes));
  ASSERT_EQ(pliant_world_positions(world, x.data(), x.size()), PLIANT_OK);
  ASSERT_EQ(pliant_world_normals(world, n.data(), n.size()), PLIANT_OK);
  ASSERT_EQ(pliant_world_triangles(world, t.data(), t.size()), PLIANT_OK);
  ASSERT_EQ(pliant_world_displacements(world, 0, u.data(), u.size()), PLIANT_OK);
  const FramePtr frame = other.frame();
  for (std::size_t v = 0; v < 8; ++v) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(x[3 * v + c], frame->positions[v][c]);
  }
  EXPECT_EQ(t[0], frame->triangles[0][0]);
  pliant_frame view = PLIANT_FRAME_INIT;
  ASSERT_EQ(pliant_world_frame(world, &view), PLIANT_OK);
  EXPECT_EQ(view.positions[4], frame->positions[1][0]);
  EXPECT_EQ(view.vertex_count, 8U);
  EXPECT_EQ(view.cut_faces, nullptr);
  char text[200];
  ASSERT_EQ(pliant_world_backend(world, text, sizeof text), PLIANT_OK);
  EXPECT_EQ(std::string(text).rfind("cpu (", 0), 0U);
  char small[4];
  ASSERT_EQ(pliant_world_backend(world, small, sizeof small), PLIANT_OK);
  EXPECT_STREQ(small, "cpu");
  std::size_t needed = 0;
  ASSERT_EQ(pliant_world_remarks(world, text, sizeof text, &needed), PLIANT_OK);
  EXPECT_EQ(needed, 1U) << text;
}

TEST_F(CApi, StepsAsynchronouslyAndPullsAtTheSurface) {
  int started = 0, fresh = 1, busy = 1;
  std::uint64_t grab = 0;
  const double target[3]{0.12, 0.08, 0.06}, force[3]{0, 0, 0.01};
  pliant_frame frame = PLIANT_FRAME_INIT;
  ASSERT_EQ(pliant_world_frame(world, &frame), PLIANT_OK);
  ASSERT_EQ(pliant_world_poll(world, &fresh), PLIANT_OK);
  EXPECT_EQ(fresh, 0);
  ASSERT_EQ(pliant_world_grab(world, 7, 0, 0, 0, &grab), PLIANT_OK);
  ASSERT_EQ(pliant_world_move_grab(world, grab, target), PLIANT_OK);
  ASSERT_EQ(pliant_world_push(world, 6, force), PLIANT_OK);
  ASSERT_EQ(pliant_world_step_async(world, 200, &started), PLIANT_OK);
  EXPECT_EQ(started, 1);
  ASSERT_EQ(pliant_world_wait(world, nullptr), PLIANT_OK);
  ASSERT_EQ(pliant_world_busy(world, &busy), PLIANT_OK);
  EXPECT_EQ(busy, 0);
  ASSERT_EQ(pliant_world_poll(world, &fresh), PLIANT_OK);
  EXPECT_EQ(fresh, 1);
  ASSERT_EQ(pliant_world_frame(world, &frame), PLIANT_OK);
  EXPECT_GT(frame.positions[4 * 7], 0.1F);
  EXPECT_EQ(pliant_world_release(world, grab), PLIANT_OK);
  EXPECT_EQ(pliant_world_release(world, grab), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_clear_handles(world), PLIANT_OK);
  EXPECT_EQ(pliant_world_reset(world), PLIANT_OK);
  EXPECT_EQ(pliant_world_advance(world, 0.01, nullptr), PLIANT_OK);
}

TEST_F(CApi, NumbersOfTheWorldAreThoseOfCpp) {
  World other(test::block(0), test::on("cpu", true));
  const double force[3]{0.1, 0, 0}, tool[3]{0, 0, 0};
  const std::int64_t node = 5;  // a corner at the top would do; any node of the surface is as good
  ASSERT_EQ(pliant_world_push_node(world, 0, node, force), PLIANT_OK) << pliant_last_error();
  ASSERT_EQ(pliant_world_move_focus(world, tool), PLIANT_OK);
  other.push_node(0, node, {0.1, 0, 0});
  other.step(100);
  ASSERT_EQ(pliant_world_step(world, 100, nullptr), PLIANT_OK);
  const std::size_t count = 3 * static_cast<std::size_t>(other.info().nodes);
  std::vector<double> v(count), x(count), u(count);
  ASSERT_EQ(pliant_world_velocities(world, 0, v.data(), count), PLIANT_OK);
  ASSERT_EQ(pliant_world_rest_positions(world, 0, x.data(), count), PLIANT_OK);
  ASSERT_EQ(pliant_world_displacements(world, 0, u.data(), count), PLIANT_OK);
  for (std::size_t n = 0; n < count; ++n) {
    EXPECT_EQ(v[n], other.velocities(0)[n / 3][n % 3]);
    EXPECT_EQ(x[n], other.rest_positions(0)[n / 3][n % 3]);
    EXPECT_EQ(u[n], other.displacements(0)[n / 3][n % 3]);
  }
  EXPECT_NE(*std::max_element(v.begin(), v.end()), 0);
  double time = 0, dt = 0, stable = 0;
  std::int64_t step = 0;
  ASSERT_EQ(pliant_world_time(world, &time), PLIANT_OK);
  ASSERT_EQ(pliant_world_dt(world, &dt), PLIANT_OK);
  ASSERT_EQ(pliant_world_stable_dt(world, &stable), PLIANT_OK);
  ASSERT_EQ(pliant_world_step_number(world, &step), PLIANT_OK);
  EXPECT_EQ(std::vector<double>({time, dt, stable}), std::vector<double>({other.time(), other.dt(), other.stable_dt()}));
  EXPECT_EQ(step, 100);
  pliant_body body = PLIANT_BODY_INIT;
  ASSERT_EQ(pliant_world_body(world, 0, &body), PLIANT_OK);
  EXPECT_STREQ(body.name, "block");
  EXPECT_EQ(body.mass, other.info().bodies[0].mass);
  EXPECT_EQ(body.elements, other.info().elements);
  EXPECT_EQ(body.triangle_count, 12U);
  EXPECT_EQ(pliant_world_body(world, 1, &body), PLIANT_USAGE);
  char names[4000], small[4];
  std::size_t needed = 0;
  ASSERT_EQ(pliant_backend_names(names, sizeof names, &needed), PLIANT_OK);
  std::string expected;
  for (const std::string& name : backend_names()) expected += (expected.empty() ? "" : "\n") + name;
  EXPECT_EQ(names, expected);
  EXPECT_EQ(needed, expected.size() + 1);
  ASSERT_EQ(pliant_backend_names(small, sizeof small, nullptr), PLIANT_OK);
  EXPECT_STREQ(small, "cpu");
  EXPECT_EQ(pliant_backend_names(small, 0, nullptr), PLIANT_USAGE);
}

TEST_F(CApi, EachConsumerHasItsRangesAndItsPointers) {
  pliant_frame polled = PLIANT_FRAME_INIT, one = PLIANT_FRAME_INIT, two = PLIANT_FRAME_INIT;
  std::vector<float> x(24), copy(32);
  ASSERT_EQ(pliant_world_frame(world, &polled), PLIANT_OK);
  ASSERT_EQ(pliant_world_frame_since(world, 1, &one), PLIANT_OK);
  std::copy_n(polled.positions, 32, copy.begin());
  for (int i = 0; i < 6; ++i) {
    ASSERT_EQ(pliant_world_step(world, 20, nullptr), PLIANT_OK);
    ASSERT_EQ(pliant_world_positions(world, x.data(), 24), PLIANT_OK);
    ASSERT_EQ(pliant_world_frame_since(world, 2, &two), PLIANT_OK);
    EXPECT_EQ(two.dirty_triangle_count, i == 0 ? 12U : 0U);
    EXPECT_EQ(two.positions[4], x[3]);
  }
  EXPECT_TRUE(std::equal(copy.begin(), copy.end(), polled.positions)) << "its memory was used for another frame";
  EXPECT_TRUE(std::equal(copy.begin(), copy.end(), one.positions));
  int fresh = 0;
  ASSERT_EQ(pliant_world_poll(world, &fresh), PLIANT_OK);
  EXPECT_EQ(fresh, 1);
  ASSERT_EQ(pliant_world_frame(world, &polled), PLIANT_OK);
  EXPECT_GT(polled.dirty_vertex_count, 0U);
  ASSERT_EQ(pliant_world_frame_since(world, 1, &one), PLIANT_OK);
  EXPECT_EQ(one.dirty_vertex_first, polled.dirty_vertex_first);
  EXPECT_EQ(one.dirty_vertex_count, polled.dirty_vertex_count);
  EXPECT_EQ(one.rest[4], 0.1F);
  ASSERT_EQ(pliant_world_forget_consumer(world, 1), PLIANT_OK);
  EXPECT_EQ(pliant_world_forget_consumer(world, 1), PLIANT_USAGE);
  ASSERT_EQ(pliant_world_frame_since(world, 1, &one), PLIANT_OK);
  EXPECT_EQ(one.dirty_vertex_count, one.vertex_count);
}

TEST_F(CApi, UseAfterDestroyIsCaught) {
  const pliant_world dead = world;
  ASSERT_EQ(pliant_world_destroy(world), PLIANT_OK);
  pliant_report report = PLIANT_REPORT_INIT;
  pliant_frame frame = PLIANT_FRAME_INIT;
  EXPECT_EQ(pliant_world_step(dead, 1, &report), PLIANT_STATE);
  EXPECT_NE(std::string(pliant_last_error()).find("destroyed"), std::string::npos);
  EXPECT_EQ(pliant_world_frame(dead, &frame), PLIANT_STATE);
  EXPECT_EQ(pliant_world_destroy(dead), PLIANT_STATE);
  EXPECT_EQ(pliant_world_step({0}, 1, &report), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_step({~std::uint64_t{0}}, 1, &report), PLIANT_STATE);
  SetUp();  // a new world gets another handle
  EXPECT_NE(world.id, dead.id);
  EXPECT_EQ(pliant_world_step(dead, 1, &report), PLIANT_STATE);
}

TEST_F(CApi, AWorldDestroyedInAnotherThreadFinishesItsCall) {
  std::thread stepping([w = world] { pliant_world_step(w, 3000, nullptr); });
  EXPECT_EQ(pliant_world_destroy(world), PLIANT_OK);
  stepping.join();
}

/// Every function that takes a world, with pointers that are all right or all null.
std::vector<std::pair<const char*, pliant_status>> call_all(pliant_world w, bool null) {
  static std::vector<double> u(3000);
  static float x[24];
  static std::int32_t t[36];
  static char text[64];
  static int flag;
  static std::int64_t count;
  static std::uint64_t number;
  static pliant_info info = PLIANT_INFO_INIT;
  static pliant_body body = PLIANT_BODY_INIT;
  static pliant_report report = PLIANT_REPORT_INIT;
  static pliant_frame frame = PLIANT_FRAME_INIT;
  static std::uint8_t faces[12];
  const double point[3]{}, triangle[3][3]{{1, 0, 0}, {2, 0, 0}, {1, 1, 0}};
  const auto p = [null](auto* pointer) { return null ? nullptr : pointer; };
  return {{"info", pliant_world_info(w, p(&info))},
          {"backend", pliant_world_backend(w, p(text), sizeof text)},
          {"body_nodes", pliant_world_body_nodes(w, 0, p(&count))},
          {"step_async", pliant_world_step_async(w, 0, p(&flag))},
          {"advance_async", pliant_world_advance_async(w, 0, p(&flag))},
          {"busy", pliant_world_busy(w, p(&flag))},
          {"poll", pliant_world_poll(w, p(&flag))},
          {"frame", pliant_world_frame(w, p(&frame))},
          {"positions", pliant_world_positions(w, p(x), 24)},
          {"normals", pliant_world_normals(w, p(x), 24)},
          {"triangles", pliant_world_triangles(w, p(t), 36)},
          {"displacements", pliant_world_displacements(w, 0, p(u.data()), 3000)},
          {"body", pliant_world_body(w, 0, p(&body))},
          {"time", pliant_world_time(w, p(u.data()))},
          {"step_number", pliant_world_step_number(w, p(&count))},
          {"dt", pliant_world_dt(w, p(u.data()))},
          {"stable_dt", pliant_world_stable_dt(w, p(u.data()))},
          {"frame_since", pliant_world_frame_since(w, 1, p(&frame))},
          {"velocities", pliant_world_velocities(w, 0, p(u.data()), 3000)},
          {"rest_positions", pliant_world_rest_positions(w, 0, p(u.data()), 3000)},
          {"push_node", pliant_world_push_node(w, 0, 0, p(point))},
          {"move_focus", pliant_world_move_focus(w, p(point))},
          {"forget_consumer", pliant_world_forget_consumer(w, 77)},
          {"hash", pliant_world_hash(w, p(&number))},
          {"grab", pliant_world_grab(w, 0, 0, 0, 0, p(&number))},
          {"move_grab", pliant_world_move_grab(w, number, p(point))},
          {"push", pliant_world_push(w, 0, p(point))},
          {"cut_faces", pliant_world_cut_faces(w, p(faces), 12)},
          {"cut", pliant_world_cut(w, p(&triangle[0][0]), 1, nullptr)},
          {"move_blade", pliant_world_move_blade(w, p("blade"), p(triangle[0]), p(triangle[1]), nullptr)},
          {"lift_blade", pliant_world_lift_blade(w, p("blade"))},
          {"pieces", pliant_world_pieces(w, 0, p(&count))},
          {"save", pliant_world_save(w, p("no/such/folder/state"))},
          {"load", pliant_world_load(w, p("no/such/state"))},
          {"step", null ? PLIANT_USAGE : pliant_world_step(w, 0, &report)},  // these may have none
          {"advance", null ? PLIANT_USAGE : pliant_world_advance(w, 0, &report)},
          {"wait", null ? PLIANT_USAGE : pliant_world_wait(w, &report)},
          {"release", null ? PLIANT_USAGE : pliant_world_release(w, 0)},
          {"clear_handles", null ? PLIANT_USAGE : pliant_world_clear_handles(w)},
          {"reset", null ? PLIANT_USAGE : pliant_world_reset(w)},
          {"destroy", null ? PLIANT_USAGE : pliant_world_destroy(w)}};
}

TEST_F(CApi, EveryFunctionRefusesNullPointersAndDeadWorlds) {
  for (const auto& [name, status] : call_all(world, true)) EXPECT_EQ(status, PLIANT_USAGE) << name;
  EXPECT_EQ(pliant_world_step(world, 1, nullptr), PLIANT_OK) << "a world that was called wrongly goes on";
  const pliant_world dead = world;
  ASSERT_EQ(pliant_world_destroy(world), PLIANT_OK);
  for (const auto& [name, status] : call_all(dead, false)) EXPECT_EQ(status, PLIANT_STATE) << name;
  for (const auto& [name, status] : call_all({0}, false)) EXPECT_EQ(status, PLIANT_USAGE) << name;
}

TEST_F(CApi, TwoThreadsThatDoNotTakeTurnsAreRefusedAndHarmNothing) {
  const auto read = [w = world] {
    for (int i = 0; i < 200; ++i) {
      pliant_frame frame = PLIANT_FRAME_INIT;
      const pliant_status status = pliant_world_frame(w, &frame);
      EXPECT_TRUE(status == PLIANT_OK || status == PLIANT_STATE) << pliant_last_error();
      pliant_world_step(w, 1, nullptr);
    }
  };
  std::thread other(read);
  read();
  other.join();
  EXPECT_EQ(pliant_world_step(world, 1, nullptr), PLIANT_OK);
}

TEST_F(CApi, NullPointersAndWrongSizes) {
  pliant_world out{17};
  EXPECT_EQ(pliant_world_open(nullptr, nullptr, &out), PLIANT_USAGE);
  EXPECT_EQ(out.id, 0U);
  EXPECT_EQ(pliant_world_open("scene.json", nullptr, nullptr), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_open("no/such/scene.json", nullptr, &out), PLIANT_IO);
  EXPECT_EQ(pliant_world_parse("{", nullptr, nullptr, 0, nullptr, &out), PLIANT_INPUT);
  EXPECT_EQ(pliant_world_parse(kScene.c_str(), nullptr, nullptr, 1, nullptr, &out), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_parse(kScene.c_str(), nullptr, nullptr, 0, nullptr, &out), PLIANT_INPUT);
  pliant_options bad = options;
  bad.size = 3;
  EXPECT_EQ(pliant_world_open("scene.json", &bad, &out), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_frame(world, nullptr), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_info(world, nullptr), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_positions(world, nullptr, 24), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_push(world, 0, nullptr), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_save(world, nullptr), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_poll(world, nullptr), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_step(world, 1, nullptr), PLIANT_OK);
  std::vector<float> x(25);
  EXPECT_EQ(pliant_world_positions(world, x.data(), 23), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_positions(world, x.data(), 25), PLIANT_USAGE);
  EXPECT_NE(std::string(pliant_last_error()).find("holds 25 numbers, expected 24"), std::string::npos) << pliant_last_error();
  std::vector<double> u(2);
  EXPECT_EQ(pliant_world_displacements(world, 0, u.data(), 2), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_displacements(world, 5, u.data(), 2), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_step(world, -1, nullptr), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_step(world, 1, nullptr), PLIANT_OK);
  EXPECT_STREQ(pliant_last_error(), "");
}

TEST_F(CApi, DivergenceIsReportedAndThenRefused) {
  pliant_world unstable{0};
  const pliant_surface surface{sizeof(pliant_surface), box.vertices[0].data(), box.vertices.size(), box.triangles[0].data(),
                               box.triangles.size()};
  options.dt = 0.05;
  ASSERT_EQ(pliant_world_parse(kScene.c_str(), nullptr, &surface, 1, &options, &unstable), PLIANT_OK) << pliant_last_error();
  pliant_report report = PLIANT_REPORT_INIT;
  for (int i = 0; i < 1000 && report.diverged == 0; ++i) ASSERT_EQ(pliant_world_step(unstable, 10, &report), PLIANT_OK);
  ASSERT_EQ(report.diverged, 1);
  EXPECT_NE(std::string(report.message).find("block"), std::string::npos) << report.message;
  EXPECT_EQ(pliant_world_step(unstable, 1, &report), PLIANT_DIVERGED);
  std::vector<float> x(24);
  EXPECT_EQ(pliant_world_positions(unstable, x.data(), x.size()), PLIANT_OK);
  for (const float v : x) EXPECT_TRUE(std::isfinite(v));
  pliant_world_destroy(unstable);
}

TEST_F(CApi, ALostDeviceLeavesTheLastFrame) {
  const auto left = std::make_shared<std::atomic<int>>(1 << 30);
  std::vector<SurfaceSpec> surfaces{box};
  Scene scene = parse_scene(
      R"({"format": "pliant-scene/1", "bodies": [{"name": "cube", "surface": ")" + test::source_dir() +
          R"(/scenes/meshes/cube.obj", "lattice": {"spacing": 0.02}, "material": {"young": 3000, "poisson": 0.4}, "velocity": [1, 0, 0]}]})",
      "");
  const pliant_world lost{api::Handles::all().add(std::make_shared<api::CWorld>(
      WorldAccess::make(std::move(scene), [left](std::string*, std::int64_t) -> std::unique_ptr<Backend> {
        return std::make_unique<test::FaultyBackend>(open_backend("cpu"), left);
      })))};
  ASSERT_EQ(pliant_world_step(lost, 50, nullptr), PLIANT_OK);
  pliant_frame before = PLIANT_FRAME_INIT, after = PLIANT_FRAME_INIT;
  ASSERT_EQ(pliant_world_frame(lost, &before), PLIANT_OK);
  *left = 0;
  EXPECT_EQ(pliant_world_step(lost, 50, nullptr), PLIANT_DEVICE);
  EXPECT_NE(std::string(pliant_last_error()).find("CL_DEVICE_NOT_AVAILABLE"), std::string::npos);
  ASSERT_EQ(pliant_world_frame(lost, &after), PLIANT_OK);
  EXPECT_EQ(after.positions, before.positions);
  EXPECT_EQ(after.step, 50);
  pliant_world_destroy(lost);
}

}  // namespace
}  // namespace pliant
