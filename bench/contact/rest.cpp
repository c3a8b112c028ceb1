// A tool is pressed into a block and stands still: does the block, too?
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/contact/parts.h"
#include "bench/contact/scenes.h"
#include "model/contact/contact.h"
#include "pliant/error.h"

namespace pliant::bench::contact {
namespace {

constexpr double kRestCell = 0.006;                        // [m]
constexpr int kFine = 4;                                   // squares of the surface along a cell
constexpr double kPress = 0.5, kHold = 2, kWindow = 0.25;  // [s]
constexpr double kPressure = 0.2;                          // over E, up to which depth is asked
constexpr double kResting = 1e-6;                          // kinetic over strain energy
constexpr double kBeats = 1.25;                            // what vibrations share between two windows
constexpr const char *kAtRest = "kinetic over strain energy at rest",
                     *kThinAtRest = "thin tools with edges: kinetic over strain energy at rest";

struct Pressed {
  Scene scene;
  std::string words;
  double young = 0, damping = 0;
};

/// `thin`: with a tool that is met along its edges.
Pressed draw(std::int64_t number, bool quick, bool thin) {
  Dice dice(thin ? -1 - number : number);
  Pressed p;
  const std::array<int, 3> cells = quick ? std::array{8, 8, 4} : std::array{12, 12, 6};
  const ElementKind element = kElements[static_cast<std::size_t>(number) % kElements.size()];
  p.young = dice.logarithmic(3e3, 30e3);
  p.damping = dice.chance(0.15) ? 0 : dice.logarithmic(0.5, 5);
  const double poisson = dice.uniform(0.3, 0.47), friction = dice.chance(0.4) ? 0 : dice.uniform(0, 0.5);
  const DrawnTool drawn = thin ? draw_edged(dice) : draw_blunt(dice, kRestCell);
  const double depth = dice.chance(0.4) ? dice.uniform(0.05, 0.2) : dice.uniform(0.2, 1), aside = 0.15 * cells[0] * kRestCell;
  const Vec3d lower{-0.5 * cells[0] * kRestCell, -0.5 * cells[1] * kRestCell, 0};
  p.scene.bodies = {
      body_of("block", cells_surface(cells, kRestCell, lower, kFine), kRestCell, element, tissue(p.young, poisson, p.damping))};
  p.scene.bodies[0].fixed = {{face(2, 0)}};
  const Vec3d at{dice.uniform(-aside, aside), dice.uniform(-aside, aside), cells[2] * kRestCell - drawn.low};
  ContactTool tool = moved(drawn, 0, vec::add(at, {0, 0, 0.05 * kRestCell}), kPress, vec::add(at, {0, 0, -depth * kRestCell}));
  tool.friction = friction;
  p.scene.tools = {tool};
  p.words = fmt::format("{}: {}, {:.2f} deep, {}, E {:.0f}, nu {:.2f}, damping {:.2g}, friction {:.2f}", number, drawn.words,
                        depth, to_string(element), p.young, poisson, p.damping, friction);
  return p;
}

struct Held {
  double early = 0, late = 0;  ///< mean kinetic energy in the first and the last window [J]
  double elastic = 0;          ///< [J]
  double dt = 0;               ///< the last step [s]
  Vec3d force{};               ///< mean over the last half second [N]
};

Held hold(Simulation& s, double end) {
  Held held;
  double early = 0, late = 0, last = 0;
  until(s, end, [&](double took) {
    if (s.time() > end - 0.5) {
      for (std::size_t c = 0; c < 3; ++c) held.force[c] += took * s.report().tools[0].now.force[c];
      last += took;
    }
    const bool first = s.time() > kPress && s.time() <= kPress + kWindow;
    if (!first && s.time() <= end - kWindow) return;
    const Energy now = energy_of(s);
    (first ? held.early : held.late) += took * now.kinetic;
    (first ? early : late) += took;
    held.elastic = now.elastic;
  });
  held.early /= early;
  held.late /= late;
  held.force = vec::mul(held.force, 1 / last);
  held.dt = s.dt();
  return held;
}

/// How deep points of the deformed surface lie inside the tool, among those that are nearer than a quarter of a cell [cells].
struct Depths {
  double most = 0, most_but_a_thousandth = 0;
  double area = 0;  ///< of what is nearer than a twentieth of a cell, at rest [m^2]
};

Depths depths(Simulation& s) {
  const Pose pose = s.contact().pose(0, s.time());
  std::vector<double> near;
  Depths d;
  for (const Vec3d& x : s.surface_positions()) {
    const double distance = tool_distance((*s.model().tools)[0], place_back(pose, x));
    if (distance < 0.05 * kRestCell) d.area += kRestCell * kRestCell / (kFine * kFine);
    if (distance < 0.25 * kRestCell) near.push_back(std::max(0.0, -distance) / kRestCell);
  }
  if (near.empty()) return d;
  std::sort(near.begin(), near.end());
  d.most = near.back();
  d.most_but_a_thousandth = near[static_cast<std::size_t>(0.999 * static_cast<double>(near.size() - 1))];
  return d;
}

/// What the damping of the material alone leaves of the vibration.
double left_of(const Pressed& p, const Held& held) {
  return kBeats * held.early / held.elastic * std::exp(-p.damping * (kHold - kWindow));
}

void measure_thin(PartRun& run, const Pressed& p) {
  const auto s = simulate(p.scene, run.options.backend);
  const Held held = hold(*s, kPress + kHold);
  run.at_most(kThinAtRest, p.words, held.late / held.elastic, std::max(kResting, left_of(p, held)));
}

void measure(PartRun& run, const Pressed& p, bool force_too) {
  const double end = kPress + kHold;
  const auto s = simulate(p.scene, run.options.backend);
  Scene alone = p.scene;
  alone.tools.clear();
  const double first = simulate(alone, run.options.backend)->dt();
  const Held held = hold(*s, end);
  run.at_most(kAtRest, p.words, held.late / held.elastic, std::max(kResting, left_of(p, held)));
  run.at_least("step at rest over the step without contact", p.words, held.dt / first, 1, 0.2);
  const Depths deep = depths(*s);
  const double pressure = deep.area > 0 ? vec::norm(held.force) / (p.young * deep.area) : 0;
  run.told("pressure at rest over E", p.words, pressure);
  if (pressure > 0 && pressure < kPressure) {
    run.at_most("depth of the surface at rest, the deepest point [cells]", p.words, deep.most, 0.25);
    run.at_most("depth of the surface at rest, 99.9 % of the points [cells]", p.words, deep.most_but_a_thousandth, 0.1);
  }
  if (!force_too) return;
  const auto fine = simulate(p.scene, run.options.backend, 0.1 * held.dt);
  const Vec3d exact = hold(*fine, end).force;
  run.close_to("force at rest over that at a tenth of the step", p.words, vec::norm(held.force), vec::norm(exact), 0.01);
}

}  // namespace

void measure_rest(PartRun& run) {
  const std::int64_t every = run.options.quick ? 5 : 10;
  for (std::int64_t i = 0; i < run.options.tools; ++i) {
    for (const bool thin : {false, true}) {
      if (thin && i % 2 != 0) continue;
      const Pressed p = draw(thin ? i / 2 : i, run.options.quick, thin);
      run.show(static_cast<double>(i) / static_cast<double>(run.options.tools), p.words);
      try {
        thin ? measure_thin(run, p) : measure(run, p, i % every == 0);
      } catch (const Error& error) {
        run.failed(thin ? kThinAtRest : kAtRest, p.words, error.what());
      }
    }
  }
}

}  // namespace pliant::bench::contact
