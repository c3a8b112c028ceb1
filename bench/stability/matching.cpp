// Sweeps of shape matching and of its coupling to finite elements.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/stability/sweeps.h"
#include "pliant/error.h"

namespace pliant::bench::stability {
namespace {

using nlohmann::json;

constexpr Vec3d kCube{kEdge, kEdge, kEdge};

/// E H^2 / (alpha rho d^2) of a pull: the variance of a window of 2 w + 1 nodes.
double pull_stiffness(int width) { return (width * width + width) / 3.0; }

/// How a column behaves under its own weight along x, switched on at once.
struct Swing {
  double stiffness = 0;  ///< of its middle third, from the mean displacements [Pa]
  double tip = 0;        ///< from the mean displacement of its end [Pa]
  double overshoot = 0;  ///< largest over mean displacement
  double jitter = 0;     ///< rms of the second differences over four times the rms of the swing: 1 where every step turns back
  Ending end;
};

Swing swing(const Specimen& specimen, double dt, double length, double gravity, int steps) {
  const auto simulation = simulate(specimen, dt, false, false);
  const ModelBody& body = specimen.model->bodies[0];
  const auto nearest = [&](double x) {
    std::size_t best = 0;
    for (std::size_t n = 0; n < body.rest.size(); ++n) {
      if (std::abs(body.rest[n][0] - x) < std::abs(body.rest[best][0] - x) - 1e-9) best = n;
    }
    return best;
  };
  const std::size_t tip = nearest(length), low = nearest(length / 3), high = nearest(2 * length / 3);
  std::vector<double> x;
  Swing s;
  double sum = 0, most = 0, middle = 0;
  for (int i = 0; i < steps && !s.end.diverged; ++i) {
    s.end = stability::run(*simulation, 1);
    const std::vector<Vec3d> u = simulation->displacements(0);
    x.push_back(u[tip][0]);
    middle += u[high][0] - u[low][0];
    sum += x.back();
    most = std::max(most, x.back());
  }
  const double mean = sum / static_cast<double>(x.size());
  double rough = 0, wide = 0;
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    rough += std::pow(x[i + 1] - 2 * x[i] + x[i - 1], 2);
    wide += std::pow(x[i] - mean, 2);
  }
  s.tip = 1000 * gravity * length * length / (2 * mean);
  // The mean stress of the middle third is the weight of half the bar.
  s.stiffness = 1000 * gravity * length / 2 * (length / 3) / (middle / static_cast<double>(x.size()));
  s.overshoot = most / mean;
  s.jitter = std::sqrt(rough / wide) / 4;
  return s;
}

void write_each(Simulation& simulation, const std::string& buffer, double value) {
  const BufferId id = simulation.program().find(buffer);
  if (id < 0) return;
  simulation.backend().write_reals(
      id, std::vector<double>(simulation.program().buffers[static_cast<std::size_t>(id)].count, value));
}

/// Whether noise stays small over `steps` steps once `change` has been made to a simulation that starts at rest.
bool quiet(const Specimen& specimen, double dt, const std::function<void(Simulation&)>& change, int steps) {
  const auto simulation = simulate(specimen, dt, true);
  change(*simulation);
  const double noise = 1e-6 * kEdge;
  place(*simulation, {}, noise);
  simulation->advance(steps);
  double grown = 0;
  for (const Vec3d& u : simulation->displacements(0)) {
    for (const double c : u) grown = std::isfinite(c) ? std::max(grown, std::abs(c)) : HUGE_VAL;
  }
  return !simulation->divergence() && grown < 1e3 * noise;
}

Specimen hybrid(double density, const std::function<void(DeformationModel&)>& change) {
  Scene scene;
  scene.bodies = {body_of(Method::hybrid, material(kYoung, 0.3, density), 4 * kEdge)};
  scene.bodies[0].fixed = {held(0, 0)};
  change(scene.bodies[0].model);
  return make_specimen(scene, {{{8, 2, 2}, kCube}});
}

double lightest_interface_node(const Model& model) {
  double mass = HUGE_VAL;
  const FlsmBatch& b = model.flsm[0];
  for (std::int32_t i = b.own; i < b.own + b.interface; ++i) mass = std::min(mass, model.mass[b.slot[i]]);
  return mass;
}

/// What the engine says to this beta: its refusal, or how it went.
Finding answer(const Specimen& specimen, double dt, double beta) {
  Specimen asked = specimen;
  auto model = std::make_shared<Model>(*specimen.model);
  model->flsm[0].settings.beta = beta;
  asked.model = model;
  Finding f;
  try {
    const auto simulation = simulate(asked, dt, false, true);
    place(*simulation, {}, 1e-3 * kEdge);
    const Ending end = stability::run(*simulation, 4000);
    f.outcome = end.words();
    f.diagnosis = end.message;
    f.exit_code = end.exit_code();
  } catch (const Error& error) {
    f.outcome = "refused at the start";
    f.diagnosis = error.what();
    f.exit_code = 2;
  }
  return f;
}

/// The shortest step at which noise grows, looked for on a grid from half of `guess` on: a resonance may leave longer steps
/// stable.
Limit first_growth(const Specimen& specimen, double guess, int steps) {
  const auto stable = [&](double dt) {
    return quiet(
        specimen, dt, [](Simulation&) {}, steps);
  };
  const Bracket found = first_bad(0.5 * guess, 4 * guess, 1.03, 2e-3, stable);
  return {found.good, found.reached};
}

}  // namespace

void sweep_matching(SweepRun& run) {
  const auto alphas = run.pick<double>({0.05, 0.1, 0.25, 0.5, 0.75, 1}, {0.25, 1});
  const auto steps = run.pick<double>({5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 1.0 / 60}, {1e-3, 1e-2});
  const auto widths = run.pick<int>({1, 2, 3}, {1, 2});
  for (const int width : widths) {
    Scene scene;
    scene.bodies = {body_of(Method::flsm, material(kYoung, 0.3))};
    scene.bodies[0].fixed = {held(0, 0)};
    scene.bodies[0].model.width = width;
    const double length = 12 * kEdge;
    const Specimen bar = make_specimen(scene, {{{12, 2, 2}, kCube}});
    for (const double alpha : alphas) {
      for (const double dt : steps) {
        run.show(fmt::format("w = {}, alpha {}, dt {} s", width, alpha, dt));
        const double young = pull_stiffness(width) * alpha * 1000 * kEdge * kEdge / (dt * dt);
        Specimen specimen = bar;
        auto model = std::make_shared<Model>(*bar.model);
        model->flsm[0].settings.alpha = alpha;
        specimen.model = model;
        specimen.scene.gravity = {0.02 * young / (1000 * length), 0, 0};  // the end sinks by a hundredth of the length
        const double period = 4 * length / std::sqrt(young / 1000) / dt;  // of the first mode, in steps
        const Swing s = swing(specimen, dt, length, specimen.scene.gravity[0], static_cast<int>(4 * period));
        run.add(Method::flsm, json{{"alpha", alpha}, {"dt", dt}, {"width", width}},
                {"Young's modulus [Pa]", young, s.stiffness, s.end.diverged, s.end.diverged ? s.end.words() : "went on",
                 s.end.message, s.end.exit_code()},
                {{"tip", s.tip}, {"overshoot", s.overshoot}, {"jitter", s.jitter}, {"finite", s.end.finite}});
      }
    }
  }
}

void sweep_alpha(SweepRun& run) {
  const double dt = 0.01;
  for (const int width : run.pick<int>({1, 2, 3}, {1, 2})) {
    run.show(fmt::format("w = {}", width));
    Scene scene;
    scene.bodies = {body_of(Method::flsm, material(kYoung, 0.3))};
    scene.bodies[0].fixed = {held(0, 0)};
    scene.bodies[0].model.width = width;
    const Specimen specimen = make_specimen(scene, {{{8, 4, 4}, kCube}});
    const auto stable = [&](double alpha) {
      return quiet(
          specimen, dt, [&](Simulation& s) { write_each(s, "flsm_alpha", alpha); }, 400);
    };
    const double measured = bisect(1, 8, 1e-3, stable);
    Specimen heavy = specimen;
    heavy.scene.gravity = {0, -9.81, 0};
    const auto simulation = simulate(heavy, dt);
    write_each(*simulation, "flsm_alpha", 1.05 * measured);
    const Ending past = stability::run(*simulation, 20000);
    // omega^2 H^2 = alpha (1 - g), where the goals of a mode are g times its displacements, -1 < g <= 1: at most 4 at alpha = 4
    // where g is 0, which no scene may ask for.
    run.add(Method::flsm, json{{"width", width}}, {"alpha", 4.0, measured, true, past.words(), past.message, past.exit_code()},
            {{"finite", past.finite}, {"allowed", 1}});
  }
}

void sweep_beta(SweepRun& run) {
  const auto ratios = run.pick<double>({0.01, 0.1, 0.3, 1, 3, 10, 100}, {0.1, 1});
  const auto densities = run.pick<double>({10, 1000, 100000}, {1000});
  for (const bool conservative : {true, false}) {
    for (const double density : densities) {
      const auto with_beta = [&](double beta) {
        return hybrid(density, [&](DeformationModel& m) {
          m.beta = beta;
          m.conservative = conservative;
        });
      };
      const Specimen loose = with_beta(1e-9);
      const double elements = estimated_step(loose), mass = lightest_interface_node(*loose.model);
      for (const double ratio : ratios) {
        run.show(fmt::format("density {}, beta {} m omega^2", density, ratio));
        const double beta = ratio * mass * 4 / (elements * elements);
        const Specimen specimen = with_beta(beta);
        const double estimate = estimated_step(specimen);
        const Limit limit = measured_step(specimen, estimate);
        // A step that beta does not stand is refused; so is a beta that the step does not stand.
        Finding f = answer(specimen, 1.02 * limit.value, beta);
        f.quantity = "dt [s]";
        f.predicted = estimate;
        f.measured = limit.value;
        f.reached = limit.reached;
        run.add(Method::hybrid,
                json{{"density", density}, {"beta_ratio", ratio}, {"coupling", conservative ? "conservative" : "one-sided"}}, f,
                {{"mass", mass}, {"beta", beta}, {"dt_over_elements", limit.value / elements}});
      }
    }
  }
}

void sweep_subcycling(SweepRun& run) {
  const auto counts = run.pick<int>({1, 2, 3, 4, 8, 16}, {1, 4});
  const auto alphas = run.pick<double>({0.25, 0.5, 1}, {0.5});
  for (const bool extrapolate : {false, true}) {
    for (const double alpha : alphas) {
      for (const int n : counts) {
        run.show(fmt::format("{} goals, alpha {}, n = {}", extrapolate ? "extrapolated" : "held", alpha, n));
        const Specimen specimen = hybrid(1000, [&](DeformationModel& m) {
          m.alpha = alpha;
          m.substeps = n;
          m.extrapolate = extrapolate;
        });
        const double estimate = estimated_step(specimen);
        const Limit limit = first_growth(specimen, estimate, n == 1 ? 800 : 1600);
        Specimen heavy = specimen;
        heavy.scene.gravity = {0, -9.81, 0};
        const Ending past = run_past(heavy, 1.02 * limit.value, 20000);
        run.add(Method::hybrid, json{{"goals", extrapolate ? "extrapolated" : "held"}, {"alpha", alpha}, {"substeps", n}},
                {"dt [s]", estimate, limit.value, limit.reached, past.words(), past.message, past.exit_code()},
                {{"finite", past.finite}, {"latency", past.latency}});
      }
    }
  }
}

}  // namespace pliant::bench::stability
