// The geometric criterion of a cutting stroke: a blade that cuts by force goes over the surface from vertex to vertex.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "io/checkpoint.h"
#include "io/obj.h"
#include "io/save.h"
#include "physics/harness.h"
#include "support/error_of.h"
#include "support/source_dir.h"

namespace pliant::physics {
namespace {

class CutStrokes : public OnBackend {};

/// A blade's edge from one place to another, at a speed.
struct Draw {
  std::array<Vec3d, 2> from, to;
  double speed = 0.1, toughness = 1e4;
};

/// A body of this surface, with cells of 10 mm, held below, and a blade that is drawn through it.
Scene drawn_through(const std::string& surface, const Draw& d) {
  const double way = std::sqrt(std::pow(d.to[0][0] - d.from[0][0], 2) + std::pow(d.to[0][1] - d.from[0][1], 2) +
                               std::pow(d.to[0][2] - d.from[0][2], 2));
  const auto ends = [](const std::array<Vec3d, 2>& s) {
    return fmt::format("{}, {}, {}, {}, {}, {}", s[0][0], s[0][1], s[0][2], s[1][0], s[1][1], s[1][2]);
  };
  return parse_scene(
      fmt::format(R"({{"format": "pliant-scene/1", "duration": {0}, "bodies": [{{"name": "block", "surface": "{1}",
        "lattice": {{"spacing": 0.01}}, "element": "hex8", "material": {{"law": "neo-hookean", "young": 20000, "poisson": 0.4,
        "density": 1000, "damping": 60, "toughness": {4}}}, "fixed": [{{"plane": [[0, 0.02, 0], [0, -1, 0]]}}]}}],
        "blades": [{{"name": "scalpel", "cuts": "by-force", "edge": 2e-4, "path": [[0, {2}], [{0}, {3}]]}}]}})",
                  way / d.speed, surface, ends(d.from), ends(d.to), d.toughness),
      test::source_dir() + "/scenes/drawn_through.json");
}

/// From the side of a cube into it and along its top, on a line that is askew to the rows of vertices.
Draw along_the_top(double speed) {
  return {{Vec3d{-0.056, 0.035, -0.023}, Vec3d{-0.056, 0.065, -0.023}},
          {Vec3d{0.036, 0.035, 0.0175}, Vec3d{0.036, 0.065, 0.0175}},
          speed};
}

void go_through(Simulation& sim) {
  while (sim.time() < sim.scene().duration && !sim.divergence() && sim.advance(16) > 0) {
  }
}

const BladeStrokes& strokes_of(const Simulation& sim) { return sim.report().strokes.at("scalpel"); }

std::int64_t attempts_of(const Simulation& sim) {
  const auto own = sim.report().strokes.find("scalpel");
  return own == sim.report().strokes.end() ? 0 : own->second.attempts;
}

Vec3d rest_of(const Simulation& sim, std::int32_t vertex) { return sim.model().surface.rest[static_cast<std::size_t>(vertex)]; }

/// The vertices that a stroke came to on the top of the cube, the first one included.
std::vector<std::int32_t> on_the_top(const Simulation& sim) {
  std::vector<std::int32_t> all;
  for (const StrokeAttempt& a : strokes_of(sim).last) {
    if (rest_of(sim, a.from)[1] < 0.0499 || rest_of(sim, a.to)[1] < 0.0499) continue;
    if (all.empty()) all.push_back(a.from);
    EXPECT_EQ(all.back(), a.from);
    all.push_back(a.to);
  }
  return all;
}

/// The vertices of the top that are nearest to a straight line on it, one after the other, from x = `begin` to x = `end`.
std::vector<std::int32_t> along_the_line(const Simulation& sim, const Draw& d, double begin, double end) {
  std::vector<std::int32_t> all;
  const std::vector<Vec3d>& rest = sim.model().surface.rest;
  for (double x = begin; x < end; x += 1e-5) {
    const double share = (x - d.from[0][0]) / (d.to[0][0] - d.from[0][0]);
    const Vec3d p{x, 0.05, d.from[0][2] + share * (d.to[0][2] - d.from[0][2])};
    const auto far = [&](const Vec3d& v) { return std::hypot(v[0] - p[0], v[1] - p[1], v[2] - p[2]); };
    const auto near = [&](const Vec3d& a, const Vec3d& b) { return far(a) < far(b); };
    const auto best = static_cast<std::int32_t>(std::min_element(rest.begin(), rest.begin() + 602, near) - rest.begin());
    if (all.empty() || all.back() != best) all.push_back(best);
  }
  return all;
}

/// The blade is at the vertices that are nearest to its line, whatever its speed.
TEST_P(CutStrokes, AreTheNearestVerticesOfALine) {
  for (const double speed : {0.1, 0.2}) {
    const Draw draw = along_the_top(speed);
    const Scene scene = drawn_through("meshes/cube.obj", draw);
    auto sim = simulate(scene, GetParam());
    ASSERT_EQ(sim->model().surface.rest.size(), 602U);
    go_through(*sim);
    ASSERT_FALSE(sim->divergence());
    const std::vector<std::int32_t> told = on_the_top(*sim);
    EXPECT_EQ(told, along_the_line(*sim, draw, -0.046, 0.033)) << "at " << speed << " m/s";
    EXPECT_GT(told.size(), 8U);
    double before = 0;
    for (const StrokeAttempt& a : strokes_of(*sim).last) {
      EXPECT_GE(a.time, before);
      before = a.time;
      const double share = a.time / scene.duration;
      const Vec3d blade = plain((1 - share) * eigen(draw.from[0]) + share * eigen(draw.to[0]));
      EXPECT_LT(std::hypot(blade[0] - a.place[0], blade[2] - a.place[2]), 0.004) << "it is where the edge is";
    }
  }
}

/// An edge that comes down askew touches more and more of the surface: attempts of which none is a cut.
TEST_P(CutStrokes, AreOnlyPotentialWhereTissueHolds) {
  const Scene scene = drawn_through("meshes/cube.obj", {{Vec3d{0.002, 0.0505, -0.03}, Vec3d{0.002, 0.0565, 0.03}},
                                                        {Vec3d{0.002, 0.0405, -0.03}, Vec3d{0.002, 0.0465, 0.03}},
                                                        0.05,
                                                        1e9});
  auto sim = simulate(scene, GetParam());
  go_through(*sim);
  ASSERT_FALSE(sim->divergence());
  EXPECT_EQ(sim->state().pressed.at("scalpel").first, -1);
  EXPECT_EQ(strokes_of(*sim).strokes, 1);
  ASSERT_GE(strokes_of(*sim).attempts, 1);
  for (const StrokeAttempt& a : strokes_of(*sim).last) {
    EXPECT_FALSE(a.gave_way);
    EXPECT_GT(rest_of(*sim, a.to)[2], rest_of(*sim, a.from)[2]);
    EXPECT_NEAR(a.rest[1], 0.05, 1e-4);
  }
}

/// A body of cubes of 10 mm: two arms on a base, with a gap of one cube between them.
std::string two_arms() {
  constexpr std::array<int, 3> n{5, 6, 3};
  const auto filled = [&](int i, int j, int k) {
    return i >= 0 && j >= 0 && k >= 0 && i < n[0] && j < n[1] && k < n[2] && (j < 2 || i != 2);
  };
  TriangleMesh mesh;
  const auto corner = [](int i, int j, int k) { return Vec3d{0.01 * i, 0.01 * j, 0.01 * k}; };
  const auto face = [&](std::array<Vec3d, 4> c, bool turned) {
    const auto first = static_cast<std::int32_t>(mesh.vertices.size());
    if (turned) std::swap(c[1], c[3]);
    mesh.vertices.insert(mesh.vertices.end(), c.begin(), c.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  };
  for (int i = 0; i < n[0]; ++i) {
    for (int j = 0; j < n[1]; ++j) {
      for (int k = 0; k < n[2]; ++k) {
        if (!filled(i, j, k)) continue;
        for (const int d : {0, 1}) {
          if (!filled(i + 2 * d - 1, j, k))
            face({corner(i + d, j, k), corner(i + d, j + 1, k), corner(i + d, j + 1, k + 1), corner(i + d, j, k + 1)}, d == 0);
          if (!filled(i, j + 2 * d - 1, k))
            face({corner(i, j + d, k), corner(i, j + d, k + 1), corner(i + 1, j + d, k + 1), corner(i + 1, j + d, k)}, d == 0);
          if (!filled(i, j, k + 2 * d - 1))
            face({corner(i, j, k + d), corner(i + 1, j, k + d), corner(i + 1, j + 1, k + d), corner(i, j + 1, k + d)}, d == 0);
        }
      }
    }
  }
  const std::filesystem::path file = next_file(".obj");
  write_obj(file, mesh);
  return file.string();
}

/// From one arm to the other there is no attempt: the blade comes to the second one in a stroke of its own.
TEST_P(CutStrokes, EndWhereTheBladeLeavesTheSurface) {
  const Scene scene = drawn_through(two_arms(), {{Vec3d{-0.004, 0.045, 0.013}, Vec3d{-0.004, 0.075, 0.013}},
                                                 {Vec3d{0.056, 0.045, 0.013}, Vec3d{0.056, 0.075, 0.013}}});
  auto sim = simulate(scene, GetParam());
  go_through(*sim);
  ASSERT_FALSE(sim->divergence());
  std::array<std::set<std::int32_t>, 2> on_top;  // of each arm
  std::array<std::set<std::int64_t>, 2> strokes;
  for (const StrokeAttempt& a : strokes_of(*sim).last) {
    const Vec3d from = rest_of(*sim, a.from), to = rest_of(*sim, a.to);
    ASSERT_EQ(from[0] < 0.025, to[0] < 0.025) << "from " << from[0] << " to " << to[0];
    const std::size_t arm = to[0] < 0.025 ? 0 : 1;
    strokes[arm].insert(a.stroke);
    if (to[1] > 0.0599) on_top[arm].insert(a.to);
  }
  for (const std::size_t arm : {0, 1}) EXPECT_GE(on_top[arm].size(), 2U);
  for (const std::int64_t stroke : strokes[0]) EXPECT_EQ(strokes[1].count(stroke), 0U);
}

PLIANT_ON_BACKENDS(CutStrokes);

std::string bytes_of(const Simulation& sim) {
  RunReports only;
  only.now.strokes = sim.report().strokes;
  return write_report(only);
}

TEST(CutStrokesBits, AreThoseOfEveryBackendInFloat) {
  const Scene scene = drawn_through("meshes/cube.obj", along_the_top(0.2));
  auto reference = simulate(scene, "cpu");
  go_through(*reference);
  EXPECT_GT(strokes_of(*reference).attempts, 8);
  std::vector<const char*> others{"cpu:check"};
  if (test::has_opencl()) others.push_back("opencl:0");
  for (const char* backend : others) {
    auto sim = simulate(scene, backend);
    go_through(*sim);
    EXPECT_EQ(bytes_of(*sim), bytes_of(*reference)) << backend;
  }
}

TEST(CutStrokesBits, GoOnFromACheckpoint) {
  const Scene scene = drawn_through("meshes/cube.obj", along_the_top(0.2));
  auto whole = simulate(scene, "cpu");
  while (attempts_of(*whole) < 4 && whole->advance(16) > 0) {
  }
  const std::filesystem::path file = next_file(".pckpt");
  write_checkpoint(file, take_checkpoint(*whole));
  auto resumed = simulate(scene, "cpu");
  restore_checkpoint(*resumed, read_checkpoint(file), file);
  EXPECT_EQ(bytes_of(*resumed), bytes_of(*whole));
  go_through(*whole);
  go_through(*resumed);
  EXPECT_GT(strokes_of(*whole).attempts, 8);
  EXPECT_EQ(bytes_of(*resumed), bytes_of(*whole));
}

/// A checkpoint with strokes of another scene is refused.
TEST(CutStrokesBits, OfOtherBladesAndBodiesAreRefused) {
  const Scene scene = drawn_through("meshes/cube.obj", along_the_top(0.2));
  auto sim = simulate(scene, "cpu");
  for (const char* blade : {"scalpel", "knife"}) {
    Snapshot snapshot = sim->snapshot();
    snapshot.reports.now.strokes[blade].contacts.push_back({0, std::string(blade) == "scalpel" ? 1 : 0, 0, 0, {}, {}, 0});
    EXPECT_NE(test::error_of([&] { sim->restore(snapshot); }).find("strokes of its blades"), std::string::npos);
  }
}

}  // namespace
}  // namespace pliant::physics
