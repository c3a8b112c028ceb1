// Strokes across and into a block at any speed: which are not felt, and how deep tools go.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/contact/parts.h"
#include "bench/contact/scenes.h"
#include "geometry/triangle_tree.h"
#include "pliant/error.h"

namespace pliant::bench::contact {
namespace {

constexpr double kStrokeCell = 0.006;  // [m]
constexpr std::array<int, 3> kCells{10, 10, 5};
constexpr double kTop = kCells[2] * kStrokeCell, kSide = 0.5 * kCells[0] * kStrokeCell;  // [m]
constexpr double kStrokePi = 3.14159265358979323846;
constexpr double kFast = 0.5;  // [m/s]

struct Stroke {
  Scene scene;
  std::string kind, words;
  double speed = 0, duration = 0;
};

Stroke draw(std::int64_t number) {
  Dice dice(number);
  Stroke p;
  const bool thin = dice.chance(0.5), across = dice.chance(0.5);
  DrawnTool drawn = thin ? draw_thin(dice) : draw_blunt(dice, kStrokeCell);
  p.speed = dice.logarithmic(0.05, 5);
  const ElementKind element = kElements[static_cast<std::size_t>(number) % kElements.size()];
  const double young = dice.logarithmic(3e3, 30e3), friction = dice.chance(0.4) ? 0 : dice.uniform(0, 0.5);
  p.scene.bodies = {body_of("block", cells_surface(kCells, kStrokeCell, {-kSide, -kSide, 0}), kStrokeCell, element,
                            tissue(young, dice.uniform(0.3, 0.47), dice.logarithmic(2, 20)))};
  p.scene.bodies[0].fixed = {{face(2, 0)}};
  const double turn = dice.uniform(0, 2 * kStrokePi);
  const Vec3d way{std::cos(turn), std::sin(turn), 0};
  Vec3d from, to;
  double depth = 0;
  if (across) {
    depth = dice.uniform(0.5, 2) * kStrokeCell;
    const double beside = dice.uniform(-0.5, 0.5) * kSide, far = 1.5 * kSide + drawn.aside;
    const Vec3d middle{-way[1] * beside, way[0] * beside, kTop - drawn.low - depth};
    from = vec::sub(middle, vec::mul(way, far));
    to = vec::add(middle, vec::mul(way, far));
  } else {
    depth = dice.uniform(1.5, 3) * kStrokeCell;
    const Vec3d at{dice.uniform(-0.5, 0.5) * kSide, dice.uniform(-0.5, 0.5) * kSide, kTop - drawn.low};
    const double slope = std::tan(dice.uniform(0, 0.5));
    from = vec::add(at, vec::add({0, 0, kStrokeCell}, vec::mul(way, -slope * kStrokeCell)));
    to = vec::add(at, vec::add({0, 0, -depth}, vec::mul(way, slope * depth)));
  }
  p.duration = vec::norm(vec::sub(to, from)) / p.speed;
  ContactTool tool = moved(drawn, 0, from, p.duration, to);
  tool.friction = friction;
  p.scene.tools = {tool};
  p.kind = fmt::format("{} strokes of {} tools", p.speed < kFast ? "slow" : "fast", thin ? "thin" : "blunt");
  p.words = fmt::format("{}: {}, {:.2f} cells {}, {:.2f} m/s, {}, E {:.0f}, friction {:.2f}", number, drawn.words,
                        depth / kStrokeCell, across ? "deep across" : "into", p.speed, to_string(element), young, friction);
  return p;
}

/// Points of a tool's surface in its own frame.
std::vector<Vec3d> samples_of(const ContactTool& tool) {
  std::vector<Vec3d> points;
  if (tool.shape == ToolShape::box) {
    constexpr int n = 6;
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= n; ++j) {
        for (int k = 0; k <= n; ++k) {
          if (i % n != 0 && j % n != 0 && k % n != 0) continue;
          points.push_back({(i / double(n) - 0.5) * tool.size[0], (j / double(n) - 0.5) * tool.size[1],
                            (k / double(n) - 0.5) * tool.size[2]});
        }
      }
    }
    return points;
  }
  const TriangleMesh ball = ball_surface(tool.radius, {}, 3);
  const int along = tool.shape == ToolShape::capsule ? 24 : 0;
  for (int i = 0; i <= along; ++i) {
    const double s = along == 0 ? 0 : i / double(along);
    const Vec3d middle = vec::add(vec::mul(tool.first, 1 - s), vec::mul(tool.second, s));
    for (const Vec3d& x : ball.vertices) points.push_back(vec::add(middle, x));
  }
  return points;
}

/// How deep these points lie inside the deformed surface at the most [m].
double depth_of(Simulation& s, const std::vector<Vec3d>& samples) {
  const Pose pose = s.contact().pose(0, s.time());
  const TriangleTree tree({s.surface_positions(), s.model().surface.triangles});
  double deepest = 0;
  for (const Vec3d& y : samples) {
    const Vec3d x = place(pose, y);
    if (tree.bounds().distance2(x) > 0) continue;
    const double distance = tree.closest(x).distance;
    if (distance > deepest && std::abs(tree.winding(x)) > 0.5) deepest = distance;
  }
  return deepest / kStrokeCell;
}

struct Felt {
  bool unseen = false;
  double deepest = 0;  ///< [cells]
};

Felt go(const Stroke& p, const std::string& backend) {
  const auto s = simulate(p.scene, backend);
  const std::vector<Vec3d> samples = samples_of(p.scene.tools[0]);
  const double end = p.duration + 0.02;
  const auto batch = std::clamp<std::int64_t>(std::llround(0.25 * kStrokeCell / (p.speed * s->dt())), 1, 16);
  Felt felt;
  std::int64_t touched = 0;
  until(
      *s, end,
      [&](double) {
        const bool feels = s->report().tools[0].touched > touched;
        touched = s->report().tools[0].touched;
        const double depth = depth_of(*s, samples);
        felt.deepest = std::max(felt.deepest, depth);
        felt.unseen = felt.unseen || (!feels && depth > 1);
      },
      batch);
  return felt;
}

struct Counts {
  std::int64_t all = 0, unseen = 0, deep = 0, diverged = 0;
  double deepest = 0;
  std::string which, where;  ///< the first unseen ones, the deepest one
};

}  // namespace

void measure_strokes(PartRun& run) {
  std::map<std::string, Counts> kinds;
  for (std::int64_t i = 0; i < run.options.strokes; ++i) {
    const Stroke p = draw(i);
    run.show(static_cast<double>(i) / static_cast<double>(run.options.strokes), p.words);
    Counts& c = kinds[p.kind];
    ++c.all;
    try {
      const Felt felt = go(p, run.options.backend);
      if (felt.unseen) c.which += ++c.unseen <= 3 ? fmt::format("{}{}", c.which.empty() ? "" : "; ", p.words) : "";
      c.deep += felt.deepest > 1;
      if (felt.deepest > c.deepest) {
        c.deepest = felt.deepest;
        c.where = p.words;
      }
    } catch (const Error& error) {
      ++c.diverged;
      run.failed("strokes that end", p.words, error.what());
    }
  }
  for (const auto& [kind, c] : kinds) {
    run.at_most(fmt::format("unseen of {} {}", c.all, kind), c.which, static_cast<double>(c.unseen), 0);
    run.told(fmt::format("more than a cell deep of {} {}", c.all, kind), "", static_cast<double>(c.deep));
    run.told(fmt::format("deepest of {} [cells]", kind), c.where, c.deepest);
  }
}

}  // namespace pliant::bench::contact
