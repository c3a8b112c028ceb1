// The figures of docs/contact.md, from scenes like those of tests/physics/contact_test.cpp and touch_test.cpp, on lattices.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bench/contact/parts.h"
#include "bench/contact/scenes.h"
#include "pliant/error.h"
#include "simulation/measure/energy.h"
#include "simulation/measure/reactions.h"

namespace pliant::bench::contact {
namespace {

constexpr double kGravity = 9.81;  // [m/s^2]

ContactTool wall(double friction = 0) {
  ContactTool tool;
  tool.name = "wall";
  tool.shape = ToolShape::half_space;
  tool.second = {0, 0, 1};
  tool.friction = friction;
  return tool;
}

Body cube(const std::string& name, const std::array<int, 3>& cells, double edge, ElementKind element,
          const Material& material) {
  return body_of(name, cells_surface(cells, edge, {0, 0, 0}), edge, element, material);
}

Vec3d mean_over(const Simulation& s, std::size_t body, const std::vector<Vec3d>& values) {
  Vec3d sum{};
  for (std::size_t n = 0; n < values.size(); ++n) {
    const auto slot = static_cast<std::size_t>(s.model().bodies[body].slot[n]);
    sum = vec::add(sum, vec::mul(values[n], s.model().mass[slot]));
  }
  return vec::mul(sum, 1 / s.model().bodies[body].mass);
}

Vec3d velocity_of(const Simulation& s, std::size_t body) { return mean_over(s, body, s.velocities(body)); }

/// Until a time; returns the impulse on the first tool [N s].
Vec3d impulse_until(Simulation& s, double time) {
  Vec3d sum{};
  until(s, time, [&](double took) { sum = vec::add(sum, vec::mul(s.report().tools[0].now.force, took)); });
  return sum;
}

/// How far the farthest node of a body moves until a time [m].
double creep_until(Simulation& s, std::size_t body, double time) {
  const std::vector<Vec3d> before = s.displacements(body);
  until(s, time);
  const std::vector<Vec3d> after = s.displacements(body);
  double most = 0;
  for (std::size_t n = 0; n < after.size(); ++n) most = std::max(most, vec::norm(vec::sub(after[n], before[n])));
  return most;
}

/// v + v' = (1/c) ln((1 + c v) / (1 - c v')), c = 3 alpha / 2 (Hunt and Crossley 1975).
void restitution(PartRun& run) {
  for (const auto& [alpha, v] : {std::pair{0.1, 1.0}, {0.5, 0.3}, {2.0, 0.3}}) {
    Body body = body_of("body", cells_surface({1, 1, 1}, 0.05, {0, 0, 1e-3}), 0.05, ElementKind::hex8, tissue(1e6, 0, 0));
    body.velocity = {0, 0, -v};
    Scene scene;
    scene.bodies = {body};
    scene.tools = {wall()};
    scene.tools[0].alpha = alpha;
    scene.tools[0].stiffness = 7.9e5;
    scene.dt = 2e-4;
    const auto s = simulate(scene, run.options.backend);
    until(*s, 0.1 + 1e-3 / v);
    const double c = 1.5 * alpha;
    double low = 0, high = std::min(v, (1 - 1e-12) / c);
    for (int i = 0; i < 100; ++i) {
      const double out = 0.5 * (low + high);
      (v + out < std::log((1 + c * v) / (1 - c * out)) / c ? high : low) = out;
    }
    run.close_to("speed after a rebound from a wall [m/s]", fmt::format("alpha {}, v {}", alpha, v), velocity_of(*s, 0)[2],
                 0.5 * (low + high), 0.01);
  }
}

void weight(PartRun& run, ElementKind element) {
  Scene scene;
  scene.bodies = {cube("body", {3, 3, 3}, 0.02, element, tissue(2e4, 0.3, 60))};
  scene.tools = {wall()};
  scene.gravity = {0, 0, -kGravity};
  const auto s = simulate(scene, run.options.backend);
  until(*s, 1);
  run.close_to("weight on a wall [N]", to_string(element), -s->report().tools[0].now.force[2],
               kGravity * s->model().bodies[0].mass, 1e-4);
}

void slope(PartRun& run) {
  const double angle = std::atan(0.4);
  Scene scene;
  scene.bodies = {cube("body", {4, 4, 4}, 0.0125, ElementKind::hex8, tissue(2e4, 0.4, 20))};
  scene.tools = {wall(0.5)};
  scene.gravity = {kGravity * std::sin(angle), 0, -kGravity * std::cos(angle)};
  const auto stuck = simulate(scene, run.options.backend);
  until(*stuck, 2);
  run.at_most("creep below the angle of friction in 1 s [cells]", "", creep_until(*stuck, 0, 3) / 0.0125, 1e-6);
  scene.bodies[0].material.damping = 0;
  scene.tools[0].friction = 0.2;
  const auto slides = simulate(scene, run.options.backend);
  until(*slides, 1);
  const double from = slides->time(), v = velocity_of(*slides, 0)[0];
  const Vec3d impulse = impulse_until(*slides, 2);
  run.close_to("acceleration of a cube that slides [m/s^2]", "", (velocity_of(*slides, 0)[0] - v) / (slides->time() - from),
               kGravity * (std::sin(angle) - 0.2 * std::cos(angle)), 0.02);
  run.close_to("friction over pressure of a cube that slides", "", -impulse[0] / impulse[2], 0.2, 1e-3);
}

void throws(PartRun& run) {
  Scene scene;
  scene.bodies = {cube("body", {4, 4, 4}, 0.0125, ElementKind::hex8, tissue(1e6, 0.3, 0))};
  scene.bodies[0].velocity = {0.3, 0, 0};
  scene.tools = {wall(0.3)};
  scene.gravity = {0, 0, -kGravity};
  const auto s = simulate(scene, run.options.backend);
  until(*s, 0.4);
  const double way = mean_over(*s, 0, s->displacements(0))[0];
  run.close_to("way of a cube thrown along a table [m]", "", way, 0.09 / (2 * 0.3 * kGravity), 0.02);
}

/// A rigid sphere on a bonded layer, without friction: Hertz times the correction of Dimitriadis et al. (2002).
double bonded_layer(double r, double h, double young, double poisson, double depth) {
  const double pi = 3.14159265358979323846, chi = std::sqrt(r * depth) / h;
  const double a = -(1.2876 - 1.4678 * poisson + 1.3442 * poisson * poisson) / (1 - poisson);
  const double b = (0.6387 - 1.0277 * poisson + 1.5164 * poisson * poisson) / (1 - poisson);
  const double layer =
      1 - 2 * a / pi * chi + std::pow(2 * a / pi * chi, 2) - 8 * std::pow(chi / pi, 3) * (a * a * a + 4 * pi * pi / 15 * b);
  return 4.0 / 3 * young / (1 - poisson * poisson) * std::sqrt(r) * std::pow(depth, 1.5) * layer;
}

void hertz(PartRun& run, int cells, double bound) {
  const double radius = 0.05, height = 0.1, depth = 0.002;
  Scene scene;
  Body body = cube("layer", {cells, cells, cells}, height / cells, ElementKind::hex8, tissue(1e4, 0.3, 40));
  body.fixed = {{face(2, 0)}, {face(0, 0), {true, false, false}}, {face(1, 0), {false, true, false}}};
  ContactTool ball;
  ball.name = "ball";
  ball.radius = radius;
  ball.path = {{0, 0, 0, height + radius, 0, 0, 0, 1}, {0.2, 0, 0, height + radius - depth, 0, 0, 0, 1}};
  scene.bodies = {body};
  scene.tools = {ball};
  const auto s = simulate(scene, run.options.backend);
  until(*s, 0.5);
  run.close_to("a sphere on a bonded layer [N]", fmt::format("{:.0f} cells per radius of the contact", cells / 10.0),
               4 * s->report().tools[0].now.force[2], bonded_layer(radius, height, 1e4, 0.3, depth), bound);
}

/// Two bodies that meet askew in free space.
void collision(PartRun& run, ElementKind element, double friction) {
  Scene scene;
  Body one = cube("one", {4, 4, 4}, 0.0125, element, tissue(2e4, 0.4, 0));
  Body two =
      body_of("two", cells_surface({5, 4, 4}, 0.01, {0.055, 0.013, 0.007}), 0.01, ElementKind::hex8, tissue(5e4, 0.3, 0));
  one.velocity = {0.5, 0.02, 0};
  two.velocity = {-0.5, 0, 0.05};
  scene.bodies = {one, two};
  scene.contact = TissueContact{friction};
  scene.dt = 1e-4;
  const auto s = simulate(scene, run.options.backend);
  const auto momentum = [&] {
    return vec::add(vec::mul(velocity_of(*s, 0), s->model().bodies[0].mass),
                    vec::mul(velocity_of(*s, 1), s->model().bodies[1].mass));
  };
  const auto energy = [&] {
    const Energy e = energy_of(*s);
    return e.kinetic + e.elastic;
  };
  const Vec3d before = momentum();
  const double first = energy(), closing = velocity_of(*s, 0)[0] - velocity_of(*s, 1)[0];
  double most = 0;
  until(
      *s, 0.1, [&](double) { most = std::max(most, energy() / first - 1); }, 10);
  const std::string words = fmt::format("{}, friction {}", to_string(element), friction);
  run.at_most("momentum lost in a collision, over that of one body", words,
              vec::norm(vec::sub(momentum(), before)) / (0.5 * s->model().bodies[0].mass), 2e-5);
  run.at_most("energy made in a collision, over all", words, most, 1e-3);
  run.at_most("speed of approach after a collision, over that before", words,
              std::max(0.0, velocity_of(*s, 0)[0] - velocity_of(*s, 1)[0]) / closing, 0.2);
}

/// Two blocks pressed by 10 % against one of both.
void halves(PartRun& run, ElementKind element) {
  const double edge = 0.0125;
  const auto reaction = [&](bool two) {
    Scene scene;
    Body low = cube("low", {4, 4, two ? 4 : 8}, edge, element, tissue(1e4, 0.4, 30));
    low.fixed = {{face(2, 0)}};
    Body high = body_of("high", cells_surface({4, 4, 4}, edge, {0, 0, 4 * edge}), edge, element, tissue(1e4, 0.4, 30));
    scene.bodies = {low};
    if (two) scene.bodies.push_back(high);
    Prescribed down;
    down.where = face(2, 8 * edge);
    down.displacement = {0.0, 0.0, -0.01};
    down.curve.kind = Curve::Kind::smooth;
    down.curve.duration = 0.6;
    scene.bodies.back().prescribed = {down};
    if (two) scene.contact = TissueContact{1};
    const auto s = simulate(scene, run.options.backend);
    until(*s, 1.2, nullptr, 64);
    double sum = 0;
    const std::vector<Vec3d> forces = reactions(*s, 0);
    for (std::size_t n = 0; n < forces.size(); ++n) {
      if (s->model().bodies[0].rest[n][2] < 1e-6) sum += forces[n][2];
    }
    return sum;
  };
  run.close_to("force of two blocks pressed against one of both [N]", to_string(element), reaction(true), reaction(false),
               0.02);
}

}  // namespace

void measure_figures(PartRun& run) {
  const bool quick = run.options.quick;
  std::vector<std::pair<std::string, std::function<void()>>> all{{"restitution", [&] { restitution(run); }},
                                                                 {"slope", [&] { slope(run); }},
                                                                 {"thrown", [&] { throws(run); }},
                                                                 {"layer", [&] { hertz(run, 20, 0.07); }}};
  if (!quick) all.emplace_back("layer", [&] { hertz(run, 30, 0.03); });
  for (const ElementKind element : kElements) {
    if (quick && element != ElementKind::hex8) break;
    all.emplace_back("weight", [&run, element] { weight(run, element); });
    all.emplace_back("halves", [&run, element] { halves(run, element); });
    for (const double friction : {0.0, 0.5})
      all.emplace_back("collision", [&run, element, friction] { collision(run, element, friction); });
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    run.show(static_cast<double>(i) / static_cast<double>(all.size()), all[i].first);
    try {
      all[i].second();
    } catch (const Error& error) {
      run.failed("figures that could be taken", all[i].first, error.what());
    }
  }
}

}  // namespace pliant::bench::contact
