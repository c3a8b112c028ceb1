// `pliant bench cutting`: what a cut costs and what it leaves behind, by method.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pliant {
class Simulation;
}

namespace pliant::bench {

struct CuttingOptions {
  std::filesystem::path scenes;                              ///< folder of the shipped scenes; empty: find it
  std::vector<std::string> parts;                            ///< of scenes, methods, live, steps, strokes; empty: all
  std::string backend = "auto";                              ///< of all parts but steps and strokes
  std::int64_t cuts = 0;                                     ///< of steps, strokes; 0: 10 000 and 1000, quick 200 and 20
  std::int64_t trial = -1;                                   ///< of part strokes: the only one; -1: all
  bool quick = false;                                        ///< small bodies and few frames: the times mean nothing
  std::function<void(double, const std::string&)> progress;  ///< share done, what is being measured
  /// Part methods: draw a simulation whose pieces have been moved apart. Its bodies are not used again.
  std::function<void(const std::string& name, Simulation&)> picture;
};

/// {"machine": {...}, "rows": [...]}, docs/schema/bench-cutting.json. Throws Error for bad options, for scenes that are not
/// there, and for a run that diverges.
nlohmann::json bench_cutting(const CuttingOptions& options);

/// The rows as tables for people.
std::string cutting_table(const nlohmann::json& result);

}  // namespace pliant::bench
