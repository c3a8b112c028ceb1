// Faces of blades that cut by force: they hold the cut open by their thickness, rub, and give what they get.
#include <fmt/format.h>

#include "physics/harness.h"
#include "physics/turned_tetrahedra.h"
#include "scene/blade_face.h"
#include "schedule/program_layout.h"
#include "support/error_of.h"
#include "support/source_dir.h"

namespace pliant::physics::blade_faces {
namespace {

class BladeFaces : public OnBackend {};

constexpr double kCell = 0.005, kHeight = 0.03, kPlane = 0.001;  // the blade moves in the plane x = kPlane

struct Cut {
  std::string path, element = "hex8",
                    fixed = R"([{"plane": [[-0.045, 0, 0], [-1, 0, 0]]}, {"plane": [[0.045, 0, 0], [1, 0, 0]]}])";
  double thickness = 0.002, friction = 0, toughness = 2e4, damping = 30, height = kHeight, cell = kCell;
  std::string extra{};  ///< keys of the blade
};

/// A block of 120 x 40 x 80 mm about the origin, held at both ends; the edge lies along z.
Scene block(const Cut& s) {
  const std::string faces =
      s.thickness > 0 ? fmt::format(R"("thickness": {}, "height": {},)", s.thickness, s.height) : std::string();
  return parse_scene(fmt::format(R"({{"format": "pliant-scene/1", "bodies": [{{"name": "block", "surface": "meshes/block.obj",
        "lattice": {{"spacing": {}}}, "element": "{}", "material": {{"law": "neo-hookean", "young": 10000, "poisson": 0.4,
        "density": 1000, "damping": {}, "toughness": {}}}, "fixed": {}}}],
        "blades": [{{"name": "scalpel", "cuts": "by-force", "edge": 5e-4, "friction": {}, {} {} "path": {}}}]}})",
                                 s.cell, s.element, s.damping, s.toughness, s.fixed, s.friction, faces, s.extra, s.path),
                     test::source_dir() + "/scenes/block.json");
}

std::string row(double time, double y, double z = 0) {
  return fmt::format("[{}, {}, {}, {}, {}, {}, {}]", time, kPlane, y, -0.06 + z, kPlane, y, 0.06 + z);
}
std::string down_and_stand(double until) {
  return "[" + row(0, 0.021) + "," + row(0.5, -0.034) + "," + row(until, -0.034) + "]";
}

void run_until(Simulation& sim, double time) {
  while (sim.time() < time && sim.advance(16) > 0) {
  }
}

/// Distances between the two sides of the cut, in columns of the cut's faces within a range of heights [m].
struct Opening {
  double mean = 0, least = 1, most = -1;
};
Opening opening(Simulation& sim, double low, double high) {
  const ModelSurface& s = sim.model().surface;
  const std::vector<Vec3d> x = sim.surface_positions();
  std::vector<char> side(s.rest.size(), 0);  // 1: of the left part, whose face looks to the right; 2: of the right part
  for (const auto& t : s.triangles) {
    const auto at = [&](std::size_t k) { return eigen(s.rest[static_cast<std::size_t>(t[k])]); };
    const Vector3d normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
    if (std::abs(normal[0]) < 0.9) continue;
    for (const std::int32_t v : t) side[static_cast<std::size_t>(v)] = normal[0] > 0 ? 1 : 2;
  }
  std::map<std::pair<int, int>, std::array<std::array<double, 2>, 2>> cells;  // of y and z: sum and number of each side
  for (std::size_t v = 0; v < x.size(); ++v) {
    if (side[v] == 0 || std::abs(s.rest[v][0] - kPlane) > 0.2 * kCell || x[v][1] < low || x[v][1] > high) continue;
    const std::pair at{static_cast<int>(std::floor(x[v][1] / kCell)), static_cast<int>(std::floor(x[v][2] / kCell))};
    auto& [sum, number] = cells[at][static_cast<std::size_t>(side[v] - 1)];
    sum += x[v][0];
    number += 1;
  }
  Opening out;
  double n = 0;
  for (const auto& [at, sides] : cells) {
    if (sides[0][1] == 0 || sides[1][1] == 0) continue;
    const double gap = sides[1][0] / sides[1][1] - sides[0][0] / sides[0][1];
    out.mean += gap;
    out.least = std::min(out.least, gap);
    out.most = std::max(out.most, gap);
    n += 1;
  }
  EXPECT_GT(n, 8);
  out.mean /= n;
  return out;
}

/// Where the faces are flat, the cut is as wide as the blade is thick; it closes when the blade has gone.
TEST_P(BladeFaces, HoldTheCutOpenByTheirThickness) {
  for (const char* element : {"hex8", "tet4"}) {
    for (const double thickness : {0.001, 0.003}) {
      auto sim = simulate(block({.path = down_and_stand(1), .element = element, .thickness = thickness}), GetParam());
      run_until(*sim, 0.95);
      const Opening open = opening(*sim, -0.034 + kHeight / 3 + kCell, -0.034 + 2 * kHeight / 3);
      const std::string what = fmt::format("{}, {} m: ", element, thickness);
      check_relative(what + "mean opening [m]", open.mean, thickness, 0.1);
      check_relative(what + "least opening [m]", open.least, thickness, 0.15);
      check_relative(what + "largest opening [m]", open.most, thickness, 0.15);
      EXPECT_GT(sim->press().last_on_faces(0).normal, 0.01);
      run_until(*sim, 1.6);
      const Opening shut = opening(*sim, -0.034 + kHeight / 3 + kCell, -0.034 + 2 * kHeight / 3);
      check(what + "opening when the blade has gone, over the thickness", shut.most / thickness, 0.05);
      EXPECT_EQ(sim->press().last_on_faces(0).normal, 0);
    }
  }
}

/// The edge alone opens nothing.
TEST(BladeFacesNone, AnEdgeOpensNothing) {
  auto sim = simulate(block({.path = down_and_stand(1), .thickness = 0}), "cpu");
  EXPECT_TRUE(sim->scene().tools.empty());
  run_until(*sim, 0.95);
  check("opening at an edge without faces [m]", opening(*sim, -0.018, -0.01).most, 1e-4);
}

/// A blade drawn along its edge, out of the far side of the block, is held back by the friction of both faces.
TEST_P(BladeFaces, RubOnBothSides) {
  const double friction = 0.3;
  const std::string path =
      "[" + row(0, 0.021) + "," + row(0.5, -0.034) + "," + row(0.6, -0.034) + "," + row(1.2, -0.034, 0.015) + "]";
  auto sim = simulate(block({.path = path, .thickness = 0.003, .friction = friction}), GetParam());
  run_until(*sim, 1.0);
  int looks = 0;
  double along = 0, normal = 0;
  while (sim->time() < 1.18 && sim->advance(16) > 0) {
    const FaceLoad load = sim->press().last_on_faces(0);
    along -= load.force[2];
    normal += load.normal;
    ++looks;
  }
  EXPECT_GT(looks, 8);
  EXPECT_GT(normal / looks, 0.05);
  check_relative("force along the edge against friction times normal [N]", along / looks, friction * normal / looks, 0.1);
}

/// A free block gets the momentum that edge and faces give it.
TEST_P(BladeFaces, GiveWhatTheyGet) {
  Cut s{.path = "[" + row(0, 0.021) + "," + row(0.25, -0.03) + "]", .toughness = 1e3, .damping = 0};
  s.fixed = "[]";
  s.friction = 0.2;
  auto sim = simulate(block(s), GetParam());
  Vector3d given = Vector3d::Zero();
  double faces = 0;
  while (sim->time() < 0.2 && sim->advance(sim->next_batch(64)) > 0) {
    const std::vector<Wrench>& forces = sim->press().step_forces();
    for (const Wrench& f : forces) given -= sim->dt() * eigen(f.force);
    faces += sim->press().last_on_faces(0).normal;
  }
  EXPECT_GT(faces, 0.1);
  Vector3d momentum = Vector3d::Zero();
  const std::vector<Vec3d> v = sim->velocities(0);
  for (std::size_t n = 0; n < v.size(); ++n)
    momentum += sim->model().mass[static_cast<std::size_t>(sim->model().bodies[0].slot[n])] * eigen(v[n]);
  EXPECT_GT(momentum.norm(), 1e-4);
  check("momentum without a source, over it", (momentum - given).norm() / momentum.norm(), bound(1e-6, 1e-12));
}

/// What edge and faces do is in the tissue: none of its energy is without a source.
TEST_P(BladeFaces, DoTheWorkThatTissueGets) {
  for (const double thickness : {0.001, 0.003}) {
    auto sim =
        simulate(block({.path = down_and_stand(0.8), .element = "hex8full", .thickness = thickness, .damping = 0}), GetParam());
    while (sim->time() < 1 && sim->advance(16) > 0) sim->watch_energy();
    ASSERT_TRUE(sim->report().energy.share());
    EXPECT_GT(sim->press().work(0), sim->state().pressed.at("scalpel").work);
    check(fmt::format("{} m: energy made, over the largest", thickness), *sim->report().energy.share(), 1e-4);
  }
}

/// A blade that has been lifted and comes again in its cut, which has closed: it opens it slowly, and the work of this is its
/// own.
TEST_P(BladeFaces, SpreadTissueThatHasClosed) {
  auto sim = simulate(block({.path = down_and_stand(3), .element = "hex8full", .thickness = 0.003, .damping = 5}), GetParam());
  run_until(*sim, 0.6);
  const BladeSegment in = blade_place({}, sim->scene().blades[0], 0.6);
  sim->lift_blade_by_force("scalpel");
  run_until(*sim, 1.2);
  EXPECT_LT(opening(*sim, -0.02, -0.01).mean, 0.001);
  sim->drive_blade("scalpel", in, 0);
  const double before = sim->press().work(0);
  while (sim->time() < 2 && sim->advance(16) > 0) sim->watch_energy();
  const Opening open = opening(*sim, -0.034 + kHeight / 3 + kCell, -0.034 + 2 * kHeight / 3);
  check_relative("mean opening [m]", open.mean, 0.003, 0.1);
  EXPECT_GT(sim->press().work(0), before);
  check("energy made, over the largest", *sim->report().energy.share(), 0.02);
}

/// Turning all, or the blade about its back, so that its faces change sides, changes nothing but roundings and what follows.
TEST_P(BladeFaces, HaveNoPreferredSide) {
  const auto outcome = [&](const Matrix3d& turn, bool swapped) {
    Scene scene = turned_tetrahedra(turn, {8, 5, 4}, 2e4);
    Blade blade;
    blade.name = "scalpel";
    blade.cuts = BladeCuts::by_force;
    blade.edge = 5e-4;
    blade.friction = 0.2;
    blade.thickness = 0.004;
    blade.height = 0.045;
    for (const auto& [time, y] : {std::pair{0.0, 0.051}, {0.6, 0.011}}) {
      Vector3d a = turn * Vector3d(0.0433, y, -0.013), b = turn * Vector3d(0.0433, y, 0.054);
      if (swapped) std::swap(a, b);
      blade.path.push_back({time, a[0], a[1], a[2], b[0], b[1], b[2]});
    }
    scene.blades = {blade};
    scene.tools = faces_of(blade);
    auto sim = simulate(scene, GetParam(), {.dt = 1e-4});
    double normal = 0, down = 0, looks = 0;
    while (sim->time() < 0.58 && sim->advance(16) > 0) {
      if (sim->time() < 0.5) continue;
      const FaceLoad load = sim->press().last_on_faces(0);
      normal += load.normal;
      down += (turn.transpose() * eigen(load.force))[1];
      ++looks;
    }
    return std::array<double, 3>{normal / looks, down / looks, sim->press().work(0)};
  };
  const Matrix3d turn = Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  const auto one = outcome(Matrix3d::Identity(), false), other = outcome(turn, false),
             swapped = outcome(Matrix3d::Identity(), true);
  EXPECT_GT(one[0], 0.1);
  for (std::size_t k = 0; k < 3; ++k) {
    // Forces are whole quanta, and rounding decides in which search a point is first found.
    check_relative("turned with the block", other[k], one[k], bound(1e-3, 5e-4));
    check_relative("turned in the cut", swapped[k], one[k], 2e-3);  // samples at the ends of a cut follow the one before first
  }
}

/// Tissue that the edge has not opened is not pressed: the faces do not keep it from cutting, in coarse cells neither.
TEST(BladeFacesNone, DoNotKeepTheEdgeFromCutting) {
  for (const double cell : {0.005, 0.008}) {
    std::int64_t edges[2];
    for (const bool faces : {false, true}) {
      Scene scene = block({.path = down_and_stand(0.6), .thickness = faces ? 0.6 * cell : 0, .height = 0.036, .cell = cell});
      auto sim = simulate(scene, "cpu");
      run_until(*sim, 0.58);
      edges[faces ? 1 : 0] = 0;
      for (const CutRecord& cut : sim->state().cuts) edges[faces ? 1 : 0] += static_cast<std::int64_t>(cut.edges.size());
      EXPECT_EQ(sim->cut_in_part(0), 0) << cell;
    }
    EXPECT_EQ(edges[0], edges[1]) << cell;
  }
}

/// Where most of the two sides of a cut hangs on the same nodes, as in an element that is cut in part, faces push neither: they
/// would push against each other. In tissue that is drawn out that reaches further behind the edge than a cell.
TEST_P(BladeFaces, PushNothingThatHangsTogether) {
  Cut s{.path = "[" + row(0.5, 0.07) + "," + row(1.2, 0) + "," + row(1.5, 0) + "]", .thickness = 0.003};
  // The top is drawn up beside the blade, to twice the height.
  s.fixed = R"([{"plane": [[0, -0.018, 0], [0, -1, 0]]}], "prescribed": [
      {"box": [[-0.07, 0.0174, -0.06], [-0.02, 0.03, 0.06]], "displacement": [0, 0.04, 0], "curve": "smooth", "duration": 0.4},
      {"box": [[0.02, 0.0174, -0.06], [0.07, 0.03, 0.06]], "displacement": [0, 0.04, 0], "curve": "smooth", "duration": 0.4}])";
  auto sim = simulate(block(s), GetParam());
  std::size_t together = 0, pushed = 0;
  while (sim->time() < 1.2 && sim->advance(16) > 0) {
    const ContactPoints& points = *sim->model().contact;
    const std::vector<Vec3d> forces = sim->contact().point_forces();
    for (std::size_t i = 0; i < forces.size(); ++i) {
      if (forces[i] == Vec3d{}) continue;
      ++pushed;
      if (points.joined[i] != 0) ++together;
    }
  }
  EXPECT_GT(std::count(sim->model().contact->joined.begin(), sim->model().contact->joined.end(), 1), 20);
  EXPECT_GT(pushed, 100U);
  EXPECT_EQ(together, 0U);
}

/// Faces leave the points alone that hang mostly on held nodes: the few free ones would move many times as far.
TEST(BladeFacesNone, PushNothingThatIsHeld) {
  auto sim = simulate(block({.path = down_and_stand(1)}), "cpu");
  const ContactPoints& points = *sim->model().contact;
  std::vector<char> held(static_cast<std::size_t>(sim->model().slots), 0);
  for (const Constraint& c : sim->model().constraints) held[static_cast<std::size_t>(c.slot)] = 1;
  const std::vector<double> patch = sim->backend().read_reals(sim->program().find("contact_patch"));
  std::size_t marked = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::int32_t on_held = 0;
    for (std::size_t a = 0; a < 8; ++a)
      on_held += held[static_cast<std::size_t>(points.nodes[i][a])] != 0 ? points.weights[i][a] : 0;
    const bool mark = std::abs(patch[tile_base(i, PLIANT_PATCH) + std::size_t{33} * PLIANT_TILE]) == 2;
    EXPECT_EQ(mark, 2 * on_held > contact_weight_unit) << i;
    marked += mark ? 1 : 0;
  }
  EXPECT_GT(marked, 100U);
  EXPECT_LT(marked, points.size() / 2);
}

/// A run that goes on from a checkpoint, with a blade in tissue, has the bits of the whole run.
TEST_P(BladeFaces, GoOnFromACheckpoint) {
  const Scene scene = block({.path = down_and_stand(1), .friction = 0.2});
  auto whole = simulate(scene, GetParam()), begun = simulate(scene, GetParam());
  run_until(*whole, 0.3);
  whole->advance(3);
  begun->advance(whole->step());
  auto resumed = simulate(scene, GetParam());
  resumed->restore(begun->snapshot());
  EXPECT_EQ(resumed->deep_hash(), whole->deep_hash());
  EXPECT_NE(whole->press().last_on_faces(0).normal, 0);
  whole->advance(200);
  resumed->advance(200);
  EXPECT_EQ(resumed->deep_hash(), whole->deep_hash());
  EXPECT_EQ(resumed->press().work(0), whole->press().work(0));
}

/// Faces along cuts that follow the faces of elements, or divide them.
TEST(BladeFacesOfMethods, OpenCutsOfEveryMethod) {
  for (const auto& [method, element] : {std::pair{"separation", "hex8"}, {"separation", "tet4"}, {"decomposition", "tet4"}}) {
    const Cut s{
        .path = down_and_stand(1), .element = element, .thickness = 0.001, .extra = fmt::format(R"("method": "{}",)", method)};
    auto sim = simulate(block(s), "cpu");
    run_until(*sim, 0.7);
    EXPECT_GT(sim->press().last_on_faces(0).normal, 0.02) << method;
    EXPECT_EQ(sim->report().inversions.batches, 0) << method;
  }
}

TEST(BladeFacesMistakes, WhatTheCellsDoNotAllow) {
  const auto told = [](Cut s) { return test::error_of([&] { static_cast<void>(simulate(block(s), "cpu")); }); };
  EXPECT_NE(told({.path = down_and_stand(1), .thickness = 0.006})
                .find("blade 'scalpel': got a \"thickness\" of 0.006 m; allowed is up to 0.005 m, a cell"),
            std::string::npos);
  EXPECT_NE(told({.path = down_and_stand(1), .thickness = 0.0025, .extra = R"("method": "separation",)"})
                .find("m, a third of a cell, because with \"separation\" a cut lies beside the blade"),
            std::string::npos);
  Scene low = block({.path = down_and_stand(1)});
  low.blades[0].height = 0.012;
  EXPECT_NE(test::error_of([&] {
              static_cast<void>(simulate(low, "cpu"));
            }).find("got a \"height\" of 0.012 m; allowed is at least 0.015 m, three cells"),
            std::string::npos);
}

PLIANT_ON_BACKENDS(BladeFaces);

}  // namespace
}  // namespace pliant::physics::blade_faces
