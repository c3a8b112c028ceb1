// pliant compare: two backends in lockstep.
#include "simulation/state/compare.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "backends/choice/backends.h"
#include "cli/cli.h"
#include "pliant/error.h"

namespace pliant::cli {
namespace {

struct CompareArguments {
  Common common;
  std::string scene;
  std::vector<std::string> backends;
  std::int64_t steps = 100;
  std::string every = "pass";
};

using Json = nlohmann::ordered_json;

Json to_json(const std::optional<FirstDifference>& d) {
  if (!d) return nullptr;
  return {{"step", d->step},           {"pass", d->pass},          {"kernel", d->kernel},   {"label", d->label},
          {"buffer", d->buffer},       {"index", d->index},        {"value_a", d->value_a}, {"value_b", d->value_b},
          {"decimal_a", d->decimal_a}, {"decimal_b", d->decimal_b}};
}

Json to_json(const BackendInfo& info) {
  return {
      {"name", info.name}, {"device", info.device}, {"bit_exact", info.bit_exact}, {"tolerance_reason", info.tolerance_reason}};
}

void check(const CompareArguments& options) {
  options.common.check();
  check_steps("--steps", options.steps);
  if (options.every != "pass" && options.every != "step") {
    throw Error(ErrorCode::bad_input, fmt::format("--every is \"{}\"; allowed are pass, step", options.every));
  }
  if (!options.backends.empty() && options.backends.size() != 2) {
    throw Error(ErrorCode::bad_input,
                fmt::format("--backends names {} backends; expected two, for example opencl:0,cpu", options.backends.size()));
  }
  if (std::find(options.backends.begin(), options.backends.end(), "cpu:check") != options.backends.end()) {
    throw Error(ErrorCode::bad_input,
                "--backends names cpu:check, which holds NaN where nothing was written; use it with run, and cpu to compare");
  }
}

/// The OpenCL device that `run` takes for a scene of so many nodes, or the first that there is, and the twin.
std::unique_ptr<Backend> open(const CompareArguments& options, std::size_t which, std::int64_t nodes) {
  if (!options.backends.empty()) return open_backend(options.backends[which]);
  if (which == 1) return open_backend("cpu");
  auto chosen = open_backend("auto", nullptr, nodes);
  if (chosen->info().kind != "reference") return chosen;
  try {
    return open_backend("opencl:0");
  } catch (const Error& error) {
    throw Error(ErrorCode::bad_input,
                fmt::format("compare takes an OpenCL device and cpu unless --backends A,B names others: {}", error.what()));
  }
}

void report(const CompareArguments& options, const ComparisonResult& result, const BackendInfo& a, const BackendInfo& b) {
  const Common& common = options.common;
  for (const BackendInfo* info : {&a, &b}) {
    if (info->bit_exact) continue;
    common.note(fmt::format("{} is in tolerance mode, it need not give the same bits: {}", info->name, info->tolerance_reason));
  }
  common.print(fmt::format("{}: {} ({}) against {} ({})", scene_stem(options.scene), a.name, a.device, b.name, b.device));
  common.print(fmt::format("{} steps of {} passes, {} buffers after every {}, {} values compared", result.steps, result.passes,
                           result.buffers, options.every, result.values_compared));
  common.print(result.identical ? "identical: every bit" : "different: " + result.first_difference->message());
  if (result.at_equilibrium) common.print("both reached equilibrium");
}

int compare_command(const CompareArguments& options) {
  check(options);
  const Scene scene = load_scene(options.scene);
  const auto model = std::make_shared<const Model>(build_model(scene));
  auto backend_a = open(options, 0, model->nodes()), backend_b = open(options, 1, model->nodes());
  Simulation a(scene, model, std::move(backend_a));
  Simulation b(scene, model, std::move(backend_b));

  watch_interrupt();
  Progress progress(!options.common.quiet);
  CompareOptions compare_options;
  compare_options.steps = options.steps;
  compare_options.every_pass = options.every == "pass";
  compare_options.progress = [&](std::int64_t done) {
    progress.show(done, options.steps);
    return !interrupted();
  };
  const ComparisonResult result = compare(a, b, compare_options);
  progress.clear();

  report(options, result, a.backend().info(), b.backend().info());
  options.common.write({{"scene", scene_stem(options.scene)},
                        {"backends", {to_json(a.backend().info()), to_json(b.backend().info())}},
                        {"identical", result.identical},
                        {"steps", result.steps},
                        {"passes", result.passes},
                        {"buffers", result.buffers},
                        {"values_compared", result.values_compared},
                        {"first_difference", to_json(result.first_difference)},
                        {"diverged", result.diverged.has_value()}});
  if (!result.identical) return static_cast<int>(ErrorCode::difference);
  if (result.diverged) throw Error(ErrorCode::diverged, fmt::format("both backends alike: {}", result.diverged->message()));
  return result.stopped ? kInterrupted : 0;
}

}  // namespace

std::function<int()> setup_compare(CLI::App& app) {
  auto options = std::make_shared<CompareArguments>();
  app.add_option("scene", options->scene, "Scene file")->required();
  app.add_option("--steps", options->steps, "Steps to compare")->capture_default_str();
  app.add_option("--backends", options->backends, "Two backends; default: the OpenCL device that run takes, and cpu")
      ->delimiter(',')
      ->type_name("A,B");
  app.add_option("--every", options->every, "Compare after every pass, or only after every step")
      ->type_name("pass|step")
      ->capture_default_str();
  options->common.add_to(app);
  return [options] { return compare_command(*options); };
}

}  // namespace pliant::cli
