// Probes of a run: --probe NAME=x,y,z, and the probes of a scene.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "simulation/measure/probing.h"

namespace pliant::cli {

/// Parses "NAME=x,y,z". Throws Error with the allowed form.
SceneProbe parse_probe(const std::string& text);

/// Probes and the tables that they fill.
class Probes : public PlacedProbes {
 public:
  using PlacedProbes::PlacedProbes;

  /// Add a row per probe to one table, and replace the file; it is always complete.
  void write(Simulation& simulation, const std::filesystem::path& file);
  /// The same to a table per probe, FOLDER/STEM_NAME.csv.
  void write_each(Simulation& simulation, const std::filesystem::path& folder, const std::string& stem);

 private:
  std::string table_;
  std::vector<std::string> tables_;  ///< of write_each
  std::int64_t last_step_ = -1;
};

}  // namespace pliant::cli
