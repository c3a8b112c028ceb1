// pliant info: what a scene holds and costs. Runs nothing but the Lanczos iteration of the stable step, on the cpu backend.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "backends/choice/backends.h"
#include "backends/interface/pass_table.h"
#include "cli/checked_model.h"
#include "cli/cli.h"
#include "cli/mesh_regions.h"
#include "cli/probes.h"
#include "geometry/vec.h"
#include "model/nodes/boundary_conditions.h"
#include "model/nodes/whereabouts.h"
#include "pliant/error.h"
#include "scene/keys.h"
#include "schedule/build_program.h"
#include "schedule/surface_program.h"
#include "simulation/simulation.h"
#include "simulation/step/coupling.h"

namespace pliant::cli {
namespace {

using Json = nlohmann::ordered_json;

struct InfoArguments {
  Common common;
  std::string scene;
  bool buffers = false;
};

const char* to_string(BufferType type) {
  switch (type) {
    case BufferType::real:
      return "real";
    case BufferType::real4:
      return "real4";
    case BufferType::int32:
      return "int32";
  }
  return "?";
}

constexpr BufferRole kRoles[]{BufferRole::constant, BufferRole::state, BufferRole::scratch, BufferRole::control};

const char* to_string(BufferRole role) {
  switch (role) {
    case BufferRole::constant:
      return "constant";
    case BufferRole::state:
      return "state";
    case BufferRole::scratch:
      return "scratch";
    case BufferRole::control:
      return "control";
  }
  return "?";
}

std::uint64_t bytes_of(const Buffer& buffer) { return 4 * static_cast<std::uint64_t>(buffer.values()); }

double per(std::uint64_t bytes, std::int64_t count) {
  return count > 0 ? static_cast<double>(bytes) / static_cast<double>(count) : 0;
}

class Info {
 public:
  Info(const InfoArguments& options, const Scene& scene, const Model& model, const std::vector<SurfaceCheck>& surfaces)
      : options_(options), scene_(scene), model_(model), surfaces_(surfaces) {}

  void print_all(const Program& program, double iterated_dt, double dt, const std::string& not_iterated) {
    json_ = {{"scene", scene_stem(options_.scene)},
             {"title", scene_.name},
             {"nodes", model_.nodes()},
             {"elements", model_.elements()}};
    line(fmt::format("{}: {}", scene_stem(options_.scene), scene_.name));
    line(fmt::format("nodes {}, elements {}, slots {}", model_.nodes(), model_.elements(), model_.slots));
    bodies();
    held();
    probes();
    stable_step(iterated_dt, dt, not_iterated);
    memory(program);
    passes(program);
    if (options_.buffers) buffers(program);
    options_.common.write(json_);
  }

 private:
  void line(const std::string& text) const { options_.common.print(text); }

  void bodies() {
    double mass = 0;
    for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
      const ModelBody& b = model_.bodies[i];
      const vec::Box box = bounds_of(b.rest);
      const Vec3d size = vec::sub(box.upper, box.lower);
      mass += b.mass;
      json_["bodies"].push_back({{"name", b.name},
                                 {"element", pliant::to_string(b.element)},
                                 {"nodes", b.slot.size()},
                                 {"elements", b.elements()},
                                 {"spacing", b.spacing},
                                 {"size", size},
                                 {"box", {box.lower, box.upper}},
                                 {"mass", b.mass},
                                 {"volume", b.volume},
                                 {"surface_volume", b.surface_volume},
                                 {"surface_vertices", b.vertices},
                                 {"surface_triangles", b.triangles}});
      const bool springs = scene_.bodies[i].model.type == ModelType::mass_spring;
      line(fmt::format("body {}: {} nodes, {} {}{}, {} surface triangles", b.name, b.slot.size(), b.elements(),
                       springs ? std::string("tetrahedra of a network of springs")
                               : fmt::format("{} elements", pliant::to_string(b.element)),
                       b.spacing > 0 ? fmt::format(" on a lattice of {:.5g} m", b.spacing) : "", b.triangles));
      if (b.matching_nodes + b.interface_nodes > 0) matching(b, i);
      const double excess = b.surface_volume > 0 ? 100 * (b.volume / b.surface_volume - 1) : 0;
      line(fmt::format("  {:.4g} m large, between {}", fmt::join(size, " x "), corners_text(box)));
      line(fmt::format("  mass {:.6g} kg, volume {:.6g} m^3, inside its surface {:.6g} m^3 ({:+.2f} %)", b.mass, b.volume,
                       b.surface_volume, excess));
      const Json regions = tell_mesh_regions(scene_.bodies[i], options_.common);
      if (!regions.is_null()) json_["bodies"].back()["regions"] = regions;
    }
    springs();
    surface_checks();
    json_["mass"] = mass;
  }

  void springs() {
    for (const SpringBatch& b : model_.links.springs) {
      json_["springs"].push_back({{"what", b.label}, {"law", word_of(spring_law_words(), b.law.law)}, {"springs", b.size()}});
      line(fmt::format("{}: {} springs, {}", b.label, b.size(), word_of(spring_law_words(), b.law.law)));
    }
    for (const MembraneBatch& b : model_.links.membranes) {
      json_["membranes"].push_back({{"what", b.label}, {"triangles", b.size()}, {"thickness", b.law.thickness}});
      line(fmt::format("{}: {} triangles", b.label, b.size()));
    }
  }

  /// Number of nodes of each entry of `fixed` and `prescribed`: a body with too few fixed nodes swings.
  void held() {
    json_["held"] = Json::array();
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      const auto tell = [&](const Selection& where, const char* what) {
        const std::size_t nodes = select_nodes(where, model_.bodies[b], Virtual::with_anchors).size();
        json_["held"].push_back({{"entry", where.pointer}, {"body", model_.bodies[b].name}, {"nodes", nodes}});
        line(fmt::format("{} ({}): {} nodes of body {}", what, where.pointer, nodes, model_.bodies[b].name));
      };
      for (const Fixed& f : scene_.bodies[b].fixed) tell(f.where, "fixed");
      for (const Prescribed& p : scene_.bodies[b].prescribed) tell(p.where, "prescribed");
    }
  }

  /// The outputs of a run, with the number of nodes of each selection.
  void probes() {
    json_["probes"] = Json::array();
    if (scene_.probes == nullptr) return;
    const Probes found(scene_.probes->list, model_);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const SceneProbe& probe = found.probe(i);
      std::vector<std::string> words;
      for (const Quantity q : probe.quantities) words.push_back(word_of(quantity_words(), q));
      if (!probe.between.empty()) {
        json_["probes"].push_back({{"name", probe.name}, {"between", probe.between}, {"quantities", words}});
        line(fmt::format("probe {}: {} of {}", probe.name, fmt::join(words, ", "), fmt::join(probe.between, " and ")));
        continue;
      }
      const ModelBody& body = model_.bodies[found.body(i)];
      Json row{{"name", probe.name}, {"body", body.name}, {"quantities", words}};
      if (probe.point) row["point"] = *probe.point;
      const std::size_t nodes = probe.point ? 0 : select_nodes(probe.where, body, Virtual::with_anchors).size();
      if (!probe.point) row["nodes"] = nodes;
      json_["probes"].push_back(std::move(row));
      line(fmt::format(
          "probe {}: {} of {} of body {}", probe.name, fmt::join(words, ", "),
          probe.point ? fmt::format("the point [{}] m", fmt::join(*probe.point, ", ")) : fmt::format("{} nodes", nodes),
          body.name));
    }
  }

  void surface_checks() {
    json_["warnings"] = tell(surfaces_, model_, scene_, options_.common);
    for (const SurfaceCheck& check : surfaces_) {
      const SurfaceReport& r = check.report;
      for (Json& body : json_["bodies"]) {
        if (body["name"] != check.body) continue;
        body["surface"] = {{"merged_points", r.merged},
                           {"degenerate_triangles", r.degenerate},
                           {"doubled_triangles", r.doubled},
                           {"dropped_copies", r.doubled_dropped},
                           {"turned_triangles", r.flipped},
                           {"sheet_triangles", r.sheet_triangles},
                           {"holes", r.holes.size()},
                           {"hole_edges", r.hole_edges()},
                           {"hole_area", r.hole_area()},
                           {"crossing_pairs", check.crossings.pairs},
                           {"searched", check.crossings.searched}};
      }
    }
  }

  /// One region of shape matching is centred at each node of its cells, the interface included.
  void matching(const ModelBody& b, std::size_t index) {
    std::int32_t substeps = 1;
    for (const FlsmBatch& batch : model_.flsm)
      substeps = static_cast<std::size_t>(batch.body) == index ? batch.settings.substeps : substeps;
    const std::int64_t tled = b.operational_nodes + b.interface_nodes, regions = b.matching_nodes + b.interface_nodes;
    const double ratio = static_cast<double>(tled) / static_cast<double>(b.slot.size());
    json_["bodies"].back()["shape_matching"] = {{"operational_nodes", b.operational_nodes},
                                                {"interface_nodes", b.interface_nodes},
                                                {"matching_nodes", b.matching_nodes},
                                                {"regions", regions},
                                                {"substeps", substeps},
                                                {"ratio", ratio}};
    line(fmt::format("  shape matching: {} operational, {} interface and {} matching nodes (ratio {:.4g}), {} regions{}",
                     b.operational_nodes, b.interface_nodes, b.matching_nodes, ratio, regions,
                     substeps > 1 ? fmt::format(", once in {} steps", substeps) : ""));
  }

  void stable_step(double iterated_dt, double dt, const std::string& not_iterated) {
    const double step = scene_.dt > 0 ? scene_.dt : dt;
    json_["stable_step"] = {{"element_bound", model_.element_bound},
                            {"bound_element", model_.bound_element},
                            {"iteration", iterated_dt > 0 ? Json(iterated_dt) : Json(nullptr)},
                            {"dt", step > 0 ? Json(step) : Json(nullptr)},
                            {"automatic", scene_.dt <= 0}};
    line(model_.element_bound > 0
             ? fmt::format("stable step: element bound {:.6g} s ({})", model_.element_bound, model_.bound_element)
             : "stable step: no finite element limits it");
    line(iterated_dt > 0 ? fmt::format("  Lanczos iteration {:.6g} s, {:.3g} times the bound", iterated_dt,
                                       iterated_dt / model_.element_bound)
                         : "  Lanczos iteration: " + not_iterated);
    if (step > 0) {
      line(scene_.dt > 0 ? fmt::format("  the scene's step {:.6g} s", step)
                         : fmt::format("  the scene's step is automatic: {}", automatic_text(step, iterated_dt)));
    }
  }

  /// What the automatic step follows (StepControl::start).
  [[nodiscard]] std::string automatic_text(double step, double iterated_dt) const {
    if (iterated_dt > 0 && step > 0.999 * scene_.safety * iterated_dt)
      return fmt::format("{:.3g} of it, {:.6g} s", scene_.safety, step);
    if (step > 0.999 * longest_step(model_, scene_)) return fmt::format("{:.6g} s, limited by shape matching", step);
    if (iterated_dt > 0) return fmt::format("{:.6g} s, {:.3g} of the element bound, limited by cuts", step, scene_.safety);
    return fmt::format("{:.6g} s, one frame, as no finite element limits it", step);
  }

  void memory(const Program& program) {
    std::uint64_t total = 0;
    for (const Buffer& b : program.buffers) total += bytes_of(b);
    const auto row = [&](std::uint64_t bytes) {
      return Json{{"bytes", bytes},
                  {"bytes_per_node", per(bytes, model_.nodes())},
                  {"bytes_per_element", per(bytes, model_.elements())}};
    };
    json_["memory"]["total"] = row(total);
    line(fmt::format("memory {}: {:.1f} bytes per node, {:.1f} per element", bytes_text(total), per(total, model_.nodes()),
                     per(total, model_.elements())));
    for (const BufferRole role : kRoles) {
      std::uint64_t bytes = 0;
      for (const Buffer& b : program.buffers) bytes += b.role == role ? bytes_of(b) : 0;
      json_["memory"][to_string(role)] = row(bytes);
      line(fmt::format("  {:<9}{:>12} bytes, {:.1f} per node, {:.1f} per element", to_string(role), bytes,
                       per(bytes, model_.nodes()), per(bytes, model_.elements())));
    }
  }

  void passes(const Program& program) {
    line("passes of a step:");
    int number = 0;
    for (const Pass& p : program.step) {
      Json defines = Json::object();
      for (const auto& [name, value] : p.defines) defines[name] = value;
      json_["passes"].push_back({{"kernel", p.kernel},
                                 {"label", p.label},
                                 {"defines", defines},
                                 {"count", p.count},
                                 {"elements", p.elements},
                                 {"bytes_per_element", p.bytes_per_element},
                                 {"flops_per_element", p.flops_per_element}});
      line(fmt::format("  {}  {:<22} {:<36} count {:<9} {}", number++, p.kernel, p.label, p.count, defines_text(p.defines)));
    }
  }

  void buffers(const Program& program) {
    line(fmt::format("{:<22} {:<6} {:<9} {:>12} {:<24} {:<16} {}", "buffer", "type", "role", "bytes", "shape", "unit",
                     "producer"));
    for (const Buffer& b : program.buffers) {
      json_["buffers"].push_back({{"name", b.name},
                                  {"type", to_string(b.type)},
                                  {"role", to_string(b.role)},
                                  {"count", b.count},
                                  {"shape", b.shape},
                                  {"unit", b.unit},
                                  {"producer", b.producer},
                                  {"bytes", bytes_of(b)}});
      line(fmt::format("{:<22} {:<6} {:<9} {:>12} {:<24} {:<16} {}", b.name, to_string(b.type), to_string(b.role), bytes_of(b),
                       b.shape, b.unit, b.producer));
    }
  }

  const InfoArguments& options_;
  const Scene& scene_;
  const Model& model_;
  const std::vector<SurfaceCheck>& surfaces_;
  Json json_;
};

int info(const InfoArguments& options) {
  options.common.check();
  const Scene scene = load_scene(options.scene);
  std::vector<SurfaceCheck> surfaces;
  const auto model = std::make_shared<const Model>(build_model(scene, surfaces));
  double iterated_dt = 0, dt = 0;
  std::string not_iterated;
  try {
    const Simulation simulation(scene, model, open_backend("cpu"));
    iterated_dt = simulation.stable_dt();
    dt = simulation.dt();
    if (!(iterated_dt > 0)) not_iterated = "no element moves freely";
  } catch (const Error& error) {  // info also works for a scene too large for this machine, or with an error in a later stage
    not_iterated = error.what();
  }
  Program program = build_program(*model, {scene.integrator, SimulationOptions{}.batch_steps});
  Program surface = surface_program(model->surface, program);
  for (Buffer& buffer : surface.buffers) program.add(std::move(buffer));
  Info(options, scene, *model, surfaces).print_all(program, iterated_dt, dt, not_iterated);
  return 0;
}

}  // namespace

std::function<int()> setup_info(CLI::App& app) {
  auto options = std::make_shared<InfoArguments>();
  app.add_option("scene", options->scene, "Scene file")->required();
  app.add_flag("--buffers", options->buffers, "List every buffer: name, type, role, bytes, shape, unit, producer");
  options->common.add_to(app);
  return [options] { return info(*options); };
}

}  // namespace pliant::cli
