#include "plan/plan_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "backends/choice/backends.h"
#include "backends/interface/timing.h"
#include "geometry/stopwatch.h"
#include "geometry/vec.h"
#include "mesh_io/mesh_io.h"
#include "model/nodes/whereabouts.h"
#include "pliant/error.h"
#include "scene/blade_face.h"
#include "simulation/simulation.h"
#include "statics/statics.h"

namespace pliant::planning {

double norm_of(const std::vector<Vec3d>& u) {
  double sum = 0;
  for (const Vec3d& v : u) sum += vec::dot(v, v);
  return std::sqrt(sum);
}

std::vector<Vec3d> difference(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  std::vector<Vec3d> out(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) out[i] = vec::sub(a[i], b[i]);
  return out;
}

double largest(const std::vector<Vec3d>& u) {
  double most = 0;
  for (const Vec3d& v : u) most = std::max(most, vec::norm(v));
  return most;
}

namespace {

constexpr double kMostShare = 0.2;  ///< of the time that is given, for one body to come to rest

std::vector<Vec3d> surface_of(const statics::Problem& problem, const std::vector<Vec3d>& u) {
  std::vector<Vec3d> out;
  for (const statics::SurfacePoint& p : problem.surface) {
    Vec3d sum{};
    for (std::size_t a = 0; a < p.nodes.size(); ++a) sum = vec::add(sum, vec::mul(u[p.nodes[a]], p.weights[a]));
    out.push_back(sum);
  }
  return out;
}

struct AtRest {
  std::vector<Vec3d> u;
  double frequency = 0;
  std::int64_t nodes = 0;
};

constexpr double kPatience = 0.75;  ///< share of the time that is given, before the first reference is given up

AtRest solve(const Scene& scene, const Size& size, std::int64_t nodes, const PlanOptions& options, const Stopwatch& start) {
  const Scene fine = reference_scene(scene, size, nodes);
  const Model model = build_model(fine);
  const statics::Problem problem = statics::problem_of(fine, model, 0);
  statics::Settings settings;
  settings.tolerance = 1e-7;
  settings.progress = [&](double load, int iteration, double) {
    if (options.detail) options.detail(fmt::format("{:.0f} % of the load, iteration {}", 100 * load, iteration));
    if (start.seconds() < kPatience * options.seconds) return;
    throw Error(
        ErrorCode::bad_input,
        fmt::format(
            "the reference of {} nodes has taken {:.0f} s and stands at {:.0f} % of the load: a body that buckles takes "
            "many small steps; expected smaller loads, or a coarser reference (--reference)",
            problem.mesh.nodes.size(), start.seconds(), 100 * load));
  };
  const statics::Solution s = statics::solve(problem, settings);
  if (!s.converged)
    throw Error(ErrorCode::bad_input,
                fmt::format("the reference of {} nodes did not converge: {}", problem.mesh.nodes.size(), s.failure));
  double inertia = 0;
  for (std::size_t n = 0; n < s.displacement.size(); ++n)
    inertia += model.mass[model.bodies[0].slot[n]] * vec::dot(s.displacement[n], s.displacement[n]);
  if (!(inertia > 0))
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: nothing moves this body, so there is no error to plan for", scene.file.string()));
  return {surface_of(problem, s.displacement), std::sqrt(2 * s.strain_energy / inertia),
          static_cast<std::int64_t>(problem.mesh.nodes.size())};
}

std::vector<Vec3d> moved(Simulation& simulation) {
  return difference(simulation.surface_positions(), simulation.model().surface.rest);
}

void go(Simulation& simulation, double until) {
  while (simulation.time() < until && !simulation.divergence()) {
    const auto left = static_cast<std::int64_t>(std::ceil((until - simulation.time()) / simulation.dt()));
    simulation.advance(std::clamp<std::int64_t>(left, 1, 1024));
  }
}

}  // namespace

double end_of_curves(const Scene& scene) {
  double end = 0;
  const auto note = [&](const Curve& c) { end = std::max(end, c.end()); };
  note(scene.gravity_curve);
  for (const Prescribed& p : scene.bodies[0].prescribed) note(p.curve);
  for (const Force& f : scene.bodies[0].forces) note(f.curve);
  for (const Pressure& p : scene.bodies[0].pressures) note(p.curve);
  return end;
}

namespace {

/// Whether every selection of the scene holds something in coarse and finer lattices.
bool all_hold(const Scene& scene, const Size& size) {
  for (const std::int64_t nodes : {300, 700, 1500}) {
    try {
      static_cast<void>(build_model(reference_scene(scene, size, nodes)));
    } catch (const Error&) {
      return false;
    }
  }
  return true;
}

}  // namespace

Size size_of(const Scene& scene) {
  const Body& body = scene.bodies[0];
  const bool held = body.surface_in_memory != nullptr;
  const TriangleMesh mesh = held ? *body.surface_in_memory : read_surface(body.surface, body.scale);
  Size size{std::abs(signed_volume(mesh)), 0};
  for (const auto& t : mesh.triangles) {
    const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    size.area += vec::norm(vec::cross(vec::sub(b, a), vec::sub(c, a))) / 2;
  }
  const vec::Box box = bounds_of(mesh.vertices);
  size.extent = vec::mul(vec::sub(box.upper, box.lower), held ? body.scale : 1);
  if (held) {
    size.volume *= body.scale * body.scale * body.scale;
    size.area *= body.scale * body.scale;
  }
  for (int axis = 0; axis < 3 && !all_hold(scene, size); ++axis) size.fitted = axis;
  if (!all_hold(scene, size)) size.fitted = -1;
  return size;
}

Scene configured(const Scene& scene, const Size& size, ElementKind element, std::int64_t nodes) {
  Scene out = scene;
  Body& body = out.bodies[0];
  body.element = element;
  double low = 0, high = std::cbrt(8 * (size.volume + size.area * std::sqrt(size.area)));
  for (int i = 0; i < 100; ++i) {
    const double h = (low + high) / 2;
    (size.volume / (h * h * h) + size.area / (2 * h * h) > static_cast<double>(nodes) ? low : high) = h;
  }
  if (size.fitted >= 0) {
    const double length = size.extent[size.fitted];
    high = length / std::max(1.0, std::round(length / high));
  }
  body.lattice = {high, 0};
  body.model = DeformationModel{};
  out.solver = StaticSolver{};
  out.relaxation = Relaxation{};
  out.dt = 0;
  drop_blades(out);
  return out;
}

Scene reference_scene(const Scene& scene, const Size& size, std::int64_t nodes) {
  return configured(scene, size, reference_element(), nodes);
}

Reference make_reference(const Scene& scene, const Size& size, const PlanOptions& options) {
  const Stopwatch start;
  Reference out;
  for (std::int64_t nodes = options.reference_nodes;; nodes *= 2) {
    const Stopwatch began;
    std::vector<AtRest> answers;
    // Spacings that are no multiples of each other, so that the rims of what is held fall differently between the nodes.
    try {
      for (const double share : {1.0, 0.8, 0.64}) {
        answers.push_back(solve(scene, size, std::llround(share * static_cast<double>(nodes)), options, start));
      }
    } catch (const Error&) {
      if (out.nodes == 0) throw;
      break;  // a finer reference is not found: the one there is stands, with its uncertainty
    }
    out.u.assign(answers[0].u.size(), Vec3d{});
    for (const AtRest& a : answers) {
      for (std::size_t i = 0; i < out.u.size(); ++i)
        out.u[i] = vec::add(out.u[i], vec::mul(a.u[i], 1.0 / static_cast<double>(answers.size())));
    }
    out.norm = norm_of(out.u);
    double square = 0;
    for (const AtRest& a : answers) square += std::pow(norm_of(difference(a.u, out.u)), 2);
    out.uncertainty = std::sqrt(square / static_cast<double>(answers.size() - 1)) / out.norm;
    out.frequency = answers[0].frequency;
    out.nodes = answers[0].nodes;
    // Twice the nodes take about four times as long.
    const bool enough = out.uncertainty <= options.tolerance / 2 && out.nodes >= options.most_nodes;
    if (enough || start.seconds() + 4 * began.seconds() > options.reference_seconds) break;
  }
  out.seconds = start.seconds();
  return out;
}

void measure_time(Trial& trial, const PlanOptions& options) {
  const auto model = std::make_shared<const Model>(build_model(trial.scene));
  trial.nodes = model->nodes();
  trial.spacing = model->bodies[0].spacing;
  Simulation simulation(trial.scene, model, open_backend(options.backend, nullptr, trial.nodes));
  constexpr int kBatches = 9;
  const std::int64_t warm_up = 64;
  simulation.advance(warm_up);
  std::vector<double> times;
  std::int64_t steps = 64;
  for (int b = 0; b < kBatches && !simulation.divergence(); ++b) {
    const Stopwatch start;
    const std::int64_t done = simulation.advance(steps);
    const double seconds = start.seconds();
    if (done > 0) times.push_back(seconds / static_cast<double>(done));
    if (b == 0 && seconds < 0.02)
      steps = std::min<std::int64_t>(1024, static_cast<std::int64_t>(64 * 0.02 / std::max(1e-5, seconds)));
  }
  if (simulation.divergence()) trial.remark = simulation.divergence()->message();
  if (times.empty()) return;
  trial.dt = simulation.dt();
  trial.ms_per_step = 1e3 * summary(times).median;
  trial.ms_per_frame = trial.ms_per_step * options.frame / trial.dt;
}

void measure_error(Trial& trial, const Reference& reference, const PlanOptions& options) {
  const Stopwatch start;
  Scene scene = trial.scene;
  const bool relaxes = scene.bodies[0].model.type == ModelType::tled;
  if (relaxes) {
    scene.relaxation.enabled = true;
    scene.relaxation.tolerance = std::clamp(options.tolerance / 100, 2e-5, 1e-4);  // float gets no further
  } else {
    // Mass damping that is critical for the slowest motion: the rest does not depend on it.
    for (Inclusion& i : scene.bodies[0].inclusions) i.material.damping = 2 * reference.frequency;
    scene.bodies[0].material.damping = 2 * reference.frequency;
  }
  Simulation simulation(scene, open_backend(options.backend, nullptr, trial.nodes));
  bool rest = false;
  if (relaxes) {
    while (!simulation.at_equilibrium() && !simulation.divergence() && start.seconds() < kMostShare * options.seconds)
      simulation.advance(1024);
    rest = simulation.at_equilibrium();
  } else {
    const double beat = 2 / reference.frequency, small = std::min(1e-3, options.tolerance / 20);
    go(simulation, end_of_curves(scene) + beat);
    std::vector<Vec3d> last = moved(simulation);
    while (!rest && !simulation.divergence() && start.seconds() < kMostShare * options.seconds) {
      go(simulation, simulation.time() + beat);
      std::vector<Vec3d> now = moved(simulation);
      rest = norm_of(difference(now, last)) <= small * reference.norm;
      last = std::move(now);
    }
  }
  if (simulation.divergence()) {
    trial.remark = simulation.divergence()->message();
    return;
  }
  if (!rest) {
    trial.remark = fmt::format("not at rest after {} steps", simulation.step());
    return;
  }
  const std::vector<Vec3d> miss = difference(moved(simulation), reference.u);
  trial.error = norm_of(miss) / reference.norm;
  trial.error_max = largest(miss) / largest(reference.u);
}

}  // namespace pliant::planning
