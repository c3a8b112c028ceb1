#include "haptics/driven_part.h"

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"
#include "geometry/wrench.h"
#include "scene/blade_face.h"
#include "simulation/state/pressed_blades.h"

namespace pliant::haptics {
namespace {

constexpr double kReserve = 0.99;  ///< of the greatest speed

}  // namespace

Pose blade_pose(const BladeSegment& edge) {
  const Vec3d span = vec::sub(edge[1], edge[0]);
  Pose pose{vec::mul(vec::add(edge[0], edge[1]), 0.5), {0, 0, 0, 1}};
  const double length = vec::norm(span);
  if (!(length > 0)) return pose;
  // The shorter rotation from x to d: (x cross d, 1 + x . d), normalized.
  const Vec3d d = vec::mul(span, 1 / length);
  const double size = std::sqrt(2 + 2 * d[0]);
  if (size > 1e-6) {
    pose.turn = {0, -d[2] / size, d[1] / size, size / 2};
  } else {
    pose.turn = {0, 0, 1, 0};
  }
  return pose;
}

BladeSegment blade_edge(const Pose& pose, double length) {
  return {place(pose, {-0.5 * length, 0, 0}), place(pose, {0.5 * length, 0, 0})};
}

std::optional<DrivenPart> DrivenPart::find(const Simulation& simulation, const std::string& name) {
  DrivenPart part;
  part.name_ = name;
  const std::optional<std::size_t> tool = simulation.contact().find(name);
  if (tool && !is_face(simulation.contact().tools()[*tool])) {
    part.index_ = *tool;
    return part;
  }
  const std::vector<std::string>& blades = simulation.press().names();
  const auto own = std::find(blades.begin(), blades.end(), name);
  if (own == blades.end()) return {};
  const std::vector<Blade>& all = simulation.scene().blades;
  const auto at = std::find_if(all.begin(), all.end(), [&](const Blade& b) { return b.name == name; });
  if (at == all.end()) return {};
  const BladeDrives& driven = simulation.state().driven_blades;
  const double now = simulation.time();
  if (!blade_present(driven, *at, now, now)) return {};
  part.blade_ = true;
  part.index_ = static_cast<std::size_t>(own - blades.begin());
  part.own_ = &*at;
  const BladeSegment edge = blade_place(driven, *at, now);
  part.length_ = vec::norm(vec::sub(edge[1], edge[0]));
  return part;
}

std::vector<std::string> DrivenPart::names(const Simulation& simulation) {
  std::vector<std::string> names;
  for (const ContactTool& tool : simulation.contact().tools()) {
    if (!is_face(tool)) names.push_back(tool.name);
  }
  for (const std::string& blade : simulation.press().names()) {
    if (std::find(names.begin(), names.end(), blade) == names.end()) names.push_back(blade);
  }
  return names;
}

Pose DrivenPart::pose(const Simulation& simulation, double time) const {
  if (!blade_) return simulation.contact().pose(index_, time);
  return blade_pose(blade_place(simulation.state().driven_blades, *own_, time));
}

std::optional<Wrench> DrivenPart::last(const Simulation& simulation) const {
  if (!blade_) return simulation.contact().last_force(index_);
  return simulation.press().last_force(index_);
}

Wrench DrivenPart::mean(const Simulation& simulation) const {
  if (!blade_) return simulation.report().tools[index_].now;
  const std::vector<Wrench>& all = simulation.press().step_forces();
  const std::size_t blades = simulation.press().names().size(), steps = all.size() / blades;
  Wrench sum;
  if (simulation.press().batch_end() != simulation.step()) return sum;
  for (std::size_t k = 0; k < steps; ++k) sum = plus(sum, scaled(all[k * blades + index_], 1.0 / static_cast<double>(steps)));
  return sum;
}

void DrivenPart::drive(Simulation& simulation, const Pose& to, double seconds) const {
  if (blade_) {
    simulation.drive_blade(name_, blade_edge(to, length_), seconds);
  } else {
    simulation.tools().drive(name_, to, seconds);
  }
}

Pose DrivenPart::within_reach(Simulation& simulation, const Pose& to, double seconds) const {
  if (!blade_) return simulation.tools().within_reach(name_, to, seconds);
  const Pose from = pose(simulation, simulation.time());
  const BladeSegment here = blade_edge(from, length_), there = blade_edge(to, length_);
  const auto way_to = [&](const BladeSegment& edge) {
    return std::max(vec::norm(vec::sub(edge[0], here[0])), vec::norm(vec::sub(edge[1], here[1])));
  };
  const double most = kReserve * simulation.blade_drive_speed() * seconds;
  if (!(way_to(there) > most)) return to;
  Pose target = from;
  for (double share = most / way_to(there); share > 0; share = share > 0.01 ? 0.9 * share : 0) {
    BladeSegment edge;  // middle and direction go alike; the turn about the edge does not matter
    for (std::size_t e = 0; e < 2; ++e) edge[e] = vec::add(here[e], vec::mul(vec::sub(there[e], here[e]), share));
    target = blade_pose(edge);
    if (!(way_to(blade_edge(target, length_)) > most * (1 + 1e-9)))
      return target;  // the arcs of its ends are longer than their chords
  }
  return from;
}

}  // namespace pliant::haptics
