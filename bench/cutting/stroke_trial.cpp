#include "bench/cutting/stroke_trial.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "bench/common/dice.h"
#include "geometry/mesh.h"

namespace pliant::bench {
namespace {

constexpr double kCellEdge = 0.01;         // [m]
constexpr std::int64_t kOrganEvery = 20;   // trials
constexpr std::int64_t kOrganNodes = 300;  // about

std::shared_ptr<const TriangleMesh> closed_box(const Vec3d& size) {
  auto box = std::make_shared<TriangleMesh>();
  for (int a = 0; a < 8; ++a) box->vertices.push_back({size[0] * (a & 1), size[1] * (a >> 1 & 1), size[2] * (a >> 2 & 1)});
  box->triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return box;
}

Selection beyond(const Vec3d& point, const Vec3d& normal) { return {Selection::Kind::plane, point, normal, 0, {}, ""}; }

/// One end is held, most of the time, and the other one pulled or twisted, some of it.
void load_ends(Dice& dice, Body& body, double length, const Vec3d& size) {
  const bool held = dice.chance(0.8), pulled = dice.chance(0.5), twisted = dice.chance(0.5);
  if (held) {
    Fixed fixed;
    fixed.where = beyond({0.001, 0, 0}, {-1, 0, 0});
    body.fixed.push_back(fixed);
  }
  Prescribed moved;
  moved.where = beyond({length - 0.001, 0, 0}, {1, 0, 0});
  moved.curve.kind = Curve::Kind::smooth;
  moved.curve.duration = dice.uniform(0.02, 0.2);
  const double pull = dice.uniform(-0.1, 0.4), shear = dice.uniform(-0.3, 0.3), angle = dice.uniform(-70, 70);
  if (!pulled) return;
  if (twisted) {
    moved.rotate = Rotation{{1, 0, 0}, {0, size[1] / 2, size[2] / 2}, angle};
  } else {
    moved.displacement = {pull * length, shear * length, 0.0};
  }
  body.prescribed.push_back(moved);
}

Body random_block(Dice& dice, std::array<int, 3>& cells) {
  cells = {4 + static_cast<int>(dice.below(4)), 3 + static_cast<int>(dice.below(2)), 3 + static_cast<int>(dice.below(2))};
  const Vec3d size{kCellEdge * cells[0], kCellEdge * cells[1], kCellEdge * cells[2]};
  Body body;
  body.name = "block";
  body.surface = "block.obj";
  body.surface_in_memory = closed_box(size);
  body.lattice.spacing = kCellEdge;
  const double poisson = dice.uniform(0.3, 0.48), young = dice.logarithmic(1e3, 2e4);
  body.material.set_moduli(Law::neo_hookean, Moduli::from_young(young, poisson));
  body.material.density = dice.uniform(900, 1100);
  body.material.damping = dice.chance(0.3) ? 0 : dice.logarithmic(0.1, 30);
  body.material.stiffness_damping = dice.chance(0.3) ? dice.logarithmic(1e-5, 1e-3) : 0;
  body.pointer = "/bodies/0";
  body.model.pointer = "/bodies/0/model";
  load_ends(dice, body, size[0], size);
  return body;
}

/// The way of a blade seen along itself, and how far it reaches into the body.
struct Path {
  std::array<int, 3> axis{0, 1, 2};  ///< along, across, down
  std::array<double, 2> from{}, to{};
  double swing = 0, lean = 0;
  double tip = 0, top = 1.5;  ///< down
  int places = 2, back = -1;  ///< where it turns back; -1: nowhere

  [[nodiscard]] BladeSegment at(double way) const {
    const double du = to[0] - from[0], dv = to[1] - from[1], bow = swing * std::sin(std::numbers::pi * way);
    Vec3d low{}, high{};
    low[axis[0]] = from[0] + way * du - bow * dv;
    low[axis[1]] = from[1] + way * dv + bow * du;
    low[axis[2]] = tip;
    high = low;
    high[axis[0]] += lean;
    high[axis[2]] = top;
    return {low, high};
  }
};

/// 0 or 1 is a face of the body; a blade begins or ends outside, or in the middle of the tissue.
double end_of_path(Dice& dice) {
  const bool outside = dice.chance(0.6), low = dice.chance(0.5);
  const double inside = dice.uniform(0.1, 0.9);
  if (!outside) return inside;
  return low ? -0.3 : 1.3;
}

Path random_path(Dice& dice) {
  Path p;
  constexpr std::array<std::array<int, 3>, 6> kAxes{{{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {2, 0, 1}, {1, 2, 0}, {2, 1, 0}}};
  p.axis = kAxes[dice.below(6)];
  p.from = {end_of_path(dice), dice.uniform(0, 1)};
  p.to = {end_of_path(dice), dice.uniform(0, 1)};
  if (std::abs(p.to[0] - p.from[0]) < 0.1) p.to[0] = p.from[0] < 0.5 ? 1.3 : -0.3;
  p.swing = dice.chance(0.5) ? 0 : dice.uniform(-0.4, 0.4);
  p.lean = dice.chance(0.5) ? 0 : dice.uniform(-0.4, 0.4);
  p.tip = dice.chance(0.4) ? -0.5 : dice.uniform(0, 0.9);
  p.top = dice.chance(0.85) ? 1.5 : p.tip + dice.uniform(0.2, 0.6);
  p.places = 3 + static_cast<int>(dice.below(5));
  p.back = dice.chance(0.2) ? 1 + static_cast<int>(dice.below(static_cast<std::size_t>(p.places) - 1)) : -1;
  return p;
}

/// Across the former one, beside it within its flap, or into the same cut again.
Path related(Dice& dice, const Path& before) {
  Path p = random_path(dice);
  const double kind = dice.uniform(0, 1), aside = dice.uniform(-0.15, 0.15), deeper = dice.uniform(-0.2, 0.2);
  p.axis = before.axis;
  if (kind < 0.5) {
    const std::array<double, 2> middle{(before.from[0] + before.to[0]) / 2, (before.from[1] + before.to[1]) / 2};
    const double dv = before.to[0] - before.from[0], du = before.to[1] - before.from[1];
    p.from = {middle[0] - du, middle[1] + dv};
    p.to = {middle[0] + du, middle[1] - dv};
  } else {
    p = before;
    if (kind < 0.85) p.from[1] += aside;
    if (kind < 0.85) p.tip += deeper;
  }
  return p;
}

/// Through nodes, edges and faces of the cells.
Path exact(Dice& dice, Path p, const std::array<int, 3>& cells) {
  const auto on_grid = [&](double share, int axis) { return std::round(2 * share * cells[axis]) / (2 * cells[axis]); };
  p.swing = 0;
  p.lean = 0;
  p.from[1] = p.to[1] = on_grid(p.from[1], p.axis[1]);
  p.tip = p.tip > 0 ? on_grid(p.tip, p.axis[2]) : p.tip;
  if (dice.chance(0.5)) p.to[1] += (p.to[0] - p.from[0]) * cells[p.axis[0]] / cells[p.axis[1]];  // along diagonals
  return p;
}

void add_places(Dice& dice, const Path& path, const std::string& blade, bool waits, StrokeTrial& trial) {
  const std::int64_t between = static_cast<std::int64_t>(dice.below(30));
  const auto add = [&](int k) {
    const bool first = k == 0;
    trial.places.push_back({blade, path.at(static_cast<double>(k) / (path.places - 1)), waits && !first ? between : 0, first});
  };
  for (int k = 0; k < path.places; ++k) {
    add(k);
    for (int b = k - 1; k == path.back && b >= 0; --b) {
      add(b);
      trial.places.back().first = false;
    }
  }
}

void set_method(Scene& scene, BladeMethod method) {
  Blade far;  // gives the scene its method; the strokes are a program's
  far.name = "far";
  far.method = method;
  far.path = {{0, 9, 9, 8, 9, 9, 9}, {1, 9, 9.1, 8, 9, 9.1, 9}};
  scene.blades = {far};
}

}  // namespace

StrokeTrial draw_stroke_trial(std::int64_t number, const StrokeKind& kind) {
  Dice dice(20261127 + number);
  StrokeTrial trial;
  trial.number = number;
  std::array<int, 3> cells{8, 8, 8};
  const Body block = random_block(dice, cells);
  trial.box = number % kOrganEvery != kOrganEvery - 1;
  const Vec3d down = dice.direction();
  const bool heavy = dice.chance(0.7);
  if (trial.box) {
    trial.scene.name = "block";
    trial.scene.bodies = {block};
    if (heavy) trial.scene.gravity = {9.81 * down[0], 9.81 * down[1], 9.81 * down[2]};
  } else {
    trial.scene = kind.organ;
    trial.scene.bodies[0].lattice = {0, kOrganNodes};
  }
  Body& body = trial.scene.bodies[0];
  body.element = kind.element;
  const bool plain = dice.chance(0.5);
  body.plain = kind.method != BladeMethod::virtual_nodes || (plain && kind.element == ElementKind::tet4);
  set_method(trial.scene, kind.method);
  const bool at_rest = dice.chance(0.25);  // only then a stroke meets nodes exactly
  const auto wanted = 1 + static_cast<std::int64_t>(dice.below(5));
  const auto waiting = static_cast<std::int64_t>(dice.below(200));
  Path path;
  for (; trial.strokes < wanted; ++trial.strokes) {
    path = trial.strokes == 0 || dice.chance(0.3) ? random_path(dice) : related(dice, path);
    if (at_rest) path = exact(dice, path, cells);
    add_places(dice, path, fmt::format("stroke{}", trial.strokes), !at_rest, trial);
    if (trial.strokes == 0 && !at_rest) trial.places[0].steps = waiting;
  }
  trial.steps_after = 150;
  return trial;
}

}  // namespace pliant::bench
