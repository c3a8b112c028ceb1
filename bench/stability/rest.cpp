// Sweeps of bodies near rest: hourglass energy in bending, and drift.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/stability/sweeps.h"
#include "simulation/measure/energy.h"

namespace pliant::bench::stability {
namespace {

using nlohmann::json;

/// A cantilever ten times as long as thick, `layers` cells through the thickness and one wide, at nu = 0.
Specimen cantilever(int layers, double hourglass) {
  const double thickness = 0.02, edge = thickness / layers;
  Material m = material(kYoung, 0);
  m.hourglass = hourglass;
  Scene scene;
  scene.bodies = {body_of(Method::hex8, m)};
  scene.bodies[0].fixed = {held(0, 0)};
  scene.gravity = {0, -0.02, 0};  // the end sinks by a hundredth of the length or so
  scene.relaxation = {true, 1e-4, 60000};
  return make_specimen(scene, {{{10 * layers, layers, 1}, {edge, edge, edge}}});
}

State displacements(const Simulation& simulation) {
  std::vector<std::vector<Vec3d>> bodies;
  for (std::size_t b = 0; b < simulation.model().bodies.size(); ++b) bodies.push_back(simulation.displacements(b));
  return by_slot(simulation.model(), bodies);
}

double largest_difference(const State& a, const State& b) {
  double largest = 0;
  for (std::size_t s = 0; s < a.size(); ++s) {
    for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(a[s][c] - b[s][c]));
  }
  return largest;
}

}  // namespace

void sweep_hourglass(SweepRun& run) {
  const auto factors = run.pick<double>({0, 0.1, 0.3, 1, 3}, {0, 1});
  const auto counts = run.pick<int>({1, 2, 3, 4, 6}, {1, 2});
  for (const double factor : factors) {
    for (const int layers : counts) {
      run.show(fmt::format("{} layers, factor {}", layers, factor));
      const Specimen specimen = cantilever(layers, factor);
      const auto simulation = simulate(specimen, 0, false, true);
      const Ending end = stability::run(*simulation, specimen.scene.relaxation.max_steps);
      const State u = displacements(*simulation);
      const Energies e = energies(*specimen.model, u, State(u.size()));
      // Of n layers, the strain at the middle of the layers holds 1 - 1/n^2 of the bending energy; the rest is the hourglass's.
      const double rest = factor / (layers * layers), share = e.hourglass / (e.hourglass + e.strain);
      const double even = 1 - 1.0 / (layers * layers);
      Finding f{"share of hourglass energy",
                rest + even > 0 ? rest / (rest + even) : 0.0,
                share,
                share > 0.1,
                "",
                end.message,
                end.exit_code()};
      if (!(e.hourglass + e.strain > 0)) f.measured = 0;
      const double inertia = std::pow(0.02, 3) / 12, beam = 1000 * 0.02 * 0.02 * std::pow(0.2, 4) / (8 * kYoung * inertia);
      const double sag = end.largest * 0.2 / beam;
      f.outcome = !simulation->at_equilibrium() ? "no equilibrium" : fmt::format("sags {:.3g} times as far as a beam", sag);
      run.add(Method::hex8, json{{"layers", layers}, {"factor", factor}}, f, {{"sag_over_beam", sag}, {"finite", end.finite}});
    }
  }
}

void sweep_rest(SweepRun& run) {
  for (const Method method : kMethods) {
    for (const bool heavy : {false, true}) {
      // Without a load nothing moves, from the first step on.
      const std::int64_t most = run.quick() ? 10'000 : heavy ? 1'000'000 : 20'000, first = most / 10;
      Specimen specimen = clamped(method, {{4, 1, 1}, {0.01, 0.01, 0.01}}, material(kYoung, 0.45));
      specimen.scene.gravity = {0, heavy ? -9.81 : 0, 0};
      auto model = std::make_shared<Model>(*specimen.model);
      std::fill(model->damping.begin(), model->damping.end(), 20.0);
      specimen.model = model;
      const double dt = method == Method::flsm ? 1e-3 : 0.9 * estimated_step(specimen);
      const auto simulation = simulate(specimen, dt, false, true);
      Ending end;
      State settled;
      for (int tenth = 1; tenth <= 10 && !end.diverged; ++tenth) {
        run.show(
            fmt::format("{}{}, {} of {} steps", name_of(method), heavy ? " under gravity" : "", (tenth - 1) * first, most));
        end = stability::run(*simulation, first);
        if (tenth == 1) settled = displacements(*simulation);
      }
      const double drift = largest_difference(displacements(*simulation), settled) / 0.01;
      run.add(method, json{{"gravity", heavy ? 9.81 : 0.0}, {"steps", most}},
              {"drift in edges", 0.0, drift, end.diverged || drift > 1e-3, end.diverged ? end.words() : "went on", end.message,
               end.exit_code()},
              {{"finite", end.finite}, {"deflection", end.largest}});
    }
  }
}

}  // namespace pliant::bench::stability
