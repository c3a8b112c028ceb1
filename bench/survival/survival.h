// `pliant bench survival`: random scenes of the kind that strangers write, and how they end.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pliant::bench {

struct SurvivalOptions {
  std::filesystem::path scenes;                              ///< folder of the shipped scenes; empty: looked for
  std::string backend = "cpu";                               ///< one thread of it, so that times can be compared
  std::int64_t first = 0;                                    ///< number of the first scene
  std::int64_t count = 1000;                                 ///< how many
  std::vector<std::string> having;                           ///< only scenes with one of these keys or words; empty: all
  bool quick = false;                                        ///< 50 scenes, a quarter of the time
  std::filesystem::path out;                                 ///< finished scenes are kept there and not run again; empty: none
  std::function<void(double, const std::string&)> progress;  ///< share done, what is being run
};

/// The text of scene `number`: a body, method, material, loads and blades drawn at random, the same for a number wherever it is
/// drawn. In half of the scenes with tools, one or two of them are in hands (LiveTools), which the text does not say.
std::string survival_scene(std::int64_t number, const std::filesystem::path& scenes);

/// {"machine": {...}, "summary": {...}, "rows": [...]}, docs/schema/bench-survival.json. Throws Error for bad options.
nlohmann::json bench_survival(const SurvivalOptions& options);

/// What ended badly, and the shares, for people.
std::string survival_table(const nlohmann::json& result);

}  // namespace pliant::bench
