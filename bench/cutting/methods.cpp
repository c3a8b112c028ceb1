// Part methods: virtual nodes, removal, decomposition and separation on the same cuts of the same tetrahedra.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "backends/choice/backends.h"
#include "bench/cutting/parts.h"
#include "geometry/disjoint_sets.h"
#include "geometry/vec.h"
#include "scene/blade_face.h"
#include "tearing/sweep_probe.h"

namespace pliant::bench {
namespace {

using nlohmann::json;

struct Comparison {
  std::string name;
  Scene scene;  ///< one body, tetrahedra in a lattice
  std::vector<std::vector<SweepTriangle>> cuts;
};

double lap(std::chrono::steady_clock::time_point& start) {
  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - start).count();
  start = now;
  return seconds;
}

Comparison block(bool quick) {
  Comparison c;
  c.name = "block";
  c.scene.name = "block";
  Body body;
  body.name = "block";
  body.surface = "block.obj";
  auto box = std::make_shared<TriangleMesh>();
  for (int a = 0; a < 8; ++a) box->vertices.push_back({0.12 * (a & 1), 0.06 * (a >> 1 & 1), 0.06 * (a >> 2 & 1)});
  box->triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  body.surface_in_memory = box;
  body.lattice.spacing = quick ? 0.02 : 0.01;
  body.element = ElementKind::tet4;
  body.material.set_moduli(Law::neo_hookean, Moduli::from_young(3000, 0.45));
  body.material.damping = 5;
  body.pointer = "/bodies/0";
  c.scene.bodies.push_back(body);
  c.cuts = {plane_sweep({0.0413, 0.03, 0.03}, {1, 0.15, 0.05}, 0.2), wavy_sweep({0.0836, 0.03, 0.03}, 0.06, 0.006),
            plane_sweep({0.06, 0.0317, 0.03}, {0.1, 1, 0.05}, 0.2), plane_sweep({0.06, 0.03, 0.0282}, {0.05, -0.1, 1}, 0.2),
            plane_sweep({0.1043, 0.02, 0.03}, {1, -0.6, 0.3}, 0.2)};
  return c;
}

Comparison liver(const CuttingRun& run) {
  Comparison c;
  c.name = "liver";
  c.scene = load_scene(run.options.scenes / "cut_liver.json");
  c.scene.name = "liver";
  drop_blades(c.scene);
  Body& body = c.scene.bodies[0];
  body.element = ElementKind::tet4;
  body.prescribed.clear();
  if (run.options.quick) body.lattice.nodes = 500;
  c.cuts = {plane_sweep({0.0113, 0, 0}, {1, 0.1, 0.05}, 0.5), wavy_sweep({0.0531, 0, 0}, 0.15, 0.01),
            plane_sweep({-0.0417, 0, 0}, {1, 0.3, -0.2}, 0.5), plane_sweep({0, 0.0083, 0}, {0.1, 1, 0.1}, 0.5),
            plane_sweep({0, 0, 0.0063}, {0.1, -0.1, 1}, 0.5)};
  return c;
}

/// Move the pieces of body 0 away from its middle, to be seen.
void spread_pieces(Simulation& simulation) {
  const ModelBody& body = simulation.model().bodies[0];
  DisjointSets sets(body.rest.size());
  for (const auto& tet : body.tets) {
    for (const std::int32_t n : tet) sets.join(tet[0], n);
  }
  Vec3d middle{};
  std::map<std::int32_t, std::pair<Vec3d, double>> sum;
  for (std::size_t n = 0; n < body.rest.size(); ++n) {
    auto& [at, count] = sum[sets.find(static_cast<std::int32_t>(n))];
    at = vec::add(at, body.rest[n]);
    middle = vec::add(middle, vec::mul(body.rest[n], 1 / static_cast<double>(body.rest.size())));
    ++count;
  }
  const BufferId u = simulation.program().find("node_u");
  std::vector<double> texels = simulation.backend().read_reals(u);
  for (std::size_t n = 0; n < body.rest.size(); ++n) {
    const auto& [at, count] = sum.at(sets.find(static_cast<std::int32_t>(n)));
    const Vec3d away = vec::mul(vec::sub(vec::mul(at, 1 / count), middle), 0.3);
    for (std::size_t c = 0; c < 3; ++c) texels[4 * static_cast<std::size_t>(body.slot[n]) + c] = away[c];
  }
  simulation.backend().write_reals(u, texels);
}

void finish(const CuttingRun& run, json row, Simulation& simulation, double step_before) {
  row["ms_per_step_before"] = step_before;
  row["ms_per_step_after"] = ms_per_step(simulation, run.options.quick);
  row["backend"] = simulation.backend().info().name;
  run.rows.push_back(row);
}

std::unique_ptr<Simulation> start(const CuttingRun& run, const Comparison& c, std::shared_ptr<const Model> model) {
  Scene scene = c.scene;
  scene.dt = scene.safety * model->element_bound;
  const std::int64_t nodes = model->nodes();
  return std::make_unique<Simulation>(scene, std::move(model), open_backend(run.options.backend, nullptr, nodes),
                                      SimulationOptions{0, 64, false});
}

void draw(const CuttingRun& run, const Comparison& c, const std::string& method, Simulation& simulation) {
  if (!run.options.picture) return;
  spread_pieces(simulation);
  std::string name = c.name + "_" + method;
  std::replace(name.begin(), name.end(), ' ', '_');
  run.options.picture(name, simulation);
}

void virtual_nodes(const CuttingRun& run, const Comparison& c) {
  const auto model = std::make_shared<const Model>(build_model(c.scene));
  const BodyFigures before = figures_of(*model);
  std::unique_ptr<Simulation> simulation = start(run, c, model);
  const double step_before = ms_per_step(*simulation, run.options.quick);
  simulation = start(run, c, model);
  std::vector<CutTimes> times;
  for (const auto& sweep : c.cuts) {
    const CutReport report = simulation->cut(sweep);
    times.push_back({report.search, report.topology, report.surface, report.model, report.upload, report.step});
  }
  json row = cutting_row("methods", c.name, "virtual nodes", "tet4", static_cast<std::int64_t>(c.cuts.size()), before,
                         figures_of(simulation->model()), times);
  draw(run, c, "virtual nodes", *simulation);
  simulation = start(run, c, simulation->shared_model());
  finish(run, std::move(row), *simulation, step_before);
}

/// Boundary triangles that do not lie on the boundary before are faces of the cut.
void mark_cut(const ElementMesh& whole, BodyMesh& solid) {
  std::vector<SweepTriangle> outside;
  vec::Box box;
  for (const auto& t : boundary_of(whole)) outside.push_back({whole.nodes[t[0]], whole.nodes[t[1]], whole.nodes[t[2]]});
  for (const Vec3d& x : whole.nodes) box.extend(x);
  const double edge = mean_edge(whole);
  SweepProbe probe(box, edge, outside);
  for (const auto& t : solid.triangles) {
    Vec3d middle{}, nearest{};
    for (const std::int32_t v : t) middle = vec::add(middle, vec::mul(solid.surface[v], 1.0 / 3));
    solid.triangle_cut.push_back(probe.nearest(middle, 1e-6 * edge, nearest) ? 0 : 1);
  }
}

using Method = MethodResult (*)(const ElementMesh&, std::span<const SweepTriangle>);

void other_method(const CuttingRun& run, const Comparison& c, const std::string& name, Method method) {
  const ElementMesh whole = plain_mesh(make_body_mesh(c.scene.bodies[0]));
  const auto model = std::make_shared<const Model>(build_model(c.scene, {solid_of(whole)}));
  const BodyFigures before = figures_of(*model);
  std::unique_ptr<Simulation> simulation = start(run, c, model);
  const double step_before = ms_per_step(*simulation, run.options.quick);
  ElementMesh mesh = whole;
  std::vector<CutTimes> times;
  double distance = 0;
  std::shared_ptr<const Model> after = model;
  for (const auto& sweep : c.cuts) {
    CutTimes t;
    auto clock = std::chrono::steady_clock::now();
    MethodResult cut = method(mesh, sweep);
    mesh = std::move(cut.mesh);
    distance = std::max(distance, cut.distance);
    t.topology = lap(clock);
    BodyMesh solid = solid_of(mesh);
    t.surface = lap(clock);
    if (run.options.picture && &sweep == &c.cuts.back()) mark_cut(whole, solid);
    clock = std::chrono::steady_clock::now();
    after = std::make_shared<const Model>(build_model(c.scene, {std::move(solid)}));
    t.model = lap(clock);
    Scene scene = c.scene;
    scene.dt = scene.safety * after->element_bound;
    simulation = std::make_unique<Simulation>(scene, after, open_backend(run.options.backend, nullptr, after->nodes()),
                                              SimulationOptions{0, 64, false});
    clock = std::chrono::steady_clock::now();
    simulation->backend().load(simulation->program());  // once more: the first time compiles kernels
    t.upload = lap(clock);
    simulation->backend().extend(nullptr, simulation->surface_program());  // the load has dropped it
    times.push_back(t);
  }
  json row =
      cutting_row("methods", c.name, name, "tet4", static_cast<std::int64_t>(c.cuts.size()), before, figures_of(*after), times);
  row["least_quality"] = pliant::figures_of(mesh).least_quality;
  if (name == "separation") row["distance_in_edges"] = distance / mean_edge(whole);
  draw(run, c, name, *simulation);
  simulation = start(run, c, after);
  finish(run, std::move(row), *simulation, step_before);
}

MethodResult separate(const ElementMesh& mesh, std::span<const SweepTriangle> sweep) { return separate_crossed(mesh, sweep); }

}  // namespace

void measure_cut_methods(const CuttingRun& run) {
  double done = 0;
  for (const Comparison& c : {block(run.options.quick), liver(run)}) {
    const auto next = [&](const char* method) { run.show_progress(done++ / 8, c.name + ", " + method); };
    next("virtual nodes");
    virtual_nodes(run, c);
    next("removal");
    other_method(run, c, "removal", remove_crossed);
    next("decomposition");
    other_method(run, c, "decomposition", decompose_crossed);
    next("separation");
    other_method(run, c, "separation", separate);
  }
}

}  // namespace pliant::bench
