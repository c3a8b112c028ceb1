// A World computes what the schedule computes, and shows it.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "scene/spec.h"
#include "scenes.h"
#include "support/temp_folder.h"

namespace pliant {
namespace {

using test::block;
using test::on;

/// Steps of the bare schedule: batches of passes, without World.
void run_schedule(Simulation& simulation, std::int64_t steps) {
  while (simulation.step() < steps) {
    const std::int32_t n = simulation.next_batch(steps - simulation.step());
    simulation.begin_batch(n);
    simulation.run_steps(0, n);
    simulation.end_batch(n);
  }
}

class OnBackend : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    try {
      open_backend(GetParam());
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();
    }
  }
};

TEST_P(OnBackend, GivesTheBitsOfTheBareSchedule) {
  Simulation simulation(scene_of(block()), open_backend(GetParam()));
  run_schedule(simulation, 150);
  World whole(block(), on(GetParam())), pieces(block(), on(GetParam())), async(block(), on(GetParam()));
  EXPECT_EQ(whole.step(150).done, 150);
  for (const int n : {1, 0, 40, 100, 9}) pieces.step(n);
  ASSERT_TRUE(async.step_async(77));
  async.wait();
  ASSERT_TRUE(async.step_async(73));
  EXPECT_EQ(whole.hash(), simulation.hash());
  EXPECT_EQ(pieces.hash(), simulation.hash());
  EXPECT_EQ(async.hash(), simulation.hash());
  const auto surface = simulation.surface_positions();
  const FramePtr frame = async.frame();
  ASSERT_EQ(frame->positions.size(), surface.size());
  for (std::size_t v = 0; v < surface.size(); ++v) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(frame->positions[v][c], static_cast<float>(surface[v][c]));
  }
}

TEST_P(OnBackend, ForcesReservedButUnusedChangeNoBit) {
  World plain(block(), on(GetParam())), interactive(block(), on(GetParam(), true));
  plain.step(100);
  interactive.step(100);
  EXPECT_EQ(test::positions(plain), test::positions(interactive));
  EXPECT_EQ(plain.displacements(0), interactive.displacements(0));
}

INSTANTIATE_TEST_SUITE_P(Backends, OnBackend, ::testing::Values("cpu", "cpu:double", "opencl"), [](const auto& test_case) {
  std::string name = test_case.param;
  std::replace(name.begin(), name.end(), ':', '_');
  return name;
});

TEST(World, ReadsTheSameSceneFromCodeTextAndFile) {
  const std::vector<SurfaceSpec> surfaces{block().bodies[0].surface};
  const std::string text = scene_to_json(scene_of(block()));
  World code(block(), on("cpu")), parsed = World::parse(text, "", on("cpu"), surfaces);
  const test::TempFolder folder;
  (void)folder.write("box.obj", [&] {
    std::string obj;
    for (const auto& v : surfaces[0].vertices) {
      obj += "v " + std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) + "\n";
    }
    for (const auto& t : surfaces[0].triangles) {
      obj += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1) + "\n";
    }
    return obj;
  }());
  std::string on_disk = text;
  on_disk.replace(on_disk.find("memory:0"), 8, "box.obj");
  World file = World::open(folder.write("scene.json", on_disk).string(), on("cpu"));
  for (World* w : {&code, &parsed, &file}) w->step(20);
  EXPECT_EQ(code.hash(), parsed.hash());
  // assimp reads an OBJ in float, so only the topology must agree.
  EXPECT_EQ(code.info().nodes, file.info().nodes);
  EXPECT_EQ(code.info().bodies.at(0).name, "block");
  EXPECT_NEAR(code.info().bodies.at(0).mass, 1000 * 0.1 * 0.08 * 0.06, 1e-3);
}

TEST(World, TakesEveryLawFromCodeAndText) {
  for (const Law law : all_laws()) {
    const Material material = make_material(law, Moduli::from_bulk(1000, 9000));
    SceneSpec spec = block();
    spec.bodies[0].material.law = to_string(law);
    for (std::size_t i = 0; i < material.parameters.size(); ++i)
      spec.bodies[0].material.parameters[law_info(law).parameters[i].name] = material.parameters[i];
    const std::string text = scene_to_json(scene_of(spec));
    World code(spec, on("cpu")), parsed = World::parse(text, "", on("cpu"), {spec.bodies[0].surface});
    code.step(20);
    parsed.step(20);
    EXPECT_EQ(code.hash(), parsed.hash()) << to_string(law);
  }
}

TEST(World, TellsWhatAUserShouldKnowOfTheScene) {
  EXPECT_TRUE(World(block(), on("cpu")).info().remarks.empty());
  SceneSpec scene = block();
  auto& triangles = scene.bodies[0].surface.triangles;
  triangles.push_back(triangles[0]);     // doubled
  scene.bodies[0].material.density = 1;  // as of grams per cubic centimetre
  const std::vector<std::string> remarks = World(scene, on("cpu")).info().remarks;
  const auto tells = [&](const char* word) {
    return std::any_of(remarks.begin(), remarks.end(), [&](const std::string& r) { return r.find(word) != std::string::npos; });
  };
  EXPECT_TRUE(tells("body 'block': ")) << "of its surface";
  EXPECT_TRUE(tells("kg/m^3")) << "of its density";
}

TEST(World, FramesStayAsTheyAreAndOutliveTheWorld) {
  FramePtr first, later;
  std::vector<Vec4f> copy;
  {
    World world(block(), on("cpu"));
    first = world.frame();
    copy.assign(first->positions.begin(), first->positions.end());
    EXPECT_FALSE(world.poll());
    for (int i = 0; i < 12; ++i) {
      world.step(5);
      EXPECT_TRUE(world.poll());
      later = world.frame();
      EXPECT_FALSE(world.poll());
      EXPECT_EQ(later->step, world.step_number());
    }
    EXPECT_EQ(world.frame(), later);
  }
  EXPECT_TRUE(std::equal(copy.begin(), copy.end(), first->positions.begin()));
  EXPECT_FALSE(std::equal(copy.begin(), copy.end(), later->positions.begin()));
  EXPECT_EQ(first->step, 0);
  EXPECT_EQ(later->step, 60);
  EXPECT_EQ(later->topology_version, first->topology_version);
}

TEST(World, DirtyRangesHoldWhatChanged) {
  // Two bodies, of which the second one rests: nothing pulls it.
  SceneSpec scene = block();
  scene.gravity = {};
  BodySpec still = block(0).bodies[0];
  still.name = "still";
  still.translate = {0.3, 0, 0};
  scene.bodies.push_back(still);
  World world(scene, on("cpu"));
  FramePtr frame = world.frame();
  EXPECT_EQ(frame->dirty_vertices.count, frame->positions.size());
  EXPECT_EQ(frame->dirty_triangles.count, frame->triangles.size());
  for (int i = 0; i < 3; ++i) {  // the middle ones are read, and not asked for
    ASSERT_TRUE(world.step_async(20));
    world.wait();
  }
  const FramePtr next = world.frame();
  const IndexRange moved = world.info().bodies.at(0).vertices;
  EXPECT_GE(next->dirty_vertices.first, moved.first);
  EXPECT_GT(next->dirty_vertices.count, 0U);
  EXPECT_LE(next->dirty_vertices.first + next->dirty_vertices.count, moved.first + moved.count);
  EXPECT_EQ(next->dirty_triangles.count, 0U);
  for (std::size_t v = 0; v < next->positions.size(); ++v) {
    const bool dirty = v - next->dirty_vertices.first < next->dirty_vertices.count;
    EXPECT_TRUE(dirty || next->positions[v] == frame->positions[v]) << v;
  }
}

TEST(World, NormalsPointOutwardAndCanBeLeftOut) {
  World world(block(), on("cpu"));
  const FramePtr frame = world.frame();
  ASSERT_EQ(frame->normals.size(), frame->positions.size());
  for (std::size_t v = 0; v < frame->normals.size(); ++v) {
    const Vec4f &n = frame->normals[v], &x = frame->positions[v];
    EXPECT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-5);
    EXPECT_GT(n[0] * (x[0] - 0.05F) + n[1] * (x[1] - 0.04F) + n[2] * (x[2] - 0.03F), 0);
  }
  WorldOptions without = on("cpu");
  without.normals = false;
  EXPECT_TRUE(World(block(), without).frame()->normals.empty());
}

TEST(World, AFrameDoesNotWaitForTheWorker) {
  World world(block(), on("cpu"));
  const FramePtr before = world.frame();
  ASSERT_TRUE(world.step_async(20000));
  EXPECT_TRUE(world.busy());
  EXPECT_FALSE(world.step_async(1));
  EXPECT_EQ(world.frame(), before);
  EXPECT_FALSE(world.poll());
  EXPECT_EQ(world.wait().step, 20000);
  EXPECT_FALSE(world.busy());
  EXPECT_TRUE(world.poll());
  EXPECT_EQ(world.frame()->step, 20000);
}

TEST(World, IsDestroyedWhileItsWorkerIsBusy) {
  World world(block(), on("cpu"));
  ASSERT_TRUE(world.step_async(1000000000));
}

TEST(World, AdvancesBySecondsAndKeepsTheRest) {
  World world(block(), on("cpu"));
  for (int i = 0; i < 30; ++i) world.advance(1.0 / 60);
  EXPECT_NEAR(world.time(), 0.5, 1.01 * world.dt());
}

TEST(World, CheckpointsAndResets) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "state.pckpt").string();
  World world(block(), on("cpu")), other(block(), on("cpu"));
  const std::uint64_t start = world.hash();
  world.step(70);
  world.save(file);
  world.step(50);
  other.load(file);
  EXPECT_EQ(other.step_number(), 70);
  EXPECT_EQ(other.frame()->step, 70);
  other.step(50);
  EXPECT_EQ(other.hash(), world.hash());
  world.reset();
  EXPECT_EQ(world.step_number(), 0);
  EXPECT_EQ(world.hash(), start);
}

/// What `threads` worlds give that run at the same time.
std::vector<std::uint64_t> hashes(bool together) {
  std::vector<std::uint64_t> result(2);
  const auto run = [&](std::size_t i) {
    World world(block(i == 0 ? 0.5 : 0.2), on("cpu", i == 1));
    for (int k = 0; k < 10; ++k) {
      world.step_async(15);
      world.wait();
      if (i == 1) world.push(6, {0.01 * k, 0, 0});
    }
    result[i] = world.hash();
  };
  if (together) {
    std::thread a(run, 0), b(run, 1);
    a.join();
    b.join();
  } else {
    run(0);
    run(1);
  }
  return result;
}

TEST(World, TwoThreadsGiveTheBitsOfOneAfterTheOther) {
  const auto one_by_one = hashes(false);
  EXPECT_NE(one_by_one[0], one_by_one[1]);
  for (int repeat = 0; repeat < 3; ++repeat) EXPECT_EQ(hashes(true), one_by_one);
}

}  // namespace
}  // namespace pliant
