// pliant bench NAME: measurements of the engine itself. Every benchmark prints {"machine": {...}, "rows": [...]}.
#include <fmt/format.h>

#include <memory>

#include "bench/kernels.h"
#include "cli/cli.h"
#include "io/atomic_file.h"
#include "pliant/error.h"

namespace pliant::cli {
namespace {

struct Options {
  Common common;
  bench::KernelsOptions kernels;
  std::filesystem::path out;
};

/// Made before the work, so that a folder that cannot be made is known at once.
void make_folder(const std::filesystem::path& out) {
  std::error_code failed;
  std::filesystem::create_directories(out, failed);
  if (failed) throw Error(fmt::format("--out: folder \"{}\" cannot be made: {}", out.string(), failed.message()));
}

void write_folder(const std::filesystem::path& out, const std::string& stem, const nlohmann::json& result) {
  write_file(out / (stem + ".json"), result.dump(1) + "\n");
  write_file(out / (stem + ".csv"), bench::rows_csv(result["rows"]));
}

int kernels(Options& options) {
  options.common.check();
  for (const std::int64_t size : options.kernels.sizes) {
    if (size < 1 || size > 100'000'000) throw Error(fmt::format("--sizes: got {}, expected 1 to 100000000 elements", size));
  }
  if (!options.out.empty()) make_folder(options.out);
  Progress progress(!options.common.quiet);
  options.kernels.progress = [&](double done, const std::string& what) {
    progress.show(static_cast<std::int64_t>(1000 * done), 1000, what);
  };
  const nlohmann::json result = bench::bench_kernels(options.kernels);
  progress.clear();
  options.common.print(bench::kernels_table(result));
  if (!options.out.empty()) {
    write_folder(options.out, "kernels", result);
    const std::string out = options.out.string();
    options.common.note(
        fmt::format("wrote kernels.json and kernels.csv to {0}; python3 bench/report.py {0} draws the charts", out));
  }
  options.common.write(nlohmann::ordered_json(result));
  return 0;
}

}  // namespace

std::function<int()> setup_bench(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.require_subcommand(1);
  CLI::App* sub =
      app.add_subcommand("kernels", "Every pass of a step: ns, bytes and flops per element, share of the machine's limit");
  options->common.add_to(*sub);
  sub->add_option("--elements", options->kernels.elements, "tet4, tet4anp, hex8, hex8full")->delimiter(',');
  sub->add_option("--sizes", options->kernels.sizes, "numbers of elements")->delimiter(',');
  sub->add_option("--backends", options->kernels.backends, "default: the first OpenCL device, cpu, cpu:double")->delimiter(',');
  sub->add_option("--law", options->kernels.law, "neo-hookean, saint-venant-kirchhoff or isochoric-neo-hookean");
  sub->add_option("--out", options->out, "folder for kernels.json and kernels.csv");
  return [options] { return kernels(*options); };
}

}  // namespace pliant::cli
