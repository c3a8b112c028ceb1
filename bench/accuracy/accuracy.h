// `pliant bench accuracy`: speed against error of every method, on problems with exact answers and with converged references.
#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pliant::bench {

struct AccuracyOptions {
  std::filesystem::path scenes;       ///< folder of the shipped scenes; empty: find it
  std::filesystem::path out;          ///< finished points are kept here and not measured again; empty: nowhere
  std::vector<std::string> problems;  ///< names; empty: all
  std::vector<std::string> methods;   ///< names; empty: all
  std::vector<std::string> backends{"auto", "cpu:double"};  ///< the first serves every point, the others one resolution each
  bool quick = false;  ///< coarse bodies, coarse references, few methods: a look at the whole
  bool again = false;  ///< measure what `out` holds already, too
  bool noisy = false;  ///< measure those of them again whose times spread by more than 15 %, and keep the quieter ones
  std::function<void(double, const std::string&)> progress;  ///< share done, what is being measured
  std::function<void(const std::string&)> note;              ///< remarks; may be empty
};

/// {"machine", "quick", "problems": [...], "findings": [...], "rows": [...]} (docs/schema/bench-accuracy.json). Errors repeat
/// to the bit; times do not. Throws Error for bad options and for a folder with points of another machine or version.
nlohmann::json bench_accuracy(const AccuracyOptions& options);

/// Per problem the points on the front of speed against error, and which method is there; for people.
std::string accuracy_table(const nlohmann::json& result);

}  // namespace pliant::bench
