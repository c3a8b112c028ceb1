#include "bench/kernels/kernels.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fstream>
#include <map>
#include <thread>

#include "backends/choice/backends.h"
#include "backends/interface/timing.h"
#include "bench/kernels/block.h"
#include "bench/kernels/machine_limits.h"
#include "pliant/error.h"
#include "scene/keys.h"
#include "simulation/simulation.h"

namespace pliant::bench {
namespace {

using nlohmann::json;

/// The enumerator that an option names.
template <class Enum>
Enum named(const char* option, const Words<Enum>& words, const std::string& name) {
  for (const Word<Enum>& w : words) {
    if (name == w.word) return w.value;
  }
  throw Error(ErrorCode::bad_input, fmt::format("{}: got \"{}\", expected {}", option, name, alternatives(words_only(words))));
}

/// `element`: one of kernels_elements().
Block block_for(const std::string& element, Law law, std::int64_t size) {
  if (element == "springs") return make_network(size);
  if (element == "membrane") return make_membrane(size);
  for (const Word<ElementKind>& w : element_words()) {
    if (element == w.word) return make_block(w.value, law, size);
  }
  throw Error(ErrorCode::bad_input,
              fmt::format("--elements: got \"{}\", expected {}", element, alternatives(kernels_elements())));
}

std::int64_t program_bytes(const Program& program, std::int64_t real_bytes) {
  std::int64_t bytes = 0;
  for (const Buffer& b : program.buffers) bytes += static_cast<std::int64_t>(b.values()) * (b.is_int() ? 4 : real_bytes);
  return bytes;
}

struct Limits {
  double bandwidth = 0, flops = 0;
};

/// One row. `work` elements share `seconds`; traffic and operations are counted for all of them.
json make_row(const std::string& kernel, const std::string& element, const std::string& backend, std::int64_t elements,
              double seconds, double bytes, double flops, const Limits& limits) {
  const auto n = static_cast<double>(elements);
  const double limit = std::max(bytes / limits.bandwidth, flops / limits.flops);
  return {{"kernel", kernel},
          {"element", element},
          {"backend", backend},
          {"elements", elements},
          {"ns_per_element_step", seconds * 1e9 / n},
          {"bytes_per_element", bytes / n},
          {"flops_per_element", flops / n},
          {"bytes_per_second", bytes / seconds},
          {"triad_bytes_per_second", limits.bandwidth},
          {"fma_flops_per_second", limits.flops},
          {"fraction_of_limit", limit / seconds}};
}

std::string cpu_name() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

void measure(const KernelsOptions& options, const std::string& element, const std::string& backend_name, const Block& block,
             json& rows) {
  SimulationOptions simulation_options;
  simulation_options.stable_step = false;
  Simulation simulation(block.scene, block.model, open_backend(backend_name), simulation_options);
  Backend& backend = simulation.backend();
  const std::int64_t elements = block.counted;
  // Until the first disturbance has crossed the block: ahead of it, strains of 1e-13 have denormal products
  // (docs/decisions/numerics.md).
  simulation.advance(16 + static_cast<std::int64_t>(1.2 * std::cbrt(static_cast<double>(elements))));
  if (simulation.divergence()) throw Error(ErrorCode::diverged, simulation.divergence()->message());
  const std::string hash = fmt::format("{:016x}", simulation.hash());
  const std::int64_t real_bytes = backend.info().real_bytes;
  const std::int64_t footprint = program_bytes(simulation.program(), real_bytes);
  const Timing step = time_passes(backend, simulation.program().step);
  std::vector<Timing> passes;
  for (const Pass& pass : simulation.program().step) passes.push_back(time_passes(backend, {pass}, 7, 0.01));
  // The limits load other programs into the same backend, so they come last.
  const Limits limits{triad_bandwidth(backend, footprint), fma_rate(backend)};
  const double width = static_cast<double>(real_bytes) / 4;
  double bytes = 0, flops = 0;
  std::size_t i = 0;
  for (const Pass& pass : simulation.program().step) {
    const double pass_bytes = width * pass.bytes_per_element * static_cast<double>(pass.elements);
    const double pass_flops = pass.flops_per_element * static_cast<double>(pass.elements);
    bytes += pass_bytes;
    flops += pass_flops;
    json row = make_row(pass.kernel, element, backend_name, elements, passes[i].median, pass_bytes, pass_flops, limits);
    row["spread"] = passes[i++].spread;
    row["hash"] = hash;
    rows.push_back(row);
  }
  json row = make_row("step", element, backend_name, elements, step.median, bytes, flops, limits);
  row["spread"] = step.spread;
  row["hash"] = hash;
  row["law"] = options.law;
  row["nodes"] = block.model->nodes();
  row["memory_bytes"] = footprint;
  row["ms_per_step"] = step.median * 1e3;
  rows.push_back(row);
}

}  // namespace

std::vector<std::string> kernels_elements() {
  std::vector<std::string> words = words_only(element_words());
  words.insert(words.end(), {"springs", "membrane"});
  return words;
}

json machine_facts() {
#ifdef __clang__
  const std::string compiler = __VERSION__;
#else
  const std::string compiler = "g++ " __VERSION__;
#endif
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return {{"cpu", cpu_name()},
          {"threads", std::thread::hardware_concurrency()},
          {"compiler", compiler},
          {"date", fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(now))}};
}

json machine_and_backends() {
  json machine = machine_facts();
  for (const BackendInfo& info : list_backends()) {
    machine["backends"].push_back(
        {{"name", info.name}, {"device", info.device}, {"version", info.version}, {"bit_exact", info.bit_exact}});
  }
  return machine;
}

json bench_kernels(const KernelsOptions& options) {
  std::vector<std::string> backends = options.backends;
  if (backends.empty()) {
    for (const BackendInfo& info : list_backends()) {
      if (info.name == "opencl:0" || info.name.starts_with("cpu")) backends.push_back(info.name);
    }
  }
  json result;
  result["machine"] = machine_and_backends();
  result["rows"] = json::array();
  const double total = static_cast<double>(options.elements.size() * options.sizes.size() * backends.size());
  double done = 0;
  for (const std::string& element : options.elements) {
    for (const std::int64_t size : options.sizes) {
      const Block block = block_for(element, named("--law", law_words(), options.law), size);
      for (const std::string& backend : backends) {
        if (options.progress) options.progress(done / total, fmt::format("{} {} {}", element, backend, size));
        measure(options, element, backend, block, result["rows"]);
        done += 1;
      }
    }
  }
  if (options.progress) options.progress(1, "done");
  return result;
}

std::string kernels_table(const json& result) {
  std::string text = fmt::format("{:<10} {:<11} {:>9}  {:<22} {:>9} {:>8} {:>8} {:>6} {:>7}  {}\n", "element", "backend",
                                 "elements", "kernel", "ns/elem", "B/elem", "flop/el", "GB/s", "limit", "hash");
  for (const json& r : result["rows"]) {
    text += fmt::format(
        "{:<10} {:<11} {:>9}  {:<22} {:>9.2f} {:>8.1f} {:>8.1f} {:>6.1f} {:>6.0f}%  {}\n", r["element"].get<std::string>(),
        r["backend"].get<std::string>(), r["elements"].get<std::int64_t>(), r["kernel"].get<std::string>(),
        r["ns_per_element_step"].get<double>(), r["bytes_per_element"].get<double>(), r["flops_per_element"].get<double>(),
        r["bytes_per_second"].get<double>() / 1e9, 100 * r["fraction_of_limit"].get<double>(), r["hash"].get<std::string>());
  }
  return text;
}

namespace {

/// As RFC 4180 wants it: quoted where it holds a comma or a quote.
std::string csv_cell(const json& value) {
  if (value.is_null()) return "";
  const std::string plain = value.is_string() ? value.get<std::string>() : value.dump();
  if (plain.find_first_of(",\"\n") == std::string::npos) return plain;
  std::string quoted = "\"";
  for (const char c : plain) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

std::string rows_csv(const json& rows) {
  std::vector<std::string> columns;
  for (const json& row : rows) {
    for (const auto& [key, value] : row.items()) {
      if (std::find(columns.begin(), columns.end(), key) == columns.end()) columns.push_back(key);
    }
  }
  std::string text = fmt::format("{}\n", fmt::join(columns, ","));
  for (const json& row : rows) {
    std::vector<std::string> cells;
    for (const std::string& column : columns) cells.push_back(row.contains(column) ? csv_cell(row[column]) : "");
    text += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return text;
}

}  // namespace pliant::bench
