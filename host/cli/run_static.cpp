#include "cli/run_static.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/checked_model.h"
#include "geometry/stopwatch.h"
#include "io/folder_lock.h"
#include "io/vtu.h"
#include "pliant/error.h"
#include "program/hash.h"
#include "scene/keys.h"
#include "statics/statics.h"

namespace pliant::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// What has no meaning at rest is refused rather than left out in silence.
void check(const Scene& scene, const StaticRun& run) {
  const auto refuse = [&](const std::string& pointer, const std::string& what) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: {}: got {}, expected none of it with a static solver", scene.file.string(), pointer, what));
  };
  if (scene.relaxation.enabled) refuse("/relaxation", "dynamic relaxation");
  if (!scene.focus.path.empty()) refuse("/focus", "a focus");
  for (const Body& body : scene.bodies) {
    if (body.model.type != ModelType::tled)
      refuse(body.model.pointer + "/type", fmt::format("\"{}\"", to_string(body.model.type)));
    if (!element_info(body.element).statics && scene.solver.order != 2) {
      const std::string word = to_string(body.element);
      throw Error(
          ErrorCode::bad_input,
          fmt::format("{}: {}/element: got \"{}\", expected {}, or {} with the solver's \"order\": 2", scene.file.string(),
                      body.pointer, word, elements_with([](const ElementInfo& e) { return e.statics; }), word));
    }
  }
  for (const OutputFormat format : run.formats) {
    if (format != OutputFormat::vtu && format != OutputFormat::obj) {
      throw Error(ErrorCode::bad_input, fmt::format("--format: got \"{}\" with a static scene, which writes vtu and obj",
                                                    word_of(format_words(), format)));
    }
  }
  if (run.out.empty()) return;
  std::error_code code;
  fs::create_directories(run.out, code);
  if (code || !fs::is_directory(run.out))
    throw Error(ErrorCode::bad_input, fmt::format("--out: the folder {} cannot be made", run.out));
  check_writable(fs::path(run.out) / (run.stem + ".vtu"));
}

struct Solved {
  statics::Problem problem;
  statics::Solution solution;
};

class Static {
 public:
  Static(const Scene& scene, const StaticRun& run)
      : scene_(scene), run_(run), model_(checked_model(scene, run.common, warnings_)) {}

  int operator()() {
    const Stopwatch clock;
    statics::Settings settings;
    settings.linear = scene_.solver.linear;
    settings.load_steps = scene_.solver.load_steps;
    settings.tolerance = scene_.solver.tolerance;
    Progress progress(!run_.common.quiet);
    settings.progress = [&](double load, int iteration, double residual) {
      progress.show(static_cast<std::int64_t>(1000 * load), 1000,
                    fmt::format("iteration {} residual {:.2e}", iteration, residual));
    };
    std::string failure;
    for (std::size_t b = 0; b < model_.bodies.size() && failure.empty(); ++b) {
      Solved solved{problem(b), {}};
      solved.solution = statics::solve(solved.problem, settings);
      if (!solved.solution.converged) failure = fmt::format("body '{}': {}", model_.bodies[b].name, solved.solution.failure);
      solved_.push_back(std::move(solved));
    }
    progress.clear();
    seconds_ = clock.seconds();
    report(failure);
    if (!failure.empty()) {
      throw Error(ErrorCode::diverged, fmt::format("the static solver did not converge: {}; smaller loads, another law or more "
                                                   "\"load_steps\" may help",
                                                   failure));
    }
    return 0;
  }

 private:
  statics::Problem problem(std::size_t b) const {
    try {
      return statics::problem_of(scene_, model_, b, scene_.solver.order == 2);
    } catch (const Error& error) {
      throw Error(error.code(), fmt::format("{}: {}", scene_.file.string(), error.what()));
    }
  }

  /// The entry of the scene that holds set `i` of a body's prescribed components.
  [[nodiscard]] const std::string& pointer_of_set(std::size_t b, std::size_t i) const {
    const Body& body = scene_.bodies[b];
    return i < body.fixed.size() ? body.fixed[i].where.pointer : body.prescribed[i - body.fixed.size()].where.pointer;
  }

  [[nodiscard]] std::uint64_t hash() const {
    Hasher all;
    for (const Solved& s : solved_) all.add(s.solution.displacement.data(), sizeof(Vec3d) * s.solution.displacement.size());
    return all.value();
  }

  void report(const std::string& failure) {
    Json json{{"scene", run_.stem},
              {"solver", "static"},
              {"linear", scene_.solver.linear},
              {"nodes", std::int64_t{0}},
              {"elements", model_.elements()},
              {"converged", failure.empty()}};
    std::int64_t nodes = 0;
    int iterations = 0;
    double energy = 0;
    Json bodies = Json::array();
    for (std::size_t b = 0; b < solved_.size(); ++b) {
      const statics::Solution& s = solved_[b].solution;
      const statics::Mesh& mesh = solved_[b].problem.mesh;
      double largest = 0;
      for (const Vec3d& u : s.displacement) largest = std::max(largest, vec::norm(u));
      bodies.push_back({{"name", model_.bodies[b].name},
                        {"element", statics::to_string(mesh.element)},
                        {"nodes", mesh.nodes.size()},
                        {"elements", mesh.elements()},
                        {"unknowns", s.unknowns},
                        {"converged", s.converged},
                        {"load", s.load},
                        {"load_steps", s.steps.size()},
                        {"iterations", s.iterations()},
                        {"residual", s.residual},
                        {"strain_energy", s.strain_energy},
                        {"largest_displacement", largest},
                        {"applied", s.applied},
                        {"reactions", Json::array()}});
      const std::vector<Vec3d> sums = statics::reactions(solved_[b].problem, s);
      nodes += static_cast<std::int64_t>(mesh.nodes.size());
      iterations += s.iterations();
      energy += s.strain_energy;
      run_.common.print(
          fmt::format("{}: {} nodes, {} {} elements, {} unknowns: {} iterations in {} load steps, residual {:.3g}, "
                      "largest displacement {:.6g} m, strain energy {:.6g} J",
                      model_.bodies[b].name, mesh.nodes.size(), mesh.elements(), statics::to_string(mesh.element), s.unknowns,
                      s.iterations(), s.steps.size(), s.residual, largest, s.strain_energy));
      run_.common.print(fmt::format("  loads [{:.6g}] N", fmt::join(s.applied, ", ")));
      for (std::size_t i = 0; i < sums.size(); ++i) {
        const std::string& at = pointer_of_set(b, i);
        bodies.back()["reactions"].push_back({{"at", at}, {"force", sums[i]}});
        run_.common.print(fmt::format("  reaction [{:.6g}] N at {}", fmt::join(sums[i], ", "), at));
      }
    }
    json["nodes"] = nodes;
    json["iterations"] = iterations;
    json["tolerance"] = scene_.solver.tolerance;
    json["strain_energy"] = energy;
    json["wall_seconds"] = seconds_;
    json["hash"] = hash_text(hash());
    json["bodies"] = bodies;
    json["warnings"] = warnings_;
    if (!run_.out.empty() && solved_.size() == model_.bodies.size()) write(failure.empty() ? "" : "-last-good");
    run_.common.print(fmt::format("solved in {:.3g} s", seconds_));
    if (run_.hash && run_.common.quiet && run_.common.json != "-") std::puts(hash_text(hash()).c_str());
    run_.common.print(fmt::format("hash {}", hash_text(hash())));
    run_.common.write(json);
  }

  /// The volume, quadratic tetrahedra with all their nodes, and the surface.
  void write(const std::string& suffix) const {
    const fs::path stem = fs::path(run_.out) / (run_.stem + suffix);
    const std::string surface_stem = (fs::path(run_.out) / (run_.stem + "_surface" + suffix)).string();
    VtuMesh mesh, surface;
    VtuArray u{"displacement", 3, {}}, reaction{"reaction", 3, {}}, body{"body", 1, {}}, surface_u{"displacement", 3, {}};
    const auto append = [](VtuArray& array, const Vec3d& v) {
      for (const double x : v) array.values.push_back(static_cast<float>(x));
    };
    for (std::size_t b = 0; b < solved_.size(); ++b) {
      const ModelBody& placed = model_.bodies[b];
      const statics::Solution& s = solved_[b].solution;
      const auto first = static_cast<std::int32_t>(mesh.points.size());
      const statics::Mesh& solved = solved_[b].problem.mesh;
      const bool quadratic = solved.element == statics::Element::tet10;
      for (std::size_t n = 0; n < solved.nodes.size(); ++n) {
        mesh.points.push_back(vec::add(solved.nodes[n], s.displacement[n]));
        append(u, s.displacement[n]);
        append(reaction, s.reaction[n]);
      }
      for (std::int64_t e = 0; quadratic && e < solved.elements(); ++e) {
        auto& tet = mesh.quadratic_tets.emplace_back();
        for (std::size_t a = 0; a < tet.size(); ++a) tet[a] = solved.nodes_of(e)[a] + first;
      }
      for (std::size_t e = 0; !quadratic && e < placed.tets.size(); ++e) {
        auto& tet = mesh.tets.emplace_back(placed.tets[e]);
        for (std::int32_t& n : tet) n += first;
      }
      for (auto hex : placed.hexes) {
        for (std::int32_t& n : hex) n += first;
        mesh.hexes.push_back(hex);
      }
      for (const statics::SurfacePoint& p : solved_[b].problem.surface) {
        Vec3d moved{};
        for (std::size_t a = 0; a < p.nodes.size(); ++a)
          moved = vec::add(moved, vec::mul(s.displacement[p.nodes[a]], p.weights[a]));
        surface.points.push_back(vec::add(p.rest, moved));
        append(surface_u, moved);
      }
    }
    for (const bool tets : {true, false}) {  // cells stand in this order
      for (std::size_t b = 0; b < solved_.size(); ++b) {
        const ModelBody& placed = model_.bodies[b];
        body.values.insert(body.values.end(), tets ? placed.tets.size() : placed.hexes.size(), static_cast<float>(b));
      }
    }
    surface.triangles = model_.surface.triangles;
    if (run_.formats.count(OutputFormat::vtu) != 0) {
      mesh.point_arrays = {u, reaction};
      mesh.cell_arrays = {body};
      write_vtu(stem.string() + ".vtu", mesh);
      surface.point_arrays = {surface_u};
      if (!surface.triangles.empty()) write_vtu(surface_stem + ".vtu", surface);
    }
    if (run_.formats.count(OutputFormat::obj) != 0) write_surface_obj(surface_stem + ".obj", model_, surface.points);
    run_.common.print(fmt::format("written to {}", run_.out));
  }

  const Scene& scene_;
  const StaticRun& run_;
  std::vector<std::string> warnings_;  // before model_, whose initialiser fills it
  Model model_;
  std::vector<Solved> solved_;
  double seconds_ = 0;
};

}  // namespace

int run_static(const Scene& scene, const StaticRun& run) {
  check(scene, run);
  std::optional<FolderLock> lock;
  if (!run.out.empty()) lock.emplace(run.out);
  return Static(scene, run)();
}

}  // namespace pliant::cli
