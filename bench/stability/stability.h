// `pliant bench stability`: where each method fails, beside where it should.
#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pliant::bench {

struct StabilityOptions {
  std::vector<std::string> sweeps;  ///< names; empty: all
  bool quick = false;               ///< few points and short runs
  std::filesystem::path keep;       ///< folder of finished sweeps, which are not measured again; empty: none
  std::function<void(double, const std::string&)> progress;  ///< share done, what is being measured
};

/// {"machine": {...}, "sweeps": [{"name", "question", "seconds"}], "rows": [...]}, docs/schema/bench-stability.json. Limits are
/// measured on the CPU backends, so rows are the same on every machine. Throws Error for bad options.
nlohmann::json bench_stability(const StabilityOptions& options);

/// The rows as tables for people.
std::string stability_table(const nlohmann::json& result);

}  // namespace pliant::bench
