// Sweeps of the stable step.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/stability/sweeps.h"

namespace pliant::bench::stability {
namespace {

using nlohmann::json;

Box bar(Method method) { return {{method == Method::hybrid ? 6 : 3, 2, 2}, {kEdge, kEdge, kEdge}}; }

/// Steps in which noise of a thousandth of an edge grows to an edge when the step is `share` of the limit: the highest mode
/// grows by exp(theta) per step, cosh theta = 2 share^2 - 1.
Number steps_to_an_edge(double share) {
  if (share <= 1) return {};
  return std::log(1e3) / std::acosh(2 * share * share - 1);
}

/// A bar whose half beyond the middle has another material.
Specimen two_materials(Method method, double density_ratio, double stiffness_ratio) {
  const Box box{{4, 2, 2}, {kEdge, kEdge, kEdge}};
  Scene scene;
  scene.bodies = {body_of(method, material(kYoung, 0.45))};
  scene.bodies[0].fixed = {held(0, 0)};
  Inclusion inclusion;
  inclusion.where = face(0, 0);
  inclusion.where.a[0] = 2 * kEdge;
  inclusion.where.b[0] = 100;
  inclusion.where.pointer = "/bodies/0/inclusions/0";
  inclusion.material = material(kYoung * stiffness_ratio, 0.45, 1000 * density_ratio);
  scene.bodies[0].inclusions = {inclusion};
  return make_specimen(scene, {box});
}

/// The end layer of a clamped bar holds `fill` of its volume.
Specimen with_sliver(Method method, double fill) {
  Scene scene;
  scene.bodies = {body_of(method, material(kYoung, 0.45), 2 * kEdge)};
  scene.bodies[0].fixed = {held(0, 0)};
  return make_specimen(scene, {{{4, 2, 2}, {kEdge, kEdge, kEdge}}}, fill, 3 * kEdge);
}

}  // namespace

void sweep_step(SweepRun& run) {
  const auto ratios = run.pick<double>({1, 2, 4, 8, 16}, {1, 4});
  const auto poissons = run.pick<double>({0, 0.3, 0.45, 0.49, 0.499, 0.4999}, {0.3, 0.499});
  for (const Method method : kMethods) {
    for (const double aspect : ratios) {
      if (aspect != 1 && (method == Method::hybrid || method == Method::flsm)) continue;  // lattices are made of cubes
      for (const double poisson : poissons) {
        run.show(fmt::format("{}, aspect ratio {}, nu {}", name_of(method), aspect, poisson));
        const json parameters{{"aspect", aspect}, {"poisson", poisson}};
        Box box = bar(method);
        box.edge[2] *= aspect;
        const Specimen specimen = clamped(method, box, material(kYoung, poisson));
        if (method != Method::flsm) {
          run.add_step_limit(method, parameters, specimen);
          continue;
        }
        // Without finite elements no step is too long: from a frame of a film to ten minutes.
        const Limit limit = measured_step(specimen, 600 / 1.7);
        run.add(method, json{{"aspect", 1}}, {"dt [s]", {}, limit.value, limit.reached, "went on", "", 0});
        break;
      }
    }
  }
}

void sweep_share(SweepRun& run) {
  const auto shares = run.pick<double>({0.5, 0.7, 0.8, 0.9, 0.95, 1, 1.02, 1.05, 1.1, 1.15, 1.2}, {0.9, 1, 1.05, 1.2});
  const std::int64_t most = run.quick() ? 2000 : 20000;
  for (const Method method : kMethods) {
    run.show(name_of(method));
    Specimen specimen = clamped(method, bar(method), material(kYoung, 0.45));
    // Shape matching alone has no stable step; the step of hex8 stands in.
    const Specimen measured_on =
        method == Method::flsm ? clamped(Method::hex8, bar(Method::hex8), material(kYoung, 0.45)) : specimen;
    const double estimate = estimated_step(measured_on);
    const double limit = method == Method::flsm ? HUGE_VAL : measured_step(specimen, estimate).value;
    specimen.scene.gravity = {0, -0.1, 0};  // little, so that the limit stays that of the rest shape
    for (const double share : shares) {
      const Ending end = run_past(specimen, share * estimate, most);
      Finding f{"steps until it stops",
                steps_to_an_edge(share * estimate / limit),
                static_cast<double>(end.steps),
                end.diverged,
                end.words(),
                end.message,
                end.exit_code()};
      run.add(method, json{{"share", share}}, f,
              {{"share_of_measured", share * estimate / limit}, {"latency", end.latency}, {"finite", end.finite}});
    }
  }
}

void sweep_poisson(SweepRun& run) {
  const auto poissons = run.pick<double>({0, 0.3, 0.45, 0.49, 0.499, 0.4999}, {0.3, 0.49});
  for (const Method method : kMethods) {
    if (method == Method::flsm) continue;  // has no Poisson's ratio
    for (const double poisson : poissons) {
      if (method == Method::hybrid && poisson != 0.3) continue;  // its shape matching keeps it from what relaxation looks for
      run.show(fmt::format("{}, nu {}", name_of(method), poisson));
      Specimen specimen = clamped(method, {{6, 2, 2}, {kEdge, kEdge, kEdge}}, material(kYoung, poisson));
      specimen.scene.gravity = {0, -1, 0};
      specimen.scene.relaxation = {true, 1e-4, method == Method::hybrid ? 20000 : 100000};
      const auto simulation = simulate(specimen, 0, false, true);
      const Ending end = stability::run(*simulation, specimen.scene.relaxation.max_steps);
      const bool found = simulation->at_equilibrium();
      run.add(method, json{{"poisson", poisson}},
              {"steps to equilibrium",
               {},
               static_cast<double>(end.steps),
               !found,
               found          ? "equilibrium found"
               : end.diverged ? end.words()
                              : "no equilibrium",
               end.message,
               end.exit_code()},
              {{"deflection", end.largest}, {"finite", end.finite}});
    }
  }
}

void sweep_contrast(SweepRun& run) {
  const auto ratios = run.pick<double>({1e-4, 1e-2, 1, 1e2, 1e4}, {1e-3, 1e3});
  for (const Method method : {Method::tet4, Method::tet4anp, Method::hex8, Method::hex8full}) {
    for (const double density : ratios) {
      for (const double stiffness : ratios) {
        run.show(fmt::format("{}, density {}, stiffness {}", name_of(method), density, stiffness));
        run.add_step_limit(method, json{{"density_ratio", density}, {"stiffness_ratio", stiffness}},
                           two_materials(method, density, stiffness));
      }
    }
  }
}

void sweep_bodies(SweepRun& run) {
  const auto masses = run.pick<double>({1e-4, 1e-2, 1, 1e2, 1e4}, {1e-3, 1e3});
  const auto sizes = run.pick<double>({0.01, 0.1, 1, 10, 100}, {0.1, 10});
  for (const Method method : {Method::tet4, Method::hex8, Method::hybrid}) {
    for (const double mass : masses) {
      for (const double size : sizes) {
        run.show(fmt::format("{}, mass {}, size {}", name_of(method), mass, size));
        const Box first = bar(method), second{first.cells, {kEdge * size, kEdge * size, kEdge * size}, {0, 1, 0}};
        Scene scene;
        scene.bodies = {body_of(method, material(kYoung, 0.45), 0.5 * first.size()[0]),
                        body_of(method, material(kYoung, 0.45, 1000 * mass / (size * size * size)), 0.5 * second.size()[0])};
        scene.bodies[0].fixed = {held(0, 0)};
        scene.bodies[1].fixed = {held(0, 0)};
        scene.bodies[1].name = "second";
        run.add_step_limit(method, json{{"mass_ratio", mass}, {"size_ratio", size}}, make_specimen(scene, {first, second}));
      }
    }
  }
}

void sweep_sliver(SweepRun& run) {
  const auto fills = run.pick<double>({1, 1e-1, 1e-2, 1e-3, 1e-4}, {1, 1e-4});
  for (const Method method : {Method::tet4, Method::tet4anp, Method::hex8, Method::hex8full, Method::hybrid}) {
    for (const double fill : fills) {
      run.show(fmt::format("{}, fill {}", name_of(method), fill));
      run.add_step_limit(method, json{{"fill", fill}}, with_sliver(method, fill));
    }
  }
}

}  // namespace pliant::bench::stability
