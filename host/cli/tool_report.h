// Reports on the tools of a run: at its end, and over time.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pliant/tool.h"
#include "simulation/simulation.h"

namespace pliant::cli {

/// The members "tools" and "contact" of docs/schema/run.json; nothing without tools.
void add_tools(const Simulation& simulation, nlohmann::ordered_json& json);
/// The numbers of an interpenetration; null where there is no centroid or no deepest point.
nlohmann::ordered_json interpenetration_json(const Interpenetration& found);
/// Measures at the present state (docs/contact.md) and adds the members "interpenetrations" and "no_closed_surface"; nothing of
/// a single body without tools. Returns a line for people per tool or body that is in another one.
std::vector<std::string> add_interpenetrations(Simulation& simulation, nlohmann::ordered_json& json);

/// The member "blades": the forces on blades that cut by force; nothing without such blades.
void add_blades(const Simulation& simulation, nlohmann::ordered_json& json);
/// A line per blade that cuts by force, for people.
std::string blade_line(const Simulation& simulation, std::size_t blade);

/// A line per tool for people.
std::string tool_line(const Simulation& simulation, std::size_t tool);

/// How much tissue touches tissue, of a scene with `contact`.
std::string tissue_line(const Simulation& simulation);

/// A table of the forces on all tools and on blades that cut by force, a row per tool and time. Of a blade: the force in the
/// last step, torque about the middle of its edge, whose place it tells; area, penetration and points stay empty.
class ToolTable {
 public:
  /// Add rows and replace the file, which is always complete. Nothing without either, or when no step was done since.
  void write(const Simulation& simulation, const std::filesystem::path& file);

 private:
  void add_blades(const Simulation& simulation);

  std::string table_;
  std::int64_t last_step_ = -1;
};

}  // namespace pliant::cli
