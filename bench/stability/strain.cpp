// Sweeps of large strain: slow, from a bad start, and at once.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/stability/sweeps.h"

namespace pliant::bench::stability {
namespace {

using nlohmann::json;

constexpr double kPoisson = 0.3;
constexpr std::array<int, 3> kCells{4, 2, 2};
constexpr double kLength = kCells[0] * kEdge, kSide = kCells[1] * kEdge;

/// A column that keeps its width, x = 0 held, and its end moved to `stretch` times its length over `duration` [s]; 0: at once.
Specimen column(Method method, Law law, double stretch, double duration) {
  Scene scene;
  Body body = body_of(method, material(kYoung, kPoisson, 1000, law), 0.5 * kLength);
  body.material.damping = 20;
  body.fixed = {roller(0, 0), roller(1, 0), roller(1, kSide), roller(2, 0), roller(2, kSide)};
  Prescribed end;
  end.where = face(0, kLength);
  end.displacement[0] = (stretch - 1) * kLength;
  if (duration > 0) {
    end.curve.kind = Curve::Kind::ramp;
    end.curve.duration = duration;
  }
  body.prescribed = {end};
  scene.bodies = {body};
  return make_specimen(scene, {{kCells, {kEdge, kEdge, kEdge}}});
}

/// The end of `column` when it moves evenly.
State stretched(const Model& model, double stretch) {
  return state_of(model, [&](const Vec3d& x) { return Vec3d{(stretch - 1) * x[0], 0, 0}; });
}

/// The stretch at which the engine's own estimate falls to the step.
Number stretch_for(const Specimen& specimen, double dt, double end) {
  const auto allowed = [&](double stretch) { return estimated_step(specimen, stretched(*specimen.model, stretch)) >= dt; };
  if (allowed(end)) return {};
  return bisect(1, end, 1e-3, allowed, true);
}

/// P = F S of a Saint-Venant-Kirchhoff column that keeps its width has its least value where 3 s^2 = 1: it buckles inwards.
Number predicted_stretch(Law law, bool fixed, const Specimen& specimen, double dt, double end) {
  Number limit;
  if (law == Law::saint_venant_kirchhoff && end < 1) limit = 1 / std::sqrt(3.0);
  if (!fixed) return limit;
  const Number by_step = stretch_for(specimen, dt, end);
  if (!by_step || !limit) return by_step ? by_step : limit;
  return end < 1 ? std::max(*by_step, *limit) : std::min(*by_step, *limit);
}

void add_stretch(SweepRun& run, Method method, Law law, double end, bool fixed) {
  run.show(fmt::format("{}, {}, to {} times, {} step", name_of(method), to_string(law), end, fixed ? "fixed" : "automatic"));
  const double duration = run.quick() ? 0.5 : 2;
  const Specimen specimen = column(method, law, end, duration);
  const double dt = method == Method::flsm ? 1e-3 : 0.9 * estimated_step(specimen);
  const auto simulation = simulate(specimen, fixed || method == Method::flsm ? dt : 0, false, has_elements(method));
  const auto at = [&](double time) { return 1 + (end - 1) * std::min(time / duration, 1.0); };
  Ending last;
  while (simulation->time() < duration && !simulation->divergence()) last = stability::run(*simulation, 64);
  const auto& d = simulation->divergence();
  Finding f{"stretch",
            has_elements(method) ? predicted_stretch(law, fixed, specimen, dt, end) : Number{},
            d ? at(d->time) : end,
            d.has_value(),
            last.words(),
            last.message,
            last.exit_code()};
  if (!d) f.outcome = "went on to the end";
  run.add(method,
          json{{"law", to_string(law)}, {"towards", end}, {"step", fixed ? "fixed" : "automatic"}, {"poisson", kPoisson}}, f,
          {{"finite", last.finite}, {"last_dt", simulation->dt()}, {"first_dt", dt}});
}

/// Where J of an element's point becomes 0 when one corner of a face moves inwards by so many edges.
Number push_of_inversion(Method method) {
  const double gauss = 0.5 * (1 + 1 / std::sqrt(3.0));
  if (method == Method::hex8) return 4;                               // the mean gradient of a corner is 1 / (4 d)
  if (method == Method::hex8full) return 1 / (gauss * gauss);         // at the corner's own point
  if (method == Method::flsm || method == Method::hybrid) return {};  // the end of the hybrid is shape matching's
  return 1;
}

/// One corner of the end, pushed inwards by `push` edges, let go.
State pushed(const Model& model, double push) {
  return state_of(model, [&](const Vec3d& x) {
    const bool corner = x[0] > kLength - 1e-6 && x[1] > kSide - 1e-6 && x[2] > kSide - 1e-6;
    return corner ? Vec3d{-push * kEdge, 0, 0} : Vec3d{};
  });
}

struct Return {
  bool back = false;
  Ending end;
};

/// Whether the body comes to rest in its rest shape.
Return let_go(const Specimen& specimen, double dt, const State& start) {
  const auto simulation = simulate(specimen, dt, false, true);
  place(*simulation, start);
  Return r;
  r.end = stability::run(*simulation, 4000);
  r.back = !r.end.diverged && r.end.largest * kLength < 0.05 * kEdge;
  return r;
}

std::string words_of(const Return& r) {
  if (r.back) return "returned";
  return r.end.diverged ? r.end.words() : r.end.finite ? "stayed in another shape" : "was not finite";
}

/// All coordinates multiplied: the mirror image of the body, flat, all in one point.
struct Start {
  const char* name;
  Vec3d factor;  ///< of the coordinates
};
constexpr Start kStarts[]{{"mirrored", {-1, 1, 1}}, {"flat", {1, 1, 0}}, {"a point", {0, 0, 0}}, {"inside out", {-1, -1, -1}}};

/// A load or motion of `bar` switched on at once: a traction over E, or a motion in edges.
Ending load_at_once(const Specimen& bar, double dt, double size, bool traction) {
  Specimen loaded = bar;
  auto model = std::make_shared<Model>(*bar.model);
  if (traction) {
    for (NodeForce& f : model->forces) {
      for (double& c : f.force) c *= size * kYoung * kSide * kSide;
    }
  } else {
    for (Constraint& c : model->constraints) {
      for (double& t : c.target) t *= size * kEdge;
    }
  }
  loaded.model = model;
  const auto simulation = simulate(loaded, dt, false, true);
  return stability::run(*simulation, 1500);
}

/// A bar held at x = 0 whose end takes a force of 1 N along x or is moved by 1 m, as a model to be scaled.
Specimen unit_load(Method method, bool traction) {
  Scene scene;
  Body body = body_of(method, material(kYoung, kPoisson), 0.5 * kLength);
  body.material.damping = 5;
  body.fixed = {held(0, 0)};
  if (traction) {
    Force force;
    force.where = face(0, kLength);
    force.force = {1, 0, 0};
    body.forces = {force};
  } else {
    Prescribed end;
    end.where = face(0, kLength);
    end.displacement = {1, 0, 0};
    body.prescribed = {end};
  }
  scene.bodies = {body};
  return make_specimen(scene, {{kCells, {kEdge, kEdge, kEdge}}});
}

/// The traction over E that, switched on at once, swings a free bar to the stretch at which the engine's own estimate falls to
/// the step: there the work of the load is the energy of the neo-Hookean bar, whose sides carry no stress.
Number traction_for(const Specimen& bar, double dt, double sign) {
  const Moduli m = Moduli::from_young(kYoung, kPoisson);
  const auto width = [&](double s) {  // mu (b - 1/b) + lambda (J - 1) s b = 0, J = s b^2
    return bisect(1e-3, 10, 1e-9, [&](double b) { return m.mu * (b - 1 / b) + m.lambda * (s * b * b - 1) * s * b < 0; });
  };
  const auto allowed = [&](double s) {
    const double b = width(s);
    const State u = state_of(*bar.model, [&](const Vec3d& x) {
      return Vec3d{(s - 1) * x[0], (b - 1) * (x[1] - 0.5 * kSide), (b - 1) * (x[2] - 0.5 * kSide)};
    });
    return estimated_step(bar, u) >= dt;
  };
  const double end = sign < 0 ? 0.05 : 20;
  if (allowed(end)) return {};
  const double s = bisect(1, end, 1e-3, allowed, true), b = width(s), j = s * b * b;
  const double energy = 0.5 * m.mu * (s * s + 2 * b * b - 3) - m.mu * std::log(j) + 0.5 * m.lambda * (j - 1) * (j - 1);
  return energy / std::abs(s - 1) / kYoung;
}

void add_load(SweepRun& run, Method method, const Specimen& bar, bool traction, double sign, bool fixed) {
  const double estimate = method == Method::flsm ? 0 : estimated_step(bar);
  const double dt = method == Method::flsm ? 1e-3 : fixed ? 0.9 * estimate : 0;
  const double most = traction ? 100 : 20;
  const auto survives = [&](double size) {
    const Ending end = load_at_once(bar, dt, sign * size, traction);
    return !end.diverged && end.finite;
  };
  Finding f;
  f.quantity = traction ? "traction over E" : "motion in edges";
  // A layer of elements pressed by its own thickness has no volume left; tension and tractions have no such limit.
  const bool pressed_elements = sign < 0 && method != Method::flsm && method != Method::hybrid;
  if (!traction && pressed_elements) f.predicted = 1;
  if (traction && fixed && has_elements(method)) f.predicted = traction_for(bar, dt, sign);
  const Bracket size = first_bad(0.01, most, run.quick() ? 1.5 : 1.2, run.quick() ? 0.05 : 0.01, survives);
  f.reached = size.reached;
  f.measured = size.good;
  const Ending past = load_at_once(bar, dt, sign * size.bad, traction);
  f.outcome = f.reached ? past.words() : "went on";
  f.diagnosis = f.reached ? past.message : "";
  f.exit_code = f.reached ? past.exit_code() : 0;
  run.add(method,
          json{{"kind", traction ? "traction" : "motion"},
               {"direction", sign < 0 ? "pressed" : "pulled"},
               {"step", fixed ? "fixed" : "automatic"}},
          f, {{"finite", past.finite}});
}

}  // namespace

void sweep_stretch(SweepRun& run) {
  for (const Method method : kMethods) {
    for (const double end : {0.05, 5.0}) {
      for (const bool fixed : {true, false}) {
        if (method == Method::flsm && !fixed) continue;
        add_stretch(run, method, Law::neo_hookean, end, fixed);
        if (method != Method::tet4 && method != Method::hex8) continue;
        add_stretch(run, method, Law::isochoric_neo_hookean, end, fixed);
        add_stretch(run, method, Law::saint_venant_kirchhoff, end, fixed);
      }
    }
  }
}

void sweep_inversion(SweepRun& run) {
  for (const Method method : kMethods) {
    run.show(name_of(method));
    Specimen specimen = clamped(method, {kCells, {kEdge, kEdge, kEdge}}, material(kYoung, kPoisson));
    auto model = std::make_shared<Model>(*specimen.model);
    std::fill(model->damping.begin(), model->damping.end(), 60.0);
    specimen.model = model;
    const double dt = method == Method::flsm ? 2e-3 : 0.9 * estimated_step(specimen);
    const auto returns = [&](double push) { return let_go(specimen, dt, pushed(*model, push)).back; };
    const Bracket push = first_bad(0.05, 10, run.quick() ? 1.3 : 1.1, 5e-3, returns);
    Finding f{"push in edges", push_of_inversion(method), push.good, push.reached, "", "", 0};
    const Return past = let_go(specimen, dt, pushed(*model, push.bad));
    f.outcome = words_of(past);
    f.diagnosis = past.end.message;
    f.exit_code = past.end.exit_code();
    run.add(method, json{{"start", "a corner pushed in"}}, f, {{"finite", past.end.finite}});
    for (const Start& start : kStarts) {
      const Return r = let_go(specimen, dt, state_of(*model, [&](const Vec3d& x) {
                                if (x[0] < 1e-6) return Vec3d{};
                                const Vec3d centre{0.5 * kLength, 0.5 * kSide, 0.5 * kSide};
                                Vec3d u{};
                                for (int c = 0; c < 3; ++c) u[c] = (start.factor[c] - 1) * (x[c] - centre[c]);
                                return u;
                              }));
      run.add(method, json{{"start", start.name}},
              {"returned (1) or not (0)", method == Method::flsm ? Number{} : Number{0}, r.back ? 1.0 : 0.0, !r.back,
               words_of(r), r.end.message, r.end.exit_code()},
              {{"finite", r.end.finite}});
    }
  }
}

void sweep_load(SweepRun& run) {
  for (const Method method : kMethods) {
    for (const bool traction : {true, false}) {
      const Specimen bar = unit_load(method, traction);
      for (const double sign : {-1.0, 1.0}) {
        for (const bool fixed : {true, false}) {
          if (method == Method::flsm && !fixed) continue;
          run.show(fmt::format("{}, {}, {}, {} step", name_of(method), traction ? "traction" : "motion",
                               sign < 0 ? "pressed" : "pulled", fixed ? "fixed" : "automatic"));
          add_load(run, method, bar, traction, sign, fixed);
        }
      }
    }
  }
}

}  // namespace pliant::bench::stability
