// `pliant bench trainer`: whether a trainer at 60 Hz keeps real time, frame after frame (examples/trainer).
#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pliant::bench {

struct TrainerOptions {
  std::vector<std::string> organs;                           ///< names; empty: all
  std::filesystem::path scenes;                              ///< folder of the shipped scenes; empty: looked for
  std::string backend = "auto";                              ///< as WorldOptions::backend
  double seconds = 20;                                       ///< length of a session [s]
  int busy = 0;                                              ///< threads that compute all the time beside it
  int ahead = 1;                                             ///< LiveOptions::ahead
  bool quick = false;                                        ///< 3 s of the first organ
  std::function<void(double, const std::string&)> progress;  ///< share done, what is being measured
};

/// {"machine": {...}, "seconds": ..., "busy": ..., "ahead": ..., "rows": [...]}, one row per organ,
/// docs/schema/bench-trainer.json. Throws Error for bad options.
nlohmann::json bench_trainer(const TrainerOptions& options);

/// The rows for people.
std::string trainer_table(const nlohmann::json& result);

}  // namespace pliant::bench
