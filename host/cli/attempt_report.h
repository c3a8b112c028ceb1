// Cutting attempts of blades that cut by force (docs/cutting.md): in the JSON of a run, and as a table.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "simulation/simulation.h"

namespace pliant::cli {

/// Adds the members "strokes", "attempts" and "cut_attempts" of a blade to its row in "blades".
void add_attempts(const Simulation& simulation, const std::string& blade, nlohmann::ordered_json& row);

/// A table of the attempts, a row each, ascending in time for each blade.
class AttemptTable {
 public:
  /// Adds those since the last call and replaces the file, which is always complete. Nothing without by-force blades.
  void write(const Simulation& simulation, const std::filesystem::path& file);

 private:
  std::string table_;
  std::map<std::string, std::int64_t> seen_;  ///< attempts of each blade that the table has
};

}  // namespace pliant::cli
