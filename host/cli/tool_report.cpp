#include "cli/tool_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "geometry/vec.h"
#include "io/atomic_file.h"

namespace pliant::cli {

void add_tools(const Simulation& simulation, nlohmann::ordered_json& json) {
  const Scene& scene = simulation.scene();
  if (scene.tools.empty() && !scene.contact) return;
  json["tools"] = nlohmann::ordered_json::array();
  std::int64_t points = 0;
  double deepest = 0;
  for (std::size_t t = 0; t < scene.tools.size(); ++t) {
    const ToolHistory& h = simulation.contact().history()[t];
    json["tools"].push_back({{"name", scene.tools[t].name},
                             {"force", h.now.force},
                             {"torque", h.now.torque},
                             {"area", h.now.area},
                             {"points", h.now.points},
                             {"max_force", h.max_force},
                             {"max_penetration", h.max_depth},
                             {"work", h.work},
                             {"steps_in_contact", h.touched}});
    points += h.now.points;
    deepest = std::max(deepest, h.max_depth);
  }
  const TouchHistory& tissue = simulation.contact().tissue();
  points += tissue.points;
  deepest = std::max(deepest, tissue.max_depth);
  const ContactPoints* all = simulation.model().contact.get();
  json["contact"] = {{"points", all == nullptr ? 0 : all->size()},
                     {"touching", points},
                     {"max_penetration", deepest},
                     {"penetration_in_cells", all == nullptr ? 0.0 : deepest / all->spacing}};
}

std::string tool_line(const Simulation& simulation, std::size_t tool) {
  const ToolHistory& h = simulation.contact().history()[tool];
  return fmt::format("tool {}: force [{:.4g}] N, at most {:.4g} N; touches {:.3g} m^2, at most {:.3g} m deep; did {:.4g} J",
                     simulation.scene().tools[tool].name, fmt::join(h.now.force, ", "), h.max_force, h.now.area, h.max_depth,
                     h.work);
}

std::string tissue_line(const Simulation& simulation) {
  const TouchHistory& tissue = simulation.contact().tissue();
  return fmt::format("tissue: {} of {} contact points touch other tissue, at most {:.3g} m deep", tissue.points,
                     simulation.model().contact->size(), tissue.max_depth);
}

std::vector<std::string> tool_remarks(const Simulation& simulation) {
  std::vector<std::string> remarks;
  const ContactPoints* points = simulation.model().contact.get();
  if (points != nullptr && simulation.contact().tissue().max_depth > 0.5 * points->spacing) {
    remarks.push_back(fmt::format(
        "tissue went {:.2g} cells deep into other tissue: sharp edges and parts thinner than a cell meet late, and held nodes "
        "do not give way; smaller cells help",
        simulation.contact().tissue().max_depth / points->spacing));
  }
  for (std::size_t t = 0; t < simulation.scene().tools.size() && points != nullptr; ++t) {
    const double cells = simulation.contact().history()[t].max_depth / points->spacing;
    if (cells <= 0.5) continue;
    remarks.push_back(fmt::format(
        "tool '{}' went {:.2g} cells deep into tissue: nodes that are fixed or prescribed do not give way to it, an "
        "edge thinner than half a cell passes between contact points, and a tool that moves a cell in a few steps "
        "is met late",
        simulation.scene().tools[t].name, cells));
  }
  return remarks;
}

void ToolTable::write(const Simulation& simulation, const std::filesystem::path& file) {
  const Scene& scene = simulation.scene();
  if (scene.tools.empty() || simulation.step() == last_step_) return;
  last_step_ = simulation.step();
  if (table_.empty()) {
    table_ =
        "time [s],step,tool,x [m],y [m],z [m],fx [N],fy [N],fz [N],tx [N m],ty [N m],tz [N m],area [m^2],penetration "
        "[m],points,work [J]\n";
  }
  for (std::size_t t = 0; t < scene.tools.size(); ++t) {
    const ToolHistory& history = simulation.contact().history()[t];
    const ToolLoad& now = history.now;
    const Pose at = simulation.contact().pose(t, simulation.time());
    table_ += fmt::format("{:.9g},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{},{:.9g}\n", simulation.time(), simulation.step(),
                          scene.tools[t].name, fmt::join(at.position, ","), fmt::join(now.force, ","),
                          fmt::join(now.torque, ","), now.area, now.depth, now.points, history.work);
  }
  write_file(file, table_);
}

}  // namespace pliant::cli
