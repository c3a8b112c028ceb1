// `pliant bench haptics`: whether a hand feels what the whole model feels, safely, at its own rate.
#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pliant::bench {

struct HapticsOptions {
  std::vector<std::string> parts;                            ///< names; empty: all
  std::filesystem::path scenes;                              ///< folder of the shipped scenes; empty: looked for
  double seconds = 20;                                       ///< of each measurement in wall time (part times) [s]
  bool quick = false;                                        ///< one body, two sizes of buffer, 2 s
  std::function<void(double, const std::string&)> progress;  ///< share done, what is being measured
};

/// {"machine": {...}, "quick": ..., "parts": [{"name", "question", "seconds"}], "summary": {...}, "rows": [...], "traces":
/// [...]}, docs/schema/bench-haptics.json. Throws Error for bad options.
nlohmann::json bench_haptics(const HapticsOptions& options);

/// The rows for people: a line per test, and one per row that is not as it should be.
std::string haptics_table(const nlohmann::json& result);

}  // namespace pliant::bench
