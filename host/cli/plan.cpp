// pliant plan: choose lattice, element and model of a scene for a tolerance and a frame budget.
#include "plan/plan.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/cli.h"
#include "io/atomic_file.h"
#include "pliant/error.h"

namespace pliant::cli {
namespace {

using Json = nlohmann::ordered_json;

struct PlanArguments {
  Common common;
  PlanOptions plan;
  std::string scene, out, tolerance = "2%", budget = "4ms";
};

/// "2%" -> 0.02, "4ms" -> 4: a number and one of the units.
double quantity(const std::string& option, const std::string& text, const std::vector<std::pair<std::string, double>>& units,
                const std::string& expected) {
  double value = NAN;
  const auto used = static_cast<std::size_t>(std::from_chars(text.data(), text.data() + text.size(), value).ptr - text.data());
  for (const auto& [unit, factor] : units) {
    if (text.substr(used) == unit && std::isfinite(value) && value > 0) return value * factor;
  }
  throw Error(ErrorCode::bad_input, fmt::format("{} is \"{}\"; expected {}", option, text, expected));
}

/// Files of a scene in a folder, for a copy of it elsewhere.
void make_absolute(Json& value, const std::filesystem::path& folder) {
  if (!value.is_structured()) return;
  for (auto& [key, member] : value.items()) {
    const bool names_file = key == "surface" || key == "mesh" || key == "sequence";
    if (names_file && member.is_string()) {
      member = (folder / member.get<std::string>()).lexically_normal().string();
    } else {
      make_absolute(member, folder);
    }
  }
}

/// The scene's own file with the lattice, element and model of the choice: every other word of it stays as it is.
std::string chosen_text(const std::string& file, const Scene& choice) {
  std::ifstream in(file, std::ios::binary);
  Json scene = Json::parse(in);
  make_absolute(scene, std::filesystem::absolute(file).parent_path());
  const Json told = Json::parse(scene_to_json(choice))["bodies"][0];
  for (const char* key : {"lattice", "element", "model"}) {
    if (told.contains(key)) {
      scene["bodies"][0][key] = told[key];
    } else {
      scene["bodies"][0].erase(key);
    }
  }
  scene.erase("solver");
  scene.erase("dt");
  return scene.dump(2) + "\n";
}

int plan(PlanArguments& o) {
  o.common.check();
  o.plan.tolerance = quantity("--tolerance", o.tolerance, {{"%", 0.01}, {"", 1}}, "a share such as 2% or 0.02");
  if (!(o.plan.tolerance < 1))
    throw Error(ErrorCode::bad_input, fmt::format("--tolerance is \"{}\"; expected less than 100%", o.tolerance));
  o.plan.budget = quantity("--budget", o.budget, {{"ms", 1}, {"us", 1e-3}, {"s", 1e3}, {"", 1}}, "a time such as 4ms");
  const auto nodes = [](const char* option, std::int64_t value) {
    if (value < 8 || value > 1'000'000)
      throw Error(ErrorCode::bad_input, fmt::format("{} is {}; expected 8 to 1000000 nodes", option, value));
  };
  nodes("--least", o.plan.least_nodes);
  nodes("--most", o.plan.most_nodes);
  nodes("--reference", o.plan.reference_nodes);
  if (!(o.plan.seconds > 0 && o.plan.seconds <= 1e6))
    throw Error(ErrorCode::bad_input, fmt::format("--seconds is {} s; expected more than 0, at most 1e6 s", o.plan.seconds));
  if (!o.out.empty()) check_writable(o.out);
  const Scene scene = load_scene(o.scene);
  if (!scene.blades.empty()) o.common.note("blades of the scene are left out: a plan is made without cuts");
  Progress progress(!o.common.quiet);
  std::int64_t done = 0;
  std::string part;
  o.plan.progress = [&](const std::string& what) { progress.show(done++, 24, part = what); };
  o.plan.detail = [&](const std::string& how_far) { progress.show(done, 24, fmt::format("{}: {}", part, how_far)); };
  Plan result = plan_scene(scene, o.plan);
  progress.clear();
  o.common.print(result.text);
  if (!o.out.empty()) {
    write_file(o.out, chosen_text(o.scene, result.scene));
    o.common.print(fmt::format("{} as {}", result.found ? "the choice is written" : "the first of them is written", o.out));
  }
  o.common.write(result.report);
  return 0;
}

}  // namespace

std::function<int()> setup_plan(CLI::App& app) {
  auto o = std::make_shared<PlanArguments>();
  app.add_option("scene", o->scene, "Scene file")->required();
  app.add_option("--tolerance", o->tolerance, "Relative L2 error of the surface at rest, with tools on the way")
      ->capture_default_str();
  app.add_option("--budget", o->budget, "Computing time per frame")->capture_default_str();
  app.add_option("--frame", o->plan.frame, "Simulated time per frame [s]; default 1/60")->check(CLI::PositiveNumber);
  app.add_option("--backend", o->plan.backend, "auto, cpu, opencl or opencl:N")->capture_default_str();
  app.add_option("--out", o->out, "Scene file for the choice")->type_name("FILE");
  app.add_option("--least", o->plan.least_nodes, "Nodes of the coarsest lattice")->capture_default_str();
  app.add_option("--most", o->plan.most_nodes, "Nodes of the finest lattice")->capture_default_str();
  app.add_option("--reference", o->plan.reference_nodes,
                 "Nodes of the first reference; finer ones follow while they are needed and affordable")
      ->capture_default_str();
  app.add_option("--reference-seconds", o->plan.reference_seconds, "Time that finer references at rest may take")
      ->capture_default_str();
  app.add_option("--seconds", o->plan.seconds, "Time that all of it should take [s]; trials for which none is left are skipped")
      ->capture_default_str();
  o->common.add_to(app);
  return [o] { return plan(*o); };
}

}  // namespace pliant::cli
