// `pliant bench kernels`: what every pass of a step costs, by element, backend and size.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/keys.h"

namespace pliant::bench {

/// The words of elements, "springs" of a network and "membrane" on a sheet.
std::vector<std::string> kernels_elements();

struct KernelsOptions {
  std::vector<std::string> elements = kernels_elements();
  std::vector<std::string> backends;  ///< empty: the first OpenCL device, cpu and cpu:double
  std::vector<std::int64_t> sizes{10'000, 100'000, 1'000'000};
  std::string law = "neo-hookean";
  std::function<void(double, const std::string&)> progress;  ///< share done, what is being measured
};

/// {"machine": {...}, "rows": [...]}, one row per kernel, element, backend and size, and one with kernel "step" for the whole
/// step.
nlohmann::json bench_kernels(const KernelsOptions& options);

/// The rows as a table for people and as CSV.
std::string kernels_table(const nlohmann::json& result);
std::string rows_csv(const nlohmann::json& rows);

/// The processor, the number of threads, the compiler and the time of the run, for the "machine" member of every benchmark.
nlohmann::json machine_facts();
/// The same with every backend of this machine.
nlohmann::json machine_and_backends();

}  // namespace pliant::bench
