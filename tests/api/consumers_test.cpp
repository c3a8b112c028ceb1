// Several consumers of one World's frames, each with ranges of its own; and time that is asked for in seconds, frame by frame.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "api/scenes.h"
#include "pliant/c/pliant.h"

namespace pliant {
namespace {

using namespace test;

/// What a renderer has uploaded: it writes dirty ranges and nothing else.
struct Upload {
  std::vector<Vec4f> positions, normals;
  std::vector<Triangle> triangles;
  std::vector<std::uint8_t> cut_faces;

  void take(const Frame& f, const IndexRange& vertices, const IndexRange& faces) {
    positions.resize(f.positions.size());
    normals.resize(f.normals.size());
    triangles.resize(f.triangles.size());
    cut_faces.resize(f.triangles.size());
    for (std::size_t v = vertices.first; v < vertices.first + vertices.count; ++v) {
      positions[v] = f.positions[v];
      normals[v] = f.normals[v];
    }
    for (std::size_t t = faces.first; t < faces.first + faces.count; ++t) {
      triangles[t] = f.triangles[t];
      cut_faces[t] = f.cut_faces.empty() ? 0 : f.cut_faces[t];
    }
  }
  void expect(const Frame& f, const char* who, int at) const {
    EXPECT_TRUE(std::equal(positions.begin(), positions.end(), f.positions.begin(), f.positions.end())) << who << " " << at;
    EXPECT_TRUE(std::equal(normals.begin(), normals.end(), f.normals.begin(), f.normals.end())) << who << " " << at;
    EXPECT_TRUE(std::equal(triangles.begin(), triangles.end(), f.triangles.begin(), f.triangles.end())) << who << " " << at;
    for (std::size_t t = 0; t < f.cut_faces.size(); ++t) ASSERT_EQ(cut_faces[t], f.cut_faces[t]) << who << " " << at;
  }
};

/// One of those that ask by frame_since.
struct Consumer {
  const char* name;
  int every;
  FramePtr seen;
  Upload upload;
  std::size_t most = 0;  ///< vertices that were dirty at once, after the first time

  void look(World& world, int at) {
    const FrameChange change = world.frame_since(seen);
    if (seen != nullptr) most = std::max(most, change.dirty_vertices.count);
    seen = change.frame;
    upload.take(*seen, change.dirty_vertices, change.dirty_triangles);
    upload.expect(*seen, name, at);
  }
};

/// A block that hangs from its lower x face, and one behind it that nothing moves.
SceneSpec two_blocks() {
  SceneSpec scene = block(0);
  scene.gravity = {};
  scene.bodies[0].fixed = {{RegionSpec::plane({0.001, 0, 0}, {-1, 0, 0})}};
  scene.bodies.push_back(scene.bodies[0]);
  scene.bodies[1].name = "still";
  scene.bodies[1].translate = {1, 0, 0};
  scene.bodies[1].fixed = {{RegionSpec::all()}};
  scene.bodies[0].forces.push_back({RegionSpec::plane({0.09, 0, 0}, {1, 0, 0}), {0, -0.1, 0}, {"smooth", 0, 0.1, {}}});
  return scene;
}

std::vector<std::array<Vec3d, 3>> wall(double at) {
  const Vec3d a{at, -1, -1}, b{at, 1, -1}, c{at, 1, 1}, d{at, -1, 1};
  return {{a, b, c}, {a, c, d}};
}

TEST(Consumers, EachKeepsUpWithItsOwnRangesThroughCuts) {
  SceneSpec scene = two_blocks();
  scene.bodies.push_back(
      scene.bodies[1]);  // one that moves early on, and not between the last two frames before somebody looks
  BodySpec& early = scene.bodies[2];
  early.name = "early";
  early.fixed.clear();
  early.prescribed = {{RegionSpec::all(), {0.01, 0.0, 0.0}, {"ramp", 0, 52 * World(two_blocks(), on("cpu")).dt(), {}}}};
  World world(scene, on("cpu"));
  Consumer fast{"fast", 1, {}, {}}, slow{"slow", 4, {}, {}};
  Upload polled;
  for (int i = 0; i < 24; ++i) {
    ASSERT_TRUE(world.step_async(15));
    if (i == 6 || i == 13) world.cut(wall(i == 6 ? 0.073 : 0.047));
    world.wait();
    if (i == 20) world.reset();  // fewer vertices than before
    for (Consumer* c : {&fast, &slow}) {
      if (i % c->every == 0) c->look(world, i);
    }
    if (i % 3 != 2) continue;
    EXPECT_TRUE(world.poll()) << "the others have not taken it away";
    const FramePtr frame = world.frame();
    EXPECT_FALSE(world.poll());
    polled.take(*frame, frame->dirty_vertices, frame->dirty_triangles);
    polled.expect(*frame, "polled", i);
  }
  const IndexRange still = world.info().bodies[1].vertices;
  EXPECT_EQ(slow.seen->topology_version, 4U);
  EXPECT_EQ(fast.seen->topology_version, 4U);
  EXPECT_GT(slow.most, still.first);
}

TEST(Consumers, NothingIsDirtyForWhoHasSeenItAll) {
  World world(two_blocks(), on("cpu"));
  const FrameChange first = world.frame_since(nullptr);
  EXPECT_EQ(first.dirty_vertices.count, first.frame->positions.size());
  EXPECT_EQ(first.dirty_triangles.count, first.frame->triangles.size());
  EXPECT_EQ(first.frame->dirty_vertices.count, 0U);
  const FrameChange again = world.frame_since(first.frame);
  EXPECT_EQ(again.frame, first.frame);
  EXPECT_EQ(again.dirty_vertices.count + again.dirty_triangles.count, 0U);
  const FrameChange of_frame = world.frame_since(world.frame());
  EXPECT_EQ(of_frame.dirty_vertices.count + of_frame.dirty_triangles.count, 0U);
  world.step(30);
  const IndexRange moving = world.info().bodies[0].vertices;
  for (int i = 0; i < 2; ++i) {  // as often as one asks
    const FrameChange moved = world.frame_since(first.frame);
    EXPECT_GT(moved.dirty_vertices.count, 0U);
    EXPECT_LE(moved.dirty_vertices.first + moved.dirty_vertices.count, moving.first + moving.count);
    EXPECT_EQ(moved.dirty_triangles.count, 0U);
  }
  SceneSpec elsewhere = block();
  elsewhere.bodies[0].translate = {0, 0, 5};
  World other(elsewhere, on("cpu"));  // a frame of another world is compared like any other
  EXPECT_EQ(other.frame_since(first.frame).dirty_vertices.count, 8U);
}

TEST(Consumers, VerticesAreThoseOfTheFrameHandedOutLast) {
  World world(two_blocks(), on("cpu", true));
  const FramePtr before = world.frame_since(nullptr).frame;
  const std::int32_t last = static_cast<std::int32_t>(before->positions.size()) - 1;
  world.cut(wall(0.047));
  ASSERT_TRUE(world.step_async(5));
  world.wait();  // there is a frame of the cut, and nobody has it
  EXPECT_NO_THROW(world.push(last, {0, 0, 0}));
  EXPECT_EQ(code_of([&] { world.push(last + 1, {0, 0, 0}); }), ErrorCode::usage);
  const FramePtr after = world.frame_since(before).frame;
  EXPECT_GT(after->positions.size(), before->positions.size());
  EXPECT_NO_THROW(world.push(last + 1, {0, 0, 0}));
}

// --- seconds
// -------------------------------------------------------------------------------------------------------------------

/// A few cells, so that ten minutes are short.
SceneSpec few_cells(double push) {
  SceneSpec scene = block(push);
  scene.bodies[0].lattice_spacing = 0.05;
  return scene;
}

/// What the world's clock may be behind what was asked for: less than a step, and never ahead by more than rounding.
void expect_on_time(const World& world, double asked) {
  EXPECT_LT(asked - world.time(), world.dt() * (1 + 1e-5)) << "asked for " << asked;
  EXPECT_GT(asked - world.time(), -1e-5 * world.dt()) << "asked for " << asked;
}

TEST(Seconds, TenMinutesOfFramesAreTenMinutes) {
  World world(few_cells(0.2), on("cpu"));
  std::int64_t steps = 0;
  for (int i = 1; i <= 36000; ++i) {
    ASSERT_TRUE(world.advance_async(1.0 / 60));
    steps += world.wait().done;
    if (i % 3000 == 0) expect_on_time(world, i / 60.0);
  }
  EXPECT_EQ(steps, world.step_number());
  EXPECT_GT(steps, 36000);
}

TEST(Seconds, FramesShorterThanAStepAddUp) {
  World world(few_cells(0.2), on("cpu"));
  const double frame = 0.3 * world.dt();
  int without = 0;
  for (int i = 1; i <= 3000; ++i) {
    ASSERT_TRUE(world.advance_async(frame));
    without += world.wait().done == 0 ? 1 : 0;
    if (i % 100 == 0) expect_on_time(world, i * frame);
  }
  EXPECT_GT(without, 1900);
}

TEST(Seconds, AStepThatChangesOnTheWayLosesNothing) {
  SceneSpec scene = few_cells(0);
  scene.bodies[0].prescribed.push_back(  // pressed together and let go again
      {RegionSpec::plane({0, 0.079, 0}, {0, 1, 0}),
       {std::nullopt, -0.05, std::nullopt},
       {"table", 0, 1, {{0, 0}, {0.5, 1}, {1, 0}, {1.5, 1}, {2, 0}, {2.5, 1}, {3, 0}}}});
  World world(scene, on("cpu"));
  std::set<double> steps;
  for (int i = 1; i <= 400; ++i) {
    ASSERT_TRUE(world.advance_async(0.01));
    const StepReport report = world.wait();
    ASSERT_FALSE(report.diverged) << report.message;
    steps.insert(report.dt);
    expect_on_time(world, i * 0.01);
  }
  EXPECT_GE(steps.size(), 3U) << "the scene is there to change its step";
}

TEST(Seconds, WhatIsRefusedWhileTheWorkerIsBusyIsTheCallersToKeep) {
  World world(few_cells(0.2), on("cpu"));
  double due = 0;
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    due += 0.05;
    if (world.advance_async(due)) {
      due = 0;
    } else {
      ++refused;
    }
  }
  world.wait();
  EXPECT_GT(refused, 0);
  expect_on_time(world, 400 * 0.05 - due);
  world.advance(due);
  expect_on_time(world, 400 * 0.05);
  EXPECT_EQ(code_of([&] { world.advance_async(-1.0); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { world.advance_async(std::nan("")); }), ErrorCode::usage);
}

TEST(Seconds, TheDestructorStopsThem) {
  World world(few_cells(0.2), on("cpu"));
  ASSERT_TRUE(world.advance_async(1e7));
}

template <class T>
concept AdvancesBy = requires(World world, T amount) {
  world.advance_async(amount);
};
static_assert(AdvancesBy<double> && AdvancesBy<float> && !AdvancesBy<int> && !AdvancesBy<std::int64_t>,
              "a count of steps must not pass for seconds");

}  // namespace
}  // namespace pliant
