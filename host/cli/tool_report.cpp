#include "cli/tool_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "cli/attempt_report.h"
#include "cli/csv_text.h"
#include "geometry/vec.h"
#include "io/atomic_file.h"
#include "scene/blade_face.h"
#include "simulation/measure/interpenetration.h"

namespace pliant::cli {
void add_tools(const Simulation& simulation, nlohmann::ordered_json& json) {
  const Scene& scene = simulation.scene();
  const std::vector<ContactTool>& tools = simulation.contact().tools();
  if (std::all_of(tools.begin(), tools.end(), is_face) && !scene.contact) return;
  json["tools"] = nlohmann::ordered_json::array();
  const std::vector<SunkenTool> sunken = simulation.contact().sunken_now();
  std::int64_t points = 0;
  double deepest = 0;
  for (std::size_t t = 0; t < tools.size(); ++t) {
    if (is_face(tools[t])) continue;
    const ToolHistory& h = simulation.report().tools[t];
    json["tools"].push_back({{"name", tools[t].name},
                             {"force", h.now.force},
                             {"torque", h.now.torque},
                             {"area", h.now.area},
                             {"points", h.now.points},
                             {"max_force", h.max_force},
                             {"max_penetration", h.max_depth},
                             {"below_surface", std::max(h.deepest.depth, sunken[t].depth)},
                             {"work", h.work},
                             {"steps_in_contact", h.touched}});
    points += h.now.points;
    deepest = std::max(deepest, h.max_depth);
  }
  const TouchHistory& tissue = simulation.report().tissue;
  points += tissue.points;
  deepest = std::max(deepest, tissue.max_depth);
  const ContactPoints* all = simulation.model().contact.get();
  json["contact"] = {{"points", all == nullptr ? 0 : all->size()},
                     {"touching", points},
                     {"max_penetration", deepest},
                     {"penetration_in_cells", all == nullptr ? 0.0 : deepest / all->spacing}};
}

namespace {

/// Both faces of a blade in the last batch.
ToolHistory both_faces(const Simulation& simulation, std::size_t blade) {
  ToolHistory both;
  for (const std::size_t t : simulation.press().faces(blade)) {
    const ToolHistory& h = simulation.contact().history(t);
    both.now.area += h.now.area;
    both.now.points += h.now.points;
    both.now.depth = std::max(both.now.depth, h.now.depth);
    both.work += h.work;
  }
  return both;
}

nlohmann::ordered_json faces_json(const Simulation& simulation, std::size_t blade) {
  const FaceLoad load = simulation.press().last_on_faces(blade);
  const ToolHistory both = both_faces(simulation, blade);
  return {{"force", load.force},   {"torque", load.torque},     {"normal", load.normal},
          {"area", both.now.area}, {"points", both.now.points}, {"work", both.work}};
}

}  // namespace

void add_blades(const Simulation& simulation, nlohmann::ordered_json& json) {
  const std::vector<std::string>& names = simulation.press().names();
  if (names.empty()) return;
  json["blades"] = nlohmann::ordered_json::array();
  for (std::size_t b = 0; b < names.size(); ++b) {
    const Wrench now = simulation.press().last_force(b);
    const auto found = simulation.state().pressed.find(names[b]);
    const PressedBlade blade = found == simulation.state().pressed.end() ? PressedBlade{} : found->second;
    json["blades"].push_back(
        {{"name", names[b]},
         {"force", now.force},
         {"torque", now.torque},
         {"max_force", blade.max_force},
         {"work", simulation.press().work(b)},
         {"fracture", blade.fracture_now()},
         {"gave_way", blade.first < 0 ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(blade.first)},
         {"by_contact", blade.by_contact},
         {"by_stress", blade.by_stress}});
    add_attempts(simulation, names[b], json["blades"].back());
    if (!simulation.press().faces(b).empty()) json["blades"].back()["faces"] = faces_json(simulation, b);
  }
}

std::string blade_line(const Simulation& simulation, std::size_t blade) {
  const std::string& name = simulation.press().names()[blade];
  const auto found = simulation.state().pressed.find(name);
  if (found == simulation.state().pressed.end()) return fmt::format("blade {}: met nothing", name);
  const PressedBlade& b = found->second;
  const std::string first = b.first < 0 ? "tissue held" : fmt::format("tissue gave way at {:.4g} s", b.first);
  return fmt::format("blade {}: force [{:.4g}] N, at most {:.4g} N; {}; did {:.4g} J, {:.4g} J of it in cutting", name,
                     fmt::join(simulation.press().last_force(blade).force, ", "), b.max_force, first,
                     simulation.press().work(blade), b.fracture_now());
}

nlohmann::ordered_json interpenetration_json(const Interpenetration& found) {
  using Value = nlohmann::ordered_json;
  return {{"volume", found.volume},
          {"centroid", found.volume > 0 ? Value(found.centroid) : Value(nullptr)},
          {"area", found.area},
          {"depth", found.depth},
          {"deepest", found.depth > 0 ? Value(found.deepest) : Value(nullptr)}};
}

std::vector<std::string> add_interpenetrations(Simulation& simulation, nlohmann::ordered_json& json) {
  std::vector<std::string> lines;
  const std::vector<ContactTool>& tools = simulation.contact().tools();
  if (std::all_of(tools.begin(), tools.end(), is_face) && simulation.model().bodies.size() < 2) return lines;
  Interpenetrations measure;
  json["interpenetrations"] = nlohmann::ordered_json::array();
  for (const Interpenetration& found : measure.now(simulation)) {
    nlohmann::ordered_json row{{"first", found.first}, {"second", found.second}, {"tool", found.tool}};
    row.update(interpenetration_json(found));
    json["interpenetrations"].push_back(std::move(row));
    lines.push_back(fmt::format("{} {} in body {}: {:.4g} m^3, {:.3g} and {:.3g} m^2 of their surfaces, {:.3g} m deep",
                                found.tool ? "tool" : "body", found.first, found.second, found.volume, found.area[0],
                                found.area[1], found.depth));
  }
  json["no_closed_surface"] = measure.left_out(simulation);
  return lines;
}

std::string tool_line(const Simulation& simulation, std::size_t tool) {
  const ToolHistory& h = simulation.report().tools[tool];
  return fmt::format("tool {}: force [{:.4g}] N, at most {:.4g} N; touches {:.3g} m^2, at most {:.3g} m deep; did {:.4g} J",
                     simulation.contact().tools()[tool].name, fmt::join(h.now.force, ", "), h.max_force, h.now.area,
                     h.max_depth, h.work);
}

std::string tissue_line(const Simulation& simulation) {
  const TouchHistory& tissue = simulation.report().tissue;
  return fmt::format("tissue: {} of {} contact points touch other tissue, at most {:.3g} m deep", tissue.points,
                     simulation.model().contact->size(), tissue.max_depth);
}

void ToolTable::add_blades(const Simulation& simulation) {
  const RunState& state = simulation.state();
  std::size_t b = 0;
  for (const Blade& blade : simulation.scene().blades) {
    if (blade.cuts != BladeCuts::by_force) continue;
    const BladeSegment ends = blade_place(state.driven_blades, blade, simulation.time());
    const Vec3d at = vec::mul(vec::add(ends[0], ends[1]), 0.5);
    const auto row = [&](const std::string& name, const Wrench& now, const std::string& touches, double work) {
      table_ +=
          fmt::format("{:.9g},{},{},{:.9g},{:.9g},{:.9g},{},{:.9g}\n", simulation.time(), simulation.step(), csv_text(name),
                      fmt::join(at, ","), fmt::join(now.force, ","), fmt::join(now.torque, ","), touches, work);
    };
    row(blade.name, simulation.press().last_force(b), ",,", simulation.press().work(b));
    if (blade.has_faces()) {
      const ToolHistory both = both_faces(simulation, b);
      row(blade.name + " (faces)", simulation.press().last_on_faces(b),
          fmt::format("{:.9g},{:.9g},{}", both.now.area, both.now.depth, both.now.points), both.work);
    }
    ++b;
  }
}

void ToolTable::write(const Simulation& simulation, const std::filesystem::path& file) {
  const std::vector<ContactTool>& tools = simulation.contact().tools();
  if ((tools.empty() && simulation.press().names().empty()) || simulation.step() == last_step_) return;
  last_step_ = simulation.step();
  if (table_.empty()) {
    table_ =
        "time [s],step,tool,x [m],y [m],z [m],fx [N],fy [N],fz [N],tx [N m],ty [N m],tz [N m],area [m^2],penetration "
        "[m],points,work [J]\n";
  }
  for (std::size_t t = 0; t < tools.size(); ++t) {
    if (is_face(tools[t])) continue;
    const ToolHistory& history = simulation.report().tools[t];
    const ToolLoad& now = history.now;
    const Pose at = simulation.contact().pose(t, simulation.time());
    table_ += fmt::format("{:.9g},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{},{:.9g}\n", simulation.time(), simulation.step(),
                          csv_text(tools[t].name), fmt::join(at.position, ","), fmt::join(now.force, ","),
                          fmt::join(now.torque, ","), now.area, now.depth, now.points, history.work);
  }
  add_blades(simulation);
  write_file(file, table_);
}

}  // namespace pliant::cli
