// Mesh tools whose shape the host changes while a World runs.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "c_world.h"
#include "geometry/mesh.h"
#include "scenes.h"
#include "support/temp_folder.h"
#include "support/unit_ball.h"

namespace pliant {
namespace {

using test::code_of;
using test::message_of;
using test::on;

constexpr double kRadius = 0.012, kFrame = 1.0 / 60;

/// A ball of exact volume, of `around` meridians about an axis that leans by `lean` [rad].
SurfaceSpec ball_surface(int around, double lean = 0, const Vec3d& at = {}, double radius = kRadius) {
  TriangleMesh mesh = test::unit_ball(around);
  for (Vec3d& v : mesh.vertices) {
    const double y = std::cos(lean) * v[1] - std::sin(lean) * v[2], z = std::sin(lean) * v[1] + std::cos(lean) * v[2];
    v = {at[0] + radius * v[0], at[1] + radius * y, at[2] + radius * z};
  }
  return {std::move(mesh.vertices), std::move(mesh.triangles)};
}

/// A block of 80 x 80 x 40 mm, held at its foot, its top at z = 0, and a tool above it.
SceneSpec block_under(const ToolSpec& tool, double spacing = 0.01) {
  SceneSpec scene;
  BodySpec& body = scene.bodies.emplace_back();
  body.name = "block";
  body.surface = box_surface({-0.04, -0.04, -0.04}, {0.04, 0.04, 0});
  body.lattice_spacing = spacing;
  body.material.young = 1e4;
  body.material.damping = 100;
  body.fixed = {{RegionSpec::box({-1, -1, -0.0401}, {1, 1, -0.0399}), "xyz"}};
  scene.tools = {tool};
  scene.dt = 5e-4;
  return scene;
}

std::string written(const test::TempFolder& folder, const SurfaceSpec& surface) {
  const std::string file = (folder.path() / "ball.obj").string();
  std::ofstream out(file);
  out.precision(12);
  for (const Vec3d& v : surface.vertices) out << "v " << v[0] << ' ' << v[1] << ' ' << v[2] << '\n';
  for (const auto& t : surface.triangles) out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  return file;
}

/// A ball at the origin of its frame, 0.5 mm above the block.
ToolSpec mesh_ball(const test::TempFolder& folder) {
  ToolSpec tool;
  tool.name = "ball";
  tool.shape = "mesh";
  tool.mesh = written(folder, ball_surface(48));
  tool.friction = 0.3;
  tool.path = {{0, 0, 0, kRadius + 0.0005, 0, 0, 0, 1}};
  return tool;
}

/// Where the ball is in its frame: down by 4 mm in a quarter of a second, then aside.
Vec3d path(double t) { return {0.04 * std::max(0.0, t - 0.25), 0, -0.004 * std::min(1.0, t / 0.25)}; }

/// The mean force [N] of 30 ms before each frame of a run of 30 frames, every frame of other triangles.
template <class Move>
std::vector<Vec3d> felt(World& world, const Move& move) {
  std::vector<Vec3d> all;
  for (int f = 1; f <= 30; ++f) {
    move(f);
    Vec3d sum{};
    int steps = 0;
    while (world.time() < f * kFrame - 1e-9) {
      world.step(1);
      ++steps;
      for (std::size_t c = 0; c < 3; ++c) sum[c] += world.tool_forces()[0].force[c];
    }
    for (double& c : sum) c /= steps;
    all.push_back(sum);
  }
  return all;
}

void give(World& world, int f) {
  world.set_tool_mesh("ball", ball_surface(36 + 4 * (f % 5), 0.7 * f, path(f * kFrame)), f * kFrame);
}

TEST(ToolMesh, AMovingBallFeelsWhatTheBallFeels) {
  const test::TempFolder folder;
  ToolSpec exact;
  exact.name = "ball";
  exact.radius = kRadius;
  exact.friction = 0.3;
  exact.path = {{0, 0, 0, kRadius + 0.0005, 0, 0, 0, 1}};
  World ball(block_under(exact, 0.005), on("cpu")), grid(block_under(mesh_ball(folder), 0.005), on("cpu")),
      given(block_under(mesh_ball(folder), 0.005), on("cpu"));
  const auto drive = [](World& w, int f) {
    const Vec3d to = path(f * kFrame);
    w.drive_tool("ball", {to[0], to[1], to[2] + kRadius + 0.0005}, {0, 0, 0, 1}, f * kFrame - w.time());
  };
  const std::vector<Vec3d> a = felt(ball, [&](int f) { drive(ball, f); }), b = felt(grid, [&](int f) { drive(grid, f); }),
                           c = felt(given, [&](int f) { give(given, f); });
  double most = 0;
  for (const Vec3d& f : a) most = std::max(most, std::sqrt(f[0] * f[0] + f[2] * f[2]));
  ASSERT_GT(most, 0.5);
  // Friction depends on when points of the tissue begin to slip, and so on the facets of the meshes.
  const Vec3d bound{0.015 * most, 0.015 * most, 0.01 * most};
  for (std::size_t f = 0; f < a.size(); ++f) {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(b[f][i], a[f][i], bound[i]) << "grid, frame " << f << ", axis " << i;
      EXPECT_NEAR(c[f][i], a[f][i], bound[i]) << "given, frame " << f << ", axis " << i;
    }
  }
  EXPECT_GT(std::abs(c.back()[0]), 0.05 * most);  // it rubs
}

TEST(ToolMesh, OtherTrianglesOfTheSameShapeAreNotFelt) {
  const test::TempFolder folder;
  World world(block_under(mesh_ball(folder), 0.005), on("cpu"));
  world.drive_tool("ball", {0, 0, kRadius - 0.003}, {0, 0, 0, 1}, 0.1);
  world.advance(0.4);
  const double before = world.tool_forces()[0].force[2];
  ASSERT_GT(before, 0.3);
  double impulse = 0;  // of what differs
  for (int f = 0; f < 6; ++f) {
    world.set_tool_mesh("ball", ball_surface(f % 2 == 0 ? 64 : 36, f), world.time() + kFrame);
    for (int s = 0; s < 33; ++s) {
      world.step(1);
      const double now = world.tool_forces()[0].force[2];
      EXPECT_NEAR(now, before, 0.02 * before);
      impulse += (now - before) * world.dt();
    }
  }
  EXPECT_LT(std::abs(impulse), 0.005 * before * 0.1);
}

TEST(ToolMesh, BitsAreTheSameAfterACheckpointAndOnAllBackends) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "mesh.pckpt").string();
  const SceneSpec scene = block_under(mesh_ball(folder));
  const auto run = [&](World& world, int from, int to) {
    for (int f = from; f < to; ++f) {
      world.set_tool_mesh("ball", ball_surface(40 + f, f, path(f * kFrame), f < 10 ? kRadius : 1.3 * kRadius), f * kFrame);
      if (f % 2 == 0) world.advance((f - 0.5) * kFrame - world.time());  // several are to come
    }
  };
  World whole(scene, on("cpu"));
  run(whole, 1, 9);
  whole.save(file);
  run(whole, 9, 16);
  ASSERT_GT(whole.tool_forces()[0].force[2], 0.1);
  for (const std::string& backend : test::float_backends()) {
    World other(scene, on(backend)), resumed(scene, on(backend));
    run(other, 1, 16);
    resumed.load(file);
    run(resumed, 9, 16);
    for (World* w : {&other, &resumed}) {
      EXPECT_EQ(whole.hash(), w->hash()) << backend;
      EXPECT_EQ(whole.tool_forces()[0].force, w->tool_forces()[0].force) << backend;
    }
    EXPECT_EQ(WorldAccess::simulation(whole).deep_hash(), WorldAccess::simulation(resumed).deep_hash()) << backend;
  }
}

TEST(ToolMesh, AGridThatIsLaidAnewAfterACheckpointIsTheSame) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "mesh.pckpt").string();
  World whole(block_under(mesh_ball(folder)), on("cpu")), resumed(block_under(mesh_ball(folder)), on("cpu"));
  const auto run = [](World& world, int from, int to) {
    for (int f = from; f < to; ++f) {  // every third is longer than the grid, along another axis
      SurfaceSpec mesh = ball_surface(30 + f % 5, f, {}, 0.7 * kRadius);
      for (Vec3d& v : mesh.vertices) v[static_cast<std::size_t>(f) / 3 % 3] *= f % 3 == 1 ? 2 + 0.1 * f : 1;
      world.set_tool_mesh("ball", mesh, world.time() + kFrame);
      world.step(37);
    }
  };
  whole.drive_tool("ball", {0, 0, 0.4 * kRadius}, {0, 0, 0, 1}, 0.05);
  for (int k = 1; k <= 3; ++k) whole.set_tool_mesh("ball", ball_surface(20, k, {}, 0.7 * kRadius), k * kFrame);
  EXPECT_EQ(code_of([&] { whole.set_tool_mesh("ball", ball_surface(40, 1, {}, 3 * kRadius), 1); }), ErrorCode::usage);
  whole.step(150);
  run(whole, 1, 4);
  whole.save(file);
  resumed.load(file);
  for (World* w : {&whole, &resumed}) run(*w, 4, 16);
  ASSERT_GT(whole.tool_forces()[0].force[2], 0.01);
  EXPECT_EQ(whole.hash(), resumed.hash());
  EXPECT_EQ(WorldAccess::simulation(whole).deep_hash(), WorldAccess::simulation(resumed).deep_hash());
}

TEST(ToolMesh, TheCheckingBackendFindsNothing) {
  const test::TempFolder folder;
  World checked(block_under(mesh_ball(folder)), on("cpu:check")), plain(block_under(mesh_ball(folder)), on("cpu"));
  for (World* w : {&checked, &plain}) {
    w->drive_tool("ball", {0, 0, kRadius - 0.001}, {0, 0, 0, 1}, 0.01);
    for (int f = 1; f <= 2; ++f) w->set_tool_mesh("ball", ball_surface(30 + f, f), 0.01 * f);
    w->step(30);
  }
  ASSERT_GT(plain.tool_forces()[0].force[2], 0.01);
  EXPECT_EQ(checked.hash(), plain.hash());
}

TEST(ToolMesh, CutsAndCheckpointsKeepTheShape) {
  const test::TempFolder folder;
  const std::string early = (folder.path() / "early.pckpt").string(), late = (folder.path() / "late.pckpt").string();
  const SceneSpec scene = block_under(mesh_ball(folder));
  WorldOptions options = on("cpu");
  options.cutting = true;
  World world(scene, options), other(scene, options);
  world.save(early);
  for (int f = 1; f <= 10; ++f) {
    give(world, f);
    world.advance(f * kFrame - world.time());
  }
  const Vec3d before = world.tool_forces()[0].force;
  ASSERT_GT(before[2], 0.1);
  EXPECT_GT(world.cut({{{{-0.021, -0.1, 0.1}, {-0.021, 0.1, 0.1}, {-0.021, 0, -0.1}}}}).edges, 0);
  world.step(20);
  EXPECT_GT(world.tool_forces()[0].force[2], 0.3 * before[2]);  // the surface of the file would not touch
  world.save(late);
  give(other, 3);  // forgotten by load()
  other.load(late);
  for (World* w : {&world, &other}) {
    give(*w, 12);
    w->step(60);
  }
  EXPECT_EQ(world.hash(), other.hash());
  other.load(early);
  EXPECT_EQ(other.tool_surface("ball").vertices.size(), ball_surface(48).vertices.size());
}

TEST(ToolMesh, WhatIsNotUsedCostsNoBit) {
  const test::TempFolder folder;
  World plain(block_under(mesh_ball(folder)), on("cpu")), parked(block_under(mesh_ball(folder)), on("cpu"));
  for (World* w : {&plain, &parked}) w->park_tool("ball");
  give(parked, 1);
  for (World* w : {&plain, &parked}) w->step(100);
  EXPECT_EQ(plain.hash(), parked.hash());
  give(parked, 4);
  parked.unpark_tool("ball");
  parked.advance(0.3);
  const SurfaceSpec now = parked.tool_surface("ball"), end = ball_surface(36 + 4 * 4, 0.7 * 4, path(4 * kFrame));
  ASSERT_EQ(now.vertices.size(), end.vertices.size());
  for (std::size_t v = 0; v < now.vertices.size(); ++v) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(now.vertices[v][c], end.vertices[v][c], 1e-9);
  }
  parked.remove_tool("ball");
  EXPECT_EQ(code_of([&] { give(parked, 60); }), ErrorCode::usage);
  parked.add_tool(mesh_ball(folder));
  give(parked, 60);  // from the file's surface again
  parked.reset();
  EXPECT_EQ(parked.tool_surface("ball").vertices.size(), ball_surface(48).vertices.size());
  give(parked, 1);
  parked.step(10);
}

TEST(ToolMesh, BesideAWorkerALateSurfaceIsReachedLater) {
  const test::TempFolder folder;
  World world(block_under(mesh_ball(folder)), on("cpu"));
  for (int f = 1; f <= 20; ++f) {
    give(world, f);
    ASSERT_TRUE(world.advance_async(kFrame));
    world.wait();
  }
  ASSERT_TRUE(world.step_async(2000));
  for (int f = 21; f <= 23; ++f) give(world, f);  // in the past before the worker sees them, or soon
  world.wait();
  ASSERT_TRUE(world.step_async(200));
  world.wait();
  const SurfaceSpec now = world.tool_surface("ball"), end = ball_surface(36 + 4 * 3, 0.7 * 23, path(23 * kFrame));
  ASSERT_EQ(now.vertices.size(), end.vertices.size());
  EXPECT_NEAR(now.vertices[5][0], end.vertices[5][0], 1e-9);
}

TEST(ToolMesh, BadSurfacesChangeNothing) {
  const test::TempFolder folder;
  ToolSpec sphere, edged = mesh_ball(folder);
  sphere.name = "sphere";
  sphere.path = {{0, 0, 0, 0.05, 0, 0, 0, 1}};
  edged.name = "edged";
  edged.edges = true;
  edged.path[0][3] = 0.08;
  SceneSpec scene = block_under(mesh_ball(folder));
  scene.tools.insert(scene.tools.end(), {sphere, edged});
  World world(scene, on("cpu"));
  world.step(20);
  const std::uint64_t hash = world.hash();
  const auto refused = [&](SurfaceSpec surface, double time, const std::string& part, const char* tool = "ball") {
    const std::string message = message_of([&] { world.set_tool_mesh(tool, surface, time); });
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_NE(message.find("expected"), std::string::npos) << message;
  };
  SurfaceSpec open = ball_surface(20), wild = open, wrong = open, flat = open;
  open.triangles.pop_back();
  refused(open, 1, "3 open edges");
  wild.vertices[3][1] = std::numeric_limits<double>::quiet_NaN();
  refused(wild, 1, "has a vertex [");
  wrong.triangles[2][1] = 100000;
  refused(wrong, 1, "vertex 100000 of");
  for (Vec3d& v : flat.vertices) v[2] = 0;
  refused(flat, 1, "encloses no volume");
  refused({}, 1, "has no triangles");
  refused(ball_surface(20), 0.005, "at 0.01 s");
  refused(ball_surface(20), std::numeric_limits<double>::infinity(), "times that rise");
  refused(ball_surface(20), 1, "is no mesh", "sphere");
  refused(ball_surface(20), 1, "has edges", "edged");
  EXPECT_EQ(code_of([&] { world.set_tool_mesh("bell", ball_surface(20), 1); }), ErrorCode::usage);
  EXPECT_EQ(world.hash(), hash);
  for (int f = 1; f <= 3; ++f) world.set_tool_mesh("ball", ball_surface(20), 0.1 * f);
  refused(ball_surface(20), 0.25, "after one for 0.3");
  refused(ball_surface(20), 0.4, "3 surfaces are still to come");
  world.advance(0.12);
  world.set_tool_mesh("ball", ball_surface(20), 0.5);  // one of them is over
  SurfaceSpec inverted = ball_surface(24);
  for (auto& t : inverted.triangles) std::swap(t[0], t[1]);
  world.advance(0.1);
  world.set_tool_mesh("ball", inverted, 0.6);  // turned outward
  world.advance(0.5);
  const SurfaceSpec now = world.tool_surface("ball");
  EXPECT_GT(signed_volume({now.vertices, now.triangles}), 0);
}

TEST(ToolMesh, InC) {
  const test::TempFolder folder;
  (void)written(folder, ball_surface(32));
  const char* const text = R"({"format": "pliant-scene/1", "bodies": [{"name": "block", "surface": "memory:0",
    "lattice": {"spacing": 0.01}, "material": {"young": 1e4, "poisson": 0.4}}], "tools": [{"name": "ball",
    "shape": {"mesh": "ball.obj"}, "path": [[0, 0, 0, 0.02]]}]})";
  const SurfaceSpec box = box_surface({-0.04, -0.04, -0.04}, {0.04, 0.04, 0});
  const pliant_surface block = test::c_surface(box);
  pliant_options options = PLIANT_OPTIONS_INIT;
  options.backend = "cpu";
  pliant_world world{};
  ASSERT_EQ(pliant_world_parse(text, folder.path().string().c_str(), &block, 1, &options, &world), PLIANT_OK)
      << pliant_last_error();
  const SurfaceSpec next = ball_surface(28, 0.3);
  pliant_surface surface = test::c_surface(next);
  ASSERT_EQ(pliant_world_set_tool_mesh(world, "ball", &surface, 0.01), PLIANT_OK) << pliant_last_error();
  EXPECT_EQ(pliant_world_set_tool_mesh(world, "ball", nullptr, 0.02), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_set_tool_mesh(world, nullptr, &surface, 0.02), PLIANT_USAGE);
  surface.vertices = nullptr;
  EXPECT_EQ(pliant_world_set_tool_mesh(world, "ball", &surface, 0.02), PLIANT_USAGE);
  pliant_world_destroy(world);
}

}  // namespace
}  // namespace pliant
