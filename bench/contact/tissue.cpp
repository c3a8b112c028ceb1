// Tissue pressed on tissue, or lying on it by its weight: does it come to rest?
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/contact/parts.h"
#include "bench/contact/scenes.h"
#include "pliant/error.h"

namespace pliant::bench::contact {
namespace {

constexpr double kTissueCell = 0.005;                                          // [m]
constexpr double kLoad = 0.6, kTissueHold = 2, kTissueWindow = 0.25;           // [s]
constexpr double kTissueResting = 1e-6, kTissueBeats = 1.25, kDeepest = 0.25;  // as in part rest; [cells]

struct Kind {
  ElementKind element;
  double damping, friction;
};

Scene scene_of(const Kind& kind) {
  Scene scene;
  scene.contact = TissueContact{kind.friction};
  return scene;
}

Body block_of(const std::string& name, const std::array<int, 3>& cells, const Vec3d& lower, const Kind& kind,
              double young = 8000) {
  return body_of(name, cells_surface(cells, kTissueCell, lower), kTissueCell, kind.element, tissue(young, 0.45, kind.damping));
}

Prescribed down(const Selection& where, double by) {
  Prescribed p;
  p.where = where;
  p.displacement = {0.0, 0.0, -by};
  p.curve.kind = Curve::Kind::smooth;
  p.curve.duration = kLoad;
  return p;
}

/// A block held at its foot, and one that is pressed into it with another place of its cells.
Scene blocks(const Kind& kind) {
  Scene scene = scene_of(kind);
  Body low = block_of("low", {12, 12, 6}, {-0.03, -0.03, 0}, kind);
  low.fixed = {{face(2, 0)}};
  Body high = block_of("high", {6, 6, 5}, {-0.0137, -0.0161, 0.0301}, kind, 12000);
  high.prescribed = {down(face(2, 0.0551), 0.006)};
  scene.bodies = {low, high};
  return scene;
}

/// The same with a ball of tissue, moved by its upper cap.
Scene ball(const Kind& kind) {
  Scene scene = scene_of(kind);
  Body low = block_of("low", {12, 12, 6}, {-0.03, -0.03, 0}, kind);
  low.fixed = {{face(2, 0)}};
  Body ball = body_of("ball", ball_surface(0.02, {0.001, 0.0007, 0.0505}, 12), kTissueCell, kind.element,
                      tissue(8000, 0.45, kind.damping));
  ball.prescribed = {down(beyond(2, 0.056, true), 0.012)};
  scene.bodies = {low, ball};
  return scene;
}

/// Three cubes under their weight, each a little beside the one below.
Scene stack(const Kind& kind) {
  Scene scene = scene_of(kind);
  scene.gravity = {0, 0, -9.81};
  for (int k = 0; k < 3; ++k)
    scene.bodies.push_back(block_of(fmt::format("cube{}", k), {6, 6, 6}, {0.002 * k, 0.0013 * k, 0.03002 * k}, kind, 30000));
  scene.bodies[0].fixed = {{face(2, 0)}};
  return scene;
}

/// A body like a C lying on its back whose upper arm is pressed on the lower one.
Scene fold(const Kind& kind) {
  Scene scene = scene_of(kind);
  Body body =
      body_of("fold", cells_surface({12, 4, 7}, kTissueCell, {0, 0, 0}, 1, [](int i, int, int k) { return i < 3 || k != 3; }),
              kTissueCell, kind.element, tissue(8000, 0.45, kind.damping));
  body.fixed = {{face(2, 0)}};
  Prescribed press = down(face(2, 0.035), 0.009);
  press.where.a[0] = 0.0449;
  body.prescribed = {press};
  scene.bodies = {body};
  return scene;
}

void measure(PartRun& run, const std::string& name, const Kind& kind, const Scene& scene) {
  const std::string words =
      fmt::format("{}, {}, damping {}, friction {}", name, to_string(kind.element), kind.damping, kind.friction);
  run.show(0.5, words);
  const double end = kLoad + kTissueHold;
  try {
    const auto s = simulate(scene, run.options.backend);
    double early = 0, late = 0, early_time = 0, late_time = 0, elastic = 0;
    until(*s, end, [&](double took) {
      const bool first = s->time() > kLoad && s->time() <= kLoad + kTissueWindow;
      if (!first && s->time() <= end - kTissueWindow) return;
      const Energy now = energy_of(*s);
      (first ? early : late) += took * now.kinetic;
      (first ? early_time : late_time) += took;
      elastic = now.elastic;
    });
    early /= early_time * elastic;
    late /= late_time * elastic;
    run.at_most("kinetic over strain energy at rest", words, late,
                std::max(kTissueResting, kTissueBeats * early * std::exp(-kind.damping * (kTissueHold - kTissueWindow))));
    run.at_most("deepest pair [cells]", words, s->report().tissue.max_depth / kTissueCell, kDeepest);
    run.at_least("points that touch", words, static_cast<double>(s->report().tissue.points), 20, 0);
  } catch (const Error& error) {
    run.failed("kinetic over strain energy at rest", words, error.what());
  }
}

}  // namespace

void measure_tissue(PartRun& run) {
  const auto all = [&](const Kind& kind) {
    measure(run, "block on block", kind, blocks(kind));
    if (run.options.quick) return;
    measure(run, "ball on block", kind, ball(kind));
    // Without friction they slide off each other, as they should.
    if (kind.friction > 0) measure(run, "three cubes", kind, stack(kind));
  };
  measure(run, "fold on itself", {ElementKind::hex8, 2, 0}, fold({ElementKind::hex8, 2, 0}));
  all({ElementKind::hex8, 2, 0});
  if (run.options.quick) return;
  for (const ElementKind element : kElements) {
    for (const double damping : {2.0, 5.0}) {
      for (const double friction : {0.0, 0.3}) {
        if (element == ElementKind::hex8 && damping == 2 && friction == 0) continue;
        const Kind kind{element, damping, friction};
        all(kind);
        measure(run, "fold on itself", kind, fold(kind));
      }
    }
  }
}

}  // namespace pliant::bench::contact
