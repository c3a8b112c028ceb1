// What edits patch is what a fresh start builds, bit for bit: bodies, models, programs and the buffers of both backends.
#include <gtest/gtest.h>

#include <cstring>

#include "cutting/cut_bodies.h"
#include "cutting/cut_body.h"
#include "cutting/cut_scenes.h"
#include "io/save.h"
#include "pliant/error.h"
#include "simulation/state/compare.h"
#include "solver/scenes.h"
#include "support/forwarding_backend.h"

namespace pliant {
namespace {

using namespace cut_test;

std::vector<SweepTriangle> random_cut(std::mt19937& random, const Vec3d& size) {
  std::uniform_real_distribution<double> real(-1, 1);
  const Vec3d point{size[0] * 0.5 * (1 + real(random)), size[1] * 0.5 * (1 + real(random)), size[2] * 0.5 * (1 + real(random))};
  return plane_cut(point, {real(random), real(random), real(random)}, 0.02 + 0.1 * std::abs(real(random)));
}

void expect_same_programs(const Program& a, const Program& b) {
  ASSERT_EQ(a.buffers.size(), b.buffers.size());
  for (std::size_t i = 0; i < a.buffers.size(); ++i) {
    const Buffer &p = a.buffers[i], &q = b.buffers[i];
    ASSERT_EQ(p.name, q.name);
    ASSERT_EQ(p.count, q.count) << p.name;
    ASSERT_EQ(p.ints, q.ints) << p.name;
    ASSERT_EQ(p.reals.size(), q.reals.size()) << p.name;
    if (p.reals.empty()) continue;
    EXPECT_EQ(std::memcmp(p.reals.data(), q.reals.data(), p.reals.size() * sizeof(double)), 0) << p.name;
  }
}

void expect_patched_as_fresh(const Scene& scene, const char* backend, const Vec3d& size) {
  SimulationOptions options;
  options.dt = 2e-4;
  Simulation s(scene, open_backend(backend), options);
  std::mt19937 random(11);
  for (int k = 0; k < 6; ++k) {
    s.advance(3);
    s.cut(random_cut(random, size));
    if (k % 2 == 0) continue;
    Simulation fresh(scene, open_backend(backend), options);
    restore_checkpoint(fresh, take_checkpoint(s), "saved");
    ASSERT_EQ(fresh.topology_version(), s.topology_version());
    expect_same_programs(s.program(), fresh.program());
    expect_same_programs(s.surface_program(), fresh.surface_program());
    EXPECT_EQ(s.surface_positions(), fresh.surface_positions());
    EXPECT_EQ(s.model().surface.weights, fresh.model().surface.weights);
    EXPECT_EQ(s.model().surface.nodes, fresh.model().surface.nodes);
    EXPECT_EQ(s.model().surface.triangles, fresh.model().surface.triangles);
    for (const Program* program : {&s.program(), &s.surface_program()}) {
      for (std::size_t i = 0; i < program->buffers.size(); ++i) {
        const Buffer& buffer = program->buffers[i];
        if (buffer.role != BufferRole::constant && buffer.name != "node_u" && buffer.name != "node_w") continue;
        const BufferId id = program->first + static_cast<BufferId>(i);
        EXPECT_EQ(s.backend().read_bytes(id), fresh.backend().read_bytes(id)) << buffer.name;
      }
    }
  }
  EXPECT_GE(s.topology_version(), 4);
}

class CutIncremental : public ::testing::TestWithParam<std::tuple<ModelType, ElementKind, const char*>> {};
INSTANTIATE_TEST_SUITE_P(Cutting, CutIncremental,
                         ::testing::Values(std::tuple(ModelType::tled, ElementKind::hex8, "cpu"),
                                           std::tuple(ModelType::tled, ElementKind::tet4anp, "cpu"),
                                           std::tuple(ModelType::hybrid, ElementKind::hex8, "cpu"),
                                           std::tuple(ModelType::tled, ElementKind::hex8, "opencl:0"),
                                           std::tuple(ModelType::hybrid, ElementKind::tet4, "opencl:0")));

TEST_P(CutIncremental, PatchedBuffersHaveTheBitsOfAFreshStart) {
  const auto [type, element, backend] = GetParam();
  if (std::string(backend) != "cpu" && !testing::has_opencl()) GTEST_SKIP() << "no OpenCL device";
  const Vec3d size{0.06, 0.03, 0.04};
  Body body = box_body("box", size, element);
  body.model.type = type;
  body.model.width = 1;
  body.model.ratio = 0.5;
  body.velocity = {0.01, 0, 0.02};
  expect_patched_as_fresh(scene_with(body), backend, size);
}

// What may not be made before the surface is known, or kept from before.
TEST(CutIncremental, SurfacesWithLoadsAndOfSeveralBodiesArePatchedToo) {
  const Vec3d size{0.06, 0.03, 0.04};
  Scene scene = scene_with(box_body("box", size));
  scene.interactive = true;
  expect_patched_as_fresh(scene, "cpu", size);
  scene.interactive = false;
  Pressure pressure;
  pressure.where.kind = Selection::Kind::all;
  pressure.pressure = 10;
  scene.bodies[0].pressures.push_back(pressure);
  expect_patched_as_fresh(scene, "cpu", size);
  scene.bodies[0].pressures.clear();
  Body other = box_body("other", {0.03, 0.04, 0.03}, ElementKind::tet4);
  other.pointer = "/bodies/1";
  scene.bodies.push_back(other);
  expect_patched_as_fresh(scene, "cpu", size);
}

/// An update fails where it is told to.
class FailingUpdates final : public test::ForwardingBackend {
 public:
  enum class Where { nowhere, at_first, after_the_surface };
  FailingUpdates(std::unique_ptr<Backend> inner, std::shared_ptr<Where> where)
      : ForwardingBackend(std::move(inner)), where_(std::move(where)) {}
  void update(const Program& loaded, const Program& next) override {
    if (*where_ == Where::at_first) throw Error(ErrorCode::device, "gone");
    ForwardingBackend::update(loaded, next);
  }
  void extend(const Program* before, const Program& extension) override {
    ForwardingBackend::extend(before, extension);
    if (*where_ == Where::after_the_surface && before != nullptr) throw Error(ErrorCode::device, "gone");
  }

 private:
  std::shared_ptr<Where> where_;
};

TEST(CutIncremental, EditsAfterOneThatFailedAreThoseOfARunInWhichNoneDid) {
  using Where = FailingUpdates::Where;
  const Vec3d size{0.06, 0.03, 0.04};
  Body body = box_body("box", size);
  body.velocity = {0.01, 0, 0.02};
  const Scene scene = scene_with(body);
  const auto where = std::make_shared<Where>(Where::nowhere);
  Simulation smooth(scene, open_backend("cpu")), rough(scene, std::make_unique<FailingUpdates>(open_backend("cpu"), where));
  std::mt19937 random(4);
  for (int k = 0; k < 6; ++k) {
    smooth.advance(3);
    rough.advance(3);
    const std::vector<SweepTriangle> cut = random_cut(random, size);
    const std::int64_t version = rough.topology_version();
    const bool changes = smooth.cut(cut).changed;
    for (const Where place : {Where::at_first, Where::after_the_surface}) {
      if (!changes || k % 3 == 0) break;
      *where = place;
      const std::uint64_t before = rough.hash();
      EXPECT_THROW(rough.cut(cut), Error);
      EXPECT_EQ(rough.hash(), before);
      EXPECT_EQ(rough.topology_version(), version);
    }
    *where = Where::nowhere;
    EXPECT_EQ(rough.cut(cut).changed, changes);
    expect_same_programs(smooth.program(), rough.program());
    EXPECT_EQ(smooth.hash(), rough.hash());
    EXPECT_EQ(smooth.surface_positions(), rough.surface_positions());
    EXPECT_EQ(smooth.model().surface.triangles, rough.model().surface.triangles);
    EXPECT_EQ(smooth.model().surface.triangle_cut, rough.model().surface.triangle_cut);
  }
  EXPECT_GE(rough.topology_version(), 4);
}

TEST(CutIncremental, ABackendThatIsUpdatedHoldsWhatALoadedOneHolds) {
  const Vec3d size{0.05, 0.03, 0.03};
  const Scene scene = scene_with(box_body("box", size));
  for (const char* name : {"cpu", "opencl:0"}) {
    if (std::string(name) != "cpu" && !testing::has_opencl()) continue;
    Simulation s(scene, open_backend(name));
    const auto patched = open_backend(name), loaded = open_backend(name);
    std::mt19937 random(5);
    std::vector<Program> programs{s.program()};
    for (int k = 0; k < 5; ++k) {
      s.cut(random_cut(random, size));
      programs.push_back(s.program());
    }
    std::reverse(programs.begin() + 3, programs.end());  // some get smaller
    patched->load(programs[0]);
    for (std::size_t k = 1; k < programs.size(); ++k) {
      patched->run(programs[k - 1].step, 0, 2);  // leaves something behind in what passes write
      patched->finish();
      patched->update(programs[k - 1], programs[k]);
      loaded->load(programs[k]);
      for (std::size_t i = 0; i < programs[k].buffers.size(); ++i) {
        const auto id = static_cast<BufferId>(i);
        ASSERT_EQ(patched->read_bytes(id), loaded->read_bytes(id)) << name << ": " << programs[k].buffers[i].name;
      }
    }
  }
}

TEST(CutIncremental, ABodyBroughtUpToDateIsTheBodyCutAtOnce) {
  for (const ElementKind element : {ElementKind::hex8, ElementKind::tet4}) {
    const Vec3d size{0.05, 0.03, 0.03};
    const Body body = box_body("box", size, element);
    const BodyMesh uncut = make_body_mesh(body);
    CutTopology topology(cut_mesh(uncut, "box"));
    CutSurface surface({uncut.surface, uncut.triangles}, *uncut.lattice);
    BodyMesh patched = uncut;
    std::mt19937 random(2);
    for (int k = 0; k < 6; ++k) {
      const CutEdit edit = cut_at_rest(topology, random_cut(random, size));
      if (edit.changed_elements()) surface.update(topology, edit.cells);
      if (k == 3) continue;
      update_body_elements(uncut, topology, patched);
      patch_body_surface(uncut, topology, surface, surface.take_changes(), patched);
      const BodyMesh whole = cut_body_mesh(uncut, topology, &surface);
      EXPECT_EQ(patched.nodes, whole.nodes);
      EXPECT_EQ(patched.tets, whole.tets);
      EXPECT_EQ(patched.hexes, whole.hexes);
      EXPECT_EQ(patched.fill, whole.fill);
      EXPECT_EQ(patched.copy_of, whole.copy_of);
      EXPECT_EQ(patched.virtual_nodes.offset, whole.virtual_nodes.offset);
      EXPECT_EQ(patched.virtual_nodes.anchor, whole.virtual_nodes.anchor);
      EXPECT_EQ(patched.surface, whole.surface);
      EXPECT_EQ(patched.surface_nodes, whole.surface_nodes);
      EXPECT_EQ(patched.surface_weights, whole.surface_weights);
      EXPECT_EQ(patched.surface_cell, whole.surface_cell);
      EXPECT_EQ(patched.triangles, whole.triangles);
      EXPECT_EQ(patched.triangle_cut, whole.triangle_cut);
      ASSERT_EQ(patched.triangle_middle.size(), whole.triangle_middle.size());
      for (std::size_t t = 0; t < whole.triangle_middle.size(); ++t) {
        EXPECT_EQ(std::isnan(patched.triangle_middle[t][0]), std::isnan(whole.triangle_middle[t][0]));
        if (std::isnan(whole.triangle_middle[t][0])) continue;
        EXPECT_EQ(patched.triangle_middle[t], whole.triangle_middle[t]);
      }
    }
    EXPECT_GT(patched.nodes.size(), uncut.nodes.size());
  }
}

TEST(CutBadInput, BladesOfASceneInMemoryAreChecked) {
  const Scene plain = scene_with(box_body("box", {0.02, 0.02, 0.02}));
  const auto refused = [&](const std::vector<std::array<double, 7>>& path, const std::string& part) {
    Scene scene = plain;
    scene.blades.push_back(blade("b", path));
    try {
      const Simulation s(scene, open_backend("cpu"));
      ADD_FAILURE() << part;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  refused({{0, 0, 0, 0, 0, 0, 1}}, "two or more");
  refused({{0, 0, 0, 0, 0, 0, 1}, {1, 2, 2, 2, 2, 2, 2}}, "two different points");
  refused({{0, 0, 0, 0, 0, 0, 1}, {1, NAN, 2, 2, 2, 2, 2}}, "finite");
  refused({{0, 0, 0, 0, 0, 0, 1}, {0, 1, 2, 2, 2, 2, 2}}, "ascending");
}

TEST(CutBadInput, ABladeThatMeetsNothingChangesNothing) {
  Simulation s(scene_with(box_body("box", {0.04, 0.03, 0.03})), open_backend("cpu"));
  s.advance(10);
  const std::uint64_t before = s.hash();
  EXPECT_FALSE(s.move_blade("b", {{{0.02, 5, -1}, {0.02, 5, 1}}}).changed);
  EXPECT_EQ(s.move_blade("b", {{{0.02, 4, -1}, {0.02, 4, 1}}}).edges, 0);
  EXPECT_EQ(s.move_blade("b", {{{0.02, 4, -1}, {0.02, 4, 1}}}).edges, 0) << "it rests";
  EXPECT_EQ(s.cut({}).edges, 0);
  EXPECT_EQ(s.move_blade("c", {{{0.02, 0.01, 0.01}, {0.021, 0.01, 0.01}}}).edges, 0) << "put into the body";
  EXPECT_EQ(s.move_blade("c", {{{0.02, 0.012, 0.01}, {0.021, 0.012, 0.01}}}).changed, false) << "too short to cut a cell";
  EXPECT_EQ(s.hash(), before);
  EXPECT_EQ(s.topology_version(), 0);
}

TEST(CutBadInput, ACheckpointDoesNotGoOnWithOtherBlades) {
  Scene scene = scene_with(box_body("box", {0.04, 0.03, 0.03}));
  scene.blades.push_back(blade("b", {{0, 0.02, 0.05, -1, 0.02, 0.05, 1}, {0.1, 0.02, -0.05, -1, 0.02, -0.05, 1}}));
  Simulation s(scene, open_backend("cpu"));
  s.advance(20);
  const Checkpoint saved = take_checkpoint(s);
  Simulation same(scene, open_backend("cpu"));
  restore_checkpoint(same, saved, "saved");
  scene.blades[0].path[1][2] = -0.06;
  Simulation other(scene, open_backend("cpu"));
  EXPECT_THROW(restore_checkpoint(other, saved, "saved"), Error);
}

}  // namespace
}  // namespace pliant
