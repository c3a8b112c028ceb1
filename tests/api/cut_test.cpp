// Cuts through the API: what frames show, when they happen, and what is refused.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <thread>

#include "api/scenes.h"
#include "pliant/c/pliant.h"
#include "support/source_dir.h"
#include "support/temp_folder.h"

namespace pliant::cut_test {
namespace {

using namespace test;

/// A hanging block of 10 x 8 x 6 cm, held at its lower x face.
SceneSpec held_block() {
  SceneSpec scene = block(0);
  scene.bodies[0].fixed = {{RegionSpec::plane({0.001, 0, 0}, {-1, 0, 0})}};
  return scene;
}

using Sweep = std::vector<std::array<Vec3d, 3>>;

/// Two triangles in the plane x = `at` that reach far beyond the block.
Sweep wall(double at) {
  const Vec3d a{at, -1, -1}, b{at, 1, -1}, c{at, 1, 1}, d{at, -1, 1};
  return {{a, b, c}, {a, c, d}};
}

void expect_closed(const Frame& frame) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> count, sum;
  for (const Triangle& t : frame.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = t[k], b = t[(k + 1) % 3];
      ASSERT_GE(a, 0);
      ASSERT_LT(static_cast<std::size_t>(a), frame.positions.size());
      ++count[std::minmax(a, b)];
      sum[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  for (const auto& [edge, n] : count) {
    EXPECT_EQ(n, 2);
    EXPECT_EQ(sum[edge], 0);
  }
}

double rest_volume_of(const Frame& frame) {
  double six = 0;
  for (const Triangle& t : frame.triangles) {
    const Vec4f &a = frame.rest[t[0]], &b = frame.rest[t[1]], &c = frame.rest[t[2]];
    six += a[0] * (static_cast<double>(b[1]) * c[2] - static_cast<double>(b[2]) * c[1]) +
           a[1] * (static_cast<double>(b[2]) * c[0] - static_cast<double>(b[0]) * c[2]) +
           a[2] * (static_cast<double>(b[0]) * c[1] - static_cast<double>(b[1]) * c[0]);
  }
  return six / 6;
}

TEST(ApiCut, AFrameShowsTheCutAndKeepsTheVerticesBesideIt) {
  World world(held_block(), on("cpu"));
  world.step(20);
  const FramePtr before = world.frame();
  EXPECT_TRUE(before->cut_faces.empty());
  EXPECT_FALSE(world.poll());
  const CutResult result = world.cut(wall(0.047));
  EXPECT_TRUE(result.changed);
  EXPECT_FALSE(result.pending);
  EXPECT_GT(result.edges, 0);
  EXPECT_GT(result.seconds, 0);
  EXPECT_EQ(world.pieces(0), 2);
  EXPECT_TRUE(world.poll()) << "no step was made, but the surface is another one";
  const FramePtr after = world.frame();
  EXPECT_FALSE(world.poll());
  EXPECT_EQ(after->step, before->step);
  EXPECT_NE(after->topology_version, before->topology_version);
  ASSERT_EQ(after->cut_faces.size(), after->triangles.size());
  EXPECT_GT(std::count(after->cut_faces.begin(), after->cut_faces.end(), 1), 4);
  EXPECT_GT(after->positions.size(), before->positions.size());
  for (std::size_t v = 0; v < before->positions.size(); ++v) EXPECT_EQ(after->positions[v], before->positions[v]) << v;
  EXPECT_EQ(after->rest.size(), after->positions.size());
  EXPECT_EQ(after->normals.size(), after->positions.size());
  expect_closed(*after);
  EXPECT_NEAR(rest_volume_of(*after), rest_volume_of(*before), 1e-6 * rest_volume_of(*before));
  // What lies before the range is the same; it ends where the arrays end.
  const IndexRange faces = after->dirty_triangles;
  EXPECT_EQ(faces.first + faces.count, after->triangles.size());
  for (std::size_t t = 0; t < faces.first; ++t) EXPECT_EQ(after->triangles[t], before->triangles[t]);
  EXPECT_EQ(after->dirty_vertices.first + after->dirty_vertices.count, after->positions.size());
  world.step(200);
  EXPECT_EQ(world.frame()->topology_version, after->topology_version);
  EXPECT_EQ(world.frame()->dirty_triangles.count, 0U);
}

TEST(ApiCut, ABodyBehindOneThatIsCutKeepsItsVertices) {
  SceneSpec scene = held_block();
  scene.gravity = {};
  scene.bodies.push_back(scene.bodies[0]);
  scene.bodies[1].name = "second";
  scene.bodies[1].translate = {1, 0, 0};
  scene.bodies[1].fixed = {{RegionSpec::plane({1.001, 0, 0}, {-1, 0, 0})}};
  World world(scene, on("cpu", true));
  const FramePtr before = world.frame();
  const IndexRange second = before->body_vertices[1];
  EXPECT_EQ(second.count, world.info().bodies[1].vertices.count);
  world.cut(wall(0.047));
  const std::int32_t held = static_cast<std::int32_t>(second.first) + 3;  // as the frame that was seen last counts
  const GrabId grab = world.grab(held);
  const FramePtr after = world.frame();
  const IndexRange moved = after->body_vertices[1];
  EXPECT_EQ(moved.count, second.count);
  EXPECT_GT(moved.first, second.first);
  for (std::size_t v = 0; v < second.count; ++v) {
    EXPECT_EQ(after->positions[moved.first + v], before->positions[second.first + v]);
  }
  EXPECT_EQ(world.pieces(1), 1);
  const Vec4f from = after->positions[moved.first + 3];
  world.move_grab(grab, {from[0], from[1] + 0.01, from[2]});
  world.advance(1.0);
  EXPECT_GT(world.frame()->positions[moved.first + 3][1], from[1] + 0.005F);
}

TEST(ApiCut, ABladeCutsFromItsSecondPlaceOnAndNotAfterItWasLifted) {
  World world(held_block(), on("cpu"));
  EXPECT_FALSE(world.move_blade("b", {0.041, 0.2, -1}, {0.041, 0.2, 1}).changed);
  EXPECT_GT(world.move_blade("b", {0.041, 0.05, -1}, {0.041, 0.05, 1}).edges, 0);
  world.lift_blade("b");
  EXPECT_EQ(world.move_blade("b", {0.041, -0.2, -1}, {0.041, -0.2, 1}).edges, 0);
  EXPECT_EQ(world.pieces(0), 1);
  EXPECT_TRUE(world.move_blade("b", {0.041, 0.2, -1}, {0.041, 0.2, 1}).changed);
  EXPECT_EQ(world.pieces(0), 2);
  EXPECT_FALSE(world.step(100).diverged);
}

TEST(ApiCut, TheWorkerCutsBeforeItsNextBatch) {
  World before(held_block(), on("cpu")), between(held_block(), on("cpu")), behind(held_block(), on("cpu"));
  before.cut(wall(0.047));
  between.step(64);
  between.cut(wall(0.047));
  for (World* world : {&before, &between}) world->step(128 - world->step_number());
  behind.step_async(64);
  behind.cut(wall(0.047));  // at once if the worker is done, before its first batch if it has not begun
  behind.wait();
  ASSERT_TRUE(behind.step_async(64));
  behind.wait();
  EXPECT_EQ(behind.pieces(0), 2);
  EXPECT_TRUE(behind.poll());
  expect_closed(*behind.frame());
  EXPECT_TRUE(behind.hash() == between.hash() || behind.hash() == before.hash());
}

TEST(ApiCut, WhoStepsBesideTheWorkerWaitsForNoCut) {
  World world(held_block(), on("cpu")), alone(held_block(), on("cpu"));
  for (World* w : {&world, &alone}) w->move_blade("b", {0.041, 0.2, -1}, {0.041, 0.2, 1});
  ASSERT_TRUE(world.step_async(64));
  while (world.busy()) std::this_thread::yield();
  const std::uint64_t version = world.frame()->topology_version;
  for (const double y : {0.06, 0.03, -0.2}) {
    const CutResult result = world.move_blade("b", {0.041, y, -1}, {0.041, y, 1});
    EXPECT_TRUE(result.pending);
    EXPECT_FALSE(result.changed);
  }
  EXPECT_EQ(world.frame()->topology_version, version) << "the worker has had no batch yet";
  ASSERT_TRUE(world.step_async(64));
  EXPECT_FALSE(world.wait().diverged);
  EXPECT_EQ(world.pieces(0), 2);
  EXPECT_EQ(world.frame()->topology_version, version + 1) << "what a blade moves between two batches is one cut";
  expect_closed(*world.frame());
  alone.step(64);
  EXPECT_TRUE(alone.move_blade("b", {0.041, -0.2, -1}, {0.041, -0.2, 1}).changed);
  alone.step(64);
  const auto u = world.displacements(0), expected = alone.displacements(0);
  ASSERT_EQ(u.size(), expected.size()) << "the same cut, whoever makes it";
  for (std::size_t n = 0; n < u.size(); ++n) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(u[n][c], expected[n][c], 3e-4);  // tissue carries the places of a blade
  }
  EXPECT_TRUE(world.cut(wall(0.021)).changed) << "after wait() the caller makes it";
  ASSERT_TRUE(world.step_async(1));
  while (world.busy()) std::this_thread::yield();
  EXPECT_TRUE(world.cut(wall(0.031)).pending);
  ASSERT_TRUE(world.step_async(0)) << "who stops stepping still sees it";
  world.wait();
  EXPECT_EQ(world.frame()->topology_version, version + 3);
}

TEST(ApiCut, GrabsAndPushesHoldOnThroughCuts) {
  SceneSpec scene = held_block();
  scene.gravity = {};
  World world(scene, on("cpu", true));
  const FramePtr frame = world.frame();
  std::int32_t corner = 0;
  for (std::size_t v = 0; v < frame->rest.size(); ++v) {
    if (frame->rest[v][0] > 0.099F && frame->rest[v][1] > 0.079F) corner = static_cast<std::int32_t>(v);
  }
  const GrabId hand = world.grab(corner, {0.03, 0, 0});
  world.move_grab(hand, {0.12, 0.09, 0.03});
  world.push(corner, {0, 0.01, 0});
  world.step(100);
  for (const double at : {0.091, 0.071, 0.053}) {
    EXPECT_TRUE(world.cut(wall(at)).changed);
    EXPECT_FALSE(world.step(100).diverged);
  }
  const float held = world.frame()->positions[static_cast<std::size_t>(corner)][0];
  EXPECT_GT(held, 0.1F) << "the loose end is still in the hand";
  world.release(hand);
  world.clear_handles();
  EXPECT_FALSE(world.step(100).diverged);
}

TEST(ApiCut, ResetAndLoadGoBackAndForthOverACut) {
  World world(held_block(), on("cpu", true));
  const FramePtr whole = world.frame();
  world.cut(wall(0.047));
  const GrabId hand = world.grab(0);
  world.step(50);
  const std::string file = ::testing::TempDir() + "/api_cut.pckpt";
  world.save(file);
  const std::uint64_t hash = world.hash();
  const std::size_t vertices = world.frame()->positions.size();
  world.reset();
  EXPECT_EQ(world.pieces(0), 1);
  const FramePtr again = world.frame();
  EXPECT_EQ(again->positions.size(), whole->positions.size());
  EXPECT_TRUE(again->cut_faces.empty());
  EXPECT_EQ(code_of([&] { world.release(hand); }), ErrorCode::usage);
  world.load(file);
  EXPECT_EQ(world.hash(), hash);
  EXPECT_EQ(world.pieces(0), 2);
  EXPECT_EQ(world.frame()->positions.size(), vertices);
  const IndexRange dirty = world.frame()->dirty_vertices;
  EXPECT_LE(dirty.first + dirty.count, vertices);
}

/// Neither reads the body again and fills it with elements, which takes longer than all else that they do.
TEST(ApiCut, ResetAndLoadNeedNoFileOfTheBody) {
  const TempFolder folder;
  const std::string body = (folder.path() / "cube.obj").string(), saved = (folder.path() / "cut.pckpt").string();
  std::filesystem::copy_file(source_dir() + "/scenes/meshes/cube.obj", body);
  SceneSpec scene = held_block();
  scene.bodies[0].surface = {};
  scene.bodies[0].surface_file = body;
  WorldOptions options = on("cpu", true);
  options.cutting = true;
  World world(scene, options);
  const auto cut = [&] {
    world.step(10);
    world.cut(wall(0.021));
    world.step(10);
    return world.hash();
  };
  const std::uint64_t hash = cut();
  EXPECT_EQ(world.pieces(0), 2);
  world.save(saved);
  std::filesystem::remove(body);
  world.reset();
  EXPECT_EQ(world.pieces(0), 1);
  EXPECT_EQ(cut(), hash);
  world.load(saved);
  EXPECT_EQ(world.hash(), hash);
  EXPECT_EQ(world.pieces(0), 2);
}

TEST(ApiCut, BadBladesAreRefusedAndChangeNothing) {
  World world(held_block(), on("cpu"));
  world.step(10);
  world.move_blade("b", {0.041, 0.2, -1}, {0.041, 0.2, 1});
  const std::uint64_t before = world.hash();
  const std::uint64_t version = world.frame()->topology_version;
  const double inf = INFINITY;
  EXPECT_EQ(code_of([&] { world.move_blade("b", {0.041, 0, 0}, {0.041, 0, 0}); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { world.move_blade("b", {NAN, 0, 0}, {0.041, 0, 0}); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { world.cut({{Vec3d{0, 0, inf}, {0, 1, 0}, {1, 0, 0}}}); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { world.lift_blade("none"); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { static_cast<void>(world.pieces(1)); }), ErrorCode::usage);
  EXPECT_NE(message_of([&] {
              world.move_blade("b", {0.041, 0, 0}, {0.041, 0, 0});
            }).find("two different points"),
            std::string::npos);
  EXPECT_EQ(world.cut({{Vec3d{0.04, 0, 0}, {0.04, 0, 0}, {0.04, 0, 0}}}).edges, 0) << "no area";
  EXPECT_EQ(world.cut({}).edges, 0);
  EXPECT_EQ(world.hash(), before);
  EXPECT_EQ(world.frame()->topology_version, version);
  EXPECT_TRUE(world.move_blade("b", {0.041, -0.2, -1}, {0.041, -0.2, 1}).changed) << "the blade is still where it was";
}

TEST(ApiCut, PreparingForCutsChangesNothing) {
  World plain(held_block(), on("cpu"));
  WorldOptions options = on("cpu");
  options.cutting = true;
  World prepared(held_block(), options);
  EXPECT_EQ(prepared.pieces(0), 1);
  EXPECT_EQ(prepared.frame()->topology_version, 1U);
  for (World* world : {&plain, &prepared}) {
    world->step(50);
    world->cut(wall(0.047));
    world->step(50);
  }
  EXPECT_EQ(plain.hash(), prepared.hash());
  EXPECT_EQ(plain.frame()->triangles.size(), prepared.frame()->triangles.size());
}

TEST(ApiCut, ASceneThatCannotBeCutSaysSoAndGoesOn) {
  const char* const text = R"({"format": "pliant-scene/1", "integrator": "textbook", "bodies": [{"surface": "memory:0",
    "lattice": {"spacing": 0.02}, "material": {"law": "neo-hookean", "young": 3000, "poisson": 0.4, "density": 1000}}]})";
  World world = World::parse(text, "", on("cpu"), {box_surface({0, 0, 0}, {0.1, 0.08, 0.06})});
  world.step(5);
  const std::uint64_t before = world.hash();
  EXPECT_EQ(code_of([&] { world.cut(wall(0.047)); }), ErrorCode::input);
  EXPECT_EQ(world.hash(), before);
  EXPECT_EQ(world.step(5).done, 5);
}

TEST(ApiCut, ADeviceLostWhileItIsCutLeavesTheLastFrame) {
  auto left = std::make_shared<std::atomic<int>>(1000000);
  const OpenBackend open = [left](std::string*, std::int64_t) {
    return std::make_unique<FaultyBackend>(open_backend("cpu"), left);
  };
  Scene scene = WorldAccess::simulation(*std::make_unique<World>(held_block(), on("cpu"))).scene();
  World world = WorldAccess::make(scene, open, on("cpu"));
  world.step(20);
  const std::size_t vertices = world.frame()->positions.size();
  left->store(0);
  EXPECT_EQ(code_of([&] { world.cut(wall(0.047)); }), ErrorCode::device);
  EXPECT_EQ(world.frame()->positions.size(), vertices);
  EXPECT_EQ(code_of([&] { world.cut(wall(0.047)); }), ErrorCode::device);
  left->store(1000000);
  world.reset();
  EXPECT_TRUE(world.cut(wall(0.047)).changed);
}

TEST(ApiCut, TheSameFromC) {
  const SurfaceSpec box = box_surface({0, 0, 0}, {0.1, 0.08, 0.06});
  const pliant_surface surface{sizeof(pliant_surface), box.vertices[0].data(), box.vertices.size(), box.triangles[0].data(),
                               box.triangles.size()};
  const char* const text = R"({"format": "pliant-scene/1", "bodies": [{"surface": "memory:0", "lattice": {"spacing": 0.02},
    "material": {"law": "neo-hookean", "young": 3000, "poisson": 0.4, "density": 1000}}]})";
  pliant_options options = PLIANT_OPTIONS_INIT;
  options.backend = "cpu";
  pliant_world world{};
  ASSERT_EQ(pliant_world_parse(text, nullptr, &surface, 1, &options, &world), PLIANT_OK) << pliant_last_error();
  const double high[2][3]{{0.041, 0.2, -1}, {0.041, 0.2, 1}}, low[2][3]{{0.041, -0.2, -1}, {0.041, -0.2, 1}};
  pliant_cut cut = PLIANT_CUT_INIT;
  EXPECT_EQ(pliant_world_move_blade(world, "b", high[0], high[1], nullptr), PLIANT_OK);
  EXPECT_EQ(pliant_world_move_blade(world, "b", low[0], low[1], &cut), PLIANT_OK) << pliant_last_error();
  EXPECT_EQ(cut.changed, 1);
  EXPECT_GT(cut.edges, 0);
  EXPECT_EQ(pliant_world_lift_blade(world, "b"), PLIANT_OK);
  const double wall_x[2][3][3]{{{0.073, -1, -1}, {0.073, 1, -1}, {0.073, 1, 1}},
                               {{0.073, -1, -1}, {0.073, 1, 1}, {0.073, -1, 1}}};
  EXPECT_EQ(pliant_world_cut(world, &wall_x[0][0][0], 2, &cut), PLIANT_OK);
  int64_t pieces = 0;
  EXPECT_EQ(pliant_world_pieces(world, 0, &pieces), PLIANT_OK);
  EXPECT_EQ(pieces, 3);
  pliant_frame frame = PLIANT_FRAME_INIT;
  ASSERT_EQ(pliant_world_frame(world, &frame), PLIANT_OK);
  ASSERT_NE(frame.cut_faces, nullptr);
  EXPECT_EQ(frame.body_vertices[0], 0U);
  EXPECT_EQ(frame.body_vertices[1], frame.vertex_count);
  EXPECT_EQ(frame.body_triangles[1], frame.triangle_count);
  std::vector<std::uint8_t> flags(frame.triangle_count);
  EXPECT_EQ(pliant_world_cut_faces(world, flags.data(), flags.size()), PLIANT_OK);
  EXPECT_EQ(std::memcmp(flags.data(), frame.cut_faces, flags.size()), 0);
  EXPECT_EQ(pliant_world_cut_faces(world, flags.data(), 3), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_move_blade(world, "b", low[0], low[0], &cut), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_move_blade(world, nullptr, low[0], low[1], &cut), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_move_blade(world, "b", nullptr, low[1], &cut), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_cut(world, nullptr, 2, &cut), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_lift_blade(world, "b"), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_pieces(world, 1, &pieces), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_destroy(world), PLIANT_OK);
  EXPECT_EQ(pliant_world_cut(world, &wall_x[0][0][0], 2, &cut), PLIANT_STATE);
}

}  // namespace
}  // namespace pliant::cut_test
