#include "bench/stability/trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>

#include "backends/twins/ref_backend.h"
#include "model/elements/body_mesh.h"
#include "pliant/error.h"

namespace pliant::bench::stability {
namespace {

/// A file that goes when this object goes.
class BoxFile {
 public:
  BoxFile(const Box& box, bool surface, bool tets) {
    static std::atomic<int> next{0};
    path_ = std::filesystem::temp_directory_path() /
            fmt::format("pliant-box-{:08x}-{}{}", std::random_device{}(), next++, surface ? ".obj" : ".vtk");
    std::ofstream out(path_);
    out.precision(17);
    surface ? write_surface(out, box) : write_volume(out, box, tets);
    if (!out.flush()) throw Error(ErrorCode::bad_input, fmt::format("{}: cannot be written", path_.string()));
  }
  ~BoxFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  BoxFile(const BoxFile&) = delete;
  BoxFile& operator=(const BoxFile&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  static void write_surface(std::ostream& out, const Box& box) {
    for (int a = 0; a < 8; ++a) {
      out << 'v';
      for (int c = 0; c < 3; ++c) out << ' ' << box.origin[c] + box.size()[c] * (a >> c & 1);
      out << '\n';
    }
    for (const char* side : {"1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"}) out << "f " << side << '\n';
  }

  static void write_volume(std::ostream& out, const Box& box, bool tets) {
    const int nx = box.cells[0], ny = box.cells[1], nz = box.cells[2];
    const int nodes = (nx + 1) * (ny + 1) * (nz + 1), cells = nx * ny * nz;
    out << "# vtk DataFile Version 3.0\nbox\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " << nodes << " double\n";
    for (int n = 0; n < nodes; ++n) {
      const std::array<int, 3> at{n % (nx + 1), n / (nx + 1) % (ny + 1), n / (nx + 1) / (ny + 1)};
      for (int c = 0; c < 3; ++c) out << box.origin[c] + at[c] * box.edge[c] << (c < 2 ? ' ' : '\n');
    }
    out << "CELLS " << cells * (tets ? 6 : 1) << ' ' << cells * (tets ? 30 : 9) << '\n';
    for (int e = 0; e < cells; ++e) {
      const int i = e % nx, j = e / nx % ny, k = e / nx / ny;
      const auto node = [&](int a) { return i + (a & 1) + (nx + 1) * (j + (a >> 1 & 1) + (ny + 1) * (k + (a >> 2 & 1))); };
      if (tets) {  // around the diagonal from corner 0 to 7, one for each order of the axes
        for (const auto& p : {std::array{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}})
          out << "4 " << node(0) << ' ' << node(p[0]) << ' ' << node(p[1]) << ' ' << node(7) << '\n';
      } else {
        out << 8;
        for (const int a : {0, 1, 3, 2, 4, 5, 7, 6}) out << ' ' << node(a);
        out << '\n';
      }
    }
    out << "CELL_TYPES " << cells * (tets ? 6 : 1) << '\n';
    for (int e = 0; e < cells * (tets ? 6 : 1); ++e) out << (tets ? "10\n" : "12\n");
  }

  std::filesystem::path path_;
};

std::vector<char> free_components(const Model& model) {
  std::vector<char> free(3 * static_cast<std::size_t>(model.slots), 0);
  for (std::size_t i = 0; i < free.size(); ++i) free[i] = model.mass[i / 3] > 0;
  for (const Constraint& held : model.constraints) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (held.axes & (1 << c)) free[3 * static_cast<std::size_t>(held.slot) + c] = 0;
    }
  }
  return free;
}

double extent(const Model& model) {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  for (const ModelBody& body : model.bodies) {
    for (const Vec3d& x : body.rest) {
      for (int c = 0; c < 3; ++c) {
        low[c] = std::min(low[c], x[c]);
        high[c] = std::max(high[c], x[c]);
      }
    }
  }
  return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
}

double centre_x(const BodyMesh& solid, std::size_t e) {
  double sum = 0;
  if (!solid.tets.empty()) {
    for (const std::int32_t n : solid.tets[e]) sum += solid.nodes[n][0] / 4;
  } else {
    for (const std::int32_t n : solid.hexes[e]) sum += solid.nodes[n][0] / 8;
  }
  return sum;
}

}  // namespace

const char* name_of(Method method) {
  constexpr std::array names{"tet4", "tet4anp", "hex8", "hex8full", "flsm", "hybrid"};
  return names[static_cast<std::size_t>(method)];
}

Material material(double young, double poisson, double density, Law law) {
  return make_material(law, Moduli::from_young(young, poisson), density);
}

Body body_of(Method method, const Material& material, double split) {
  constexpr std::array elements{ElementKind::tet4,     ElementKind::tet4anp, ElementKind::hex8,
                                ElementKind::hex8full, ElementKind::hex8,    ElementKind::hex8};
  Body body;
  body.name = name_of(method);
  body.element = elements[static_cast<std::size_t>(method)];
  body.material = material;
  body.model.pointer = "/bodies/0/model";
  if (method == Method::flsm) body.model.type = ModelType::flsm;
  if (method == Method::hybrid) {
    body.model.type = ModelType::hybrid;
    Selection region;
    region.kind = Selection::Kind::box;
    region.a = {-1e3, -1e3, -1e3};
    region.b = {split, 1e3, 1e3};
    region.pointer = "/bodies/0/model/region";
    body.model.region = region;
  }
  return body;
}

Selection face(int axis, double value) {
  Selection s;
  s.kind = Selection::Kind::box;
  s.a = {-100, -100, -100};
  s.b = {100, 100, 100};
  s.a[axis] = value - 1e-6;
  s.b[axis] = value + 1e-6;
  return s;
}

Fixed held(int axis, double value) { return {face(axis, value), {true, true, true}}; }
Fixed roller(int axis, double value) { return {face(axis, value), {axis == 0, axis == 1, axis == 2}}; }

Specimen make_specimen(Scene scene, const std::vector<Box>& boxes, double fill, double thin_beyond) {
  scene.inverted = Inverted::stop;  // what is measured is where a method fails
  std::vector<std::unique_ptr<BoxFile>> files;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    Body& body = scene.bodies[b];
    const Vec3d& edge = boxes.at(b).edge;
    const bool tets = body.element == ElementKind::tet4 || body.element == ElementKind::tet4anp;
    const bool lattice = !tets && edge[0] == edge[1] && edge[1] == edge[2];
    files.push_back(std::make_unique<BoxFile>(boxes[b], lattice, tets));
    (lattice ? body.surface : body.mesh) = files.back()->path();
    if (lattice) body.lattice.spacing = edge[0];
  }
  Specimen specimen;
  std::vector<BodyMesh> solids = make_body_meshes(scene);
  for (BodyMesh& solid : solids) {
    for (std::size_t e = 0; e < solid.fill.size() && fill < 1; ++e) {
      if (centre_x(solid, e) <= thin_beyond) continue;
      solid.fill[e] = fill;
      if (!solid.cells.empty()) solid.cells[e].fill = fill;
    }
  }
  specimen.model = std::make_shared<const Model>(build_model(scene, std::move(solids)));
  specimen.scene = std::move(scene);
  return specimen;
}

Specimen clamped(Method method, const Box& box, const Material& material) {
  Scene scene;
  scene.bodies = {body_of(method, material, 0.5 * box.size()[0])};
  scene.bodies[0].fixed = {held(0, box.origin[0])};
  return make_specimen(std::move(scene), {box});
}

State state_of(const Model& model, const std::function<Vec3d(const Vec3d&)>& u) {
  State state(static_cast<std::size_t>(model.slots));
  for (std::size_t s = 0; s < state.size(); ++s) {
    if (model.mass[s] > 0) state[s] = u(model.rest[s]);
  }
  return state;
}

std::unique_ptr<Simulation> simulate(const Specimen& specimen, double dt, bool in_double, bool estimate) {
  RefOptions backend;
  backend.double_precision = in_double;
  backend.threads = 1;
  backend.probe = false;
  SimulationOptions options;
  options.dt = dt;
  options.stable_step = estimate;
  return std::make_unique<Simulation>(specimen.scene, specimen.model, make_ref_backend(backend), options);
}

void place(Simulation& simulation, const State& u, double noise) {
  const Model& model = simulation.model();
  Backend& backend = simulation.backend();
  const BufferId id = simulation.program().find("node_u"), id_w = simulation.program().find("node_w");
  std::vector<double> texels = backend.read_reals(id), w = backend.read_reals(id_w);
  const std::vector<char> free = free_components(model);
  std::mt19937 random(5);
  for (std::size_t i = 0; i < free.size(); ++i) {
    const std::size_t t = 4 * (i / 3) + i % 3;
    if (!u.empty()) texels[t] = u[i / 3][i % 3];
    if (free[i]) texels[t] += noise * (2 * (static_cast<double>(random()) / 4294967295.0) - 1);
    w[t] = 0;
  }
  backend.write_reals(id, texels);
  backend.write_reals(id_w, w);
}

double estimated_step(const Specimen& specimen, const State& u) {
  const auto simulation = simulate(specimen, 1);
  place(*simulation, u);
  return simulation->estimate_stable_dt();
}

Limit measured_step(const Specimen& specimen, double guess, const State& u, int steps) {
  const Model& model = *specimen.model;
  const double noise = 1e-6 * model.shortest;
  Specimen weightless = specimen;
  weightless.scene.gravity = {};
  const State base = u.empty() ? State(static_cast<std::size_t>(model.slots)) : u;
  const std::vector<char> free = free_components(model);
  const auto quiet = [&](double dt) {
    const auto simulation = simulate(weightless, dt, true);
    place(*simulation, base, noise);
    simulation->advance(steps);
    if (simulation->divergence()) return false;
    const std::vector<double> now = simulation->backend().read_reals(simulation->program().find("node_u"));
    double grown = 0;
    for (std::size_t i = 0; i < free.size(); ++i) {
      if (free[i]) grown = std::max(grown, std::abs(now[4 * (i / 3) + i % 3] - base[i / 3][i % 3]));
    }
    return grown < 1e3 * noise;
  };
  double low = 0.5 * guess, high = 1.7 * guess;
  while (low > 1e-3 * guess && !quiet(low)) {
    high = low;
    low *= 0.5;
  }
  if (high > guess && quiet(high)) return {high, false};
  return {bisect(low, high, 5e-4, quiet), true};
}

std::string Ending::words() const {
  if (diverged) return fmt::format("stopped in step {}", steps);
  return fmt::format("{} after {} steps", finite ? "went on" : "was not finite", steps);
}

Ending run(Simulation& simulation, std::int64_t steps) {
  Ending ending;
  ending.steps = simulation.advance(steps);
  if (const auto& d = simulation.divergence()) {
    ending.diverged = true;
    ending.message = d->message();
    ending.steps = d->step;
    ending.latency = d->step - d->last_good_step;
  }
  for (std::size_t b = 0; b < simulation.model().bodies.size(); ++b) {
    for (const Vec3d& u : simulation.displacements(b)) {
      for (const double c : u) {
        ending.finite = ending.finite && std::isfinite(c);
        ending.largest = std::max(ending.largest, std::abs(c));
      }
    }
  }
  ending.largest /= extent(simulation.model());
  return ending;
}

Ending run_past(const Specimen& specimen, double dt, std::int64_t steps, const State& u) {
  const auto simulation = simulate(specimen, dt, false, true);
  place(*simulation, u, 1e-3 * specimen.model->shortest);
  return run(*simulation, steps);
}

Bracket first_bad(double low, double high, double factor, double tolerance, const std::function<bool(double)>& good) {
  Bracket found{low, low, true};
  while (found.bad < high) {
    found.bad = std::min(high, found.good * factor);
    if (!good(found.bad)) {
      while (found.bad - found.good > tolerance * found.bad) {
        const double middle = 0.5 * (found.good + found.bad);
        (good(middle) ? found.good : found.bad) = middle;
      }
      return found;
    }
    found.good = found.bad;
  }
  found.reached = false;
  return found;
}

double bisect(double low, double high, double tolerance, const std::function<bool(double)>& good, bool logarithmic) {
  while (std::abs(high - low) > tolerance * std::max(std::abs(high), std::abs(low))) {
    const double middle = logarithmic ? std::sqrt(low * high) : 0.5 * (low + high);
    (good(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace pliant::bench::stability
