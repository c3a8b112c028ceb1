// Blades that cut by force, moved by the host.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"
#include "pliant/error.h"
#include "simulation/edits/blade_fronts.h"
#include "simulation/edits/topology_edits.h"

namespace pliant {
namespace {

constexpr double kDriveLag = 0.25;  ///< largest way of a driven blade between two updates [edges]
constexpr double kLonger = 1.01;    ///< by which it may be longer than on its path: a blade is rigid

[[noreturn]] void refuse(const std::string& blade, const std::string& why) {
  throw Error(ErrorCode::bad_input, fmt::format("blade '{}': {}", blade, why));
}

double longest_on_path(const Blade& blade) {
  double longest = 0;
  for (const auto& r : blade.path) longest = std::max(longest, vec::norm({r[4] - r[1], r[5] - r[2], r[6] - r[3]}));
  return longest;
}

}  // namespace

const Blade& TopologyEdits::blade_by_force(const std::string& name) const {
  std::string known;
  for (const Blade& b : run_.scene.blades) {
    if (b.cuts != BladeCuts::by_force) continue;
    if (b.name == name) return b;
    known += fmt::format("{}'{}'", known.empty() ? "" : ", ", b.name);
  }
  refuse(name, fmt::format("no such blade that cuts by force; the scene has {}", known.empty() ? "none" : known));
}

double TopologyEdits::drive_speed() const {
  return kDriveLag * run_.settings.blade_edge / (static_cast<double>(run_.settings.blade_steps) * run_.state.clock.dt);
}

void TopologyEdits::drive_blade(const std::string& name, const BladeSegment& to, double seconds) {
  const Blade& blade = blade_by_force(name);
  const double length = vec::norm(vec::sub(to[1], to[0])), longest = longest_on_path(blade);
  if (!std::isfinite(length) || !(length > 0) || !(seconds >= 0) || !std::isfinite(seconds)) {
    refuse(name, fmt::format("got a segment from [{}] m to [{}] m within {} s; allowed are two different finite points and a "
                             "finite time that is not negative",
                             fmt::join(to[0], ", "), fmt::join(to[1], ", "), seconds));
  }
  if (length > kLonger * longest)
    refuse(name, fmt::format("got an edge of {:.6g} m; allowed is up to its length on its path, {:.6g} m", length, longest));
  BladeDrives& driven = run_.state.driven_blades;
  const double now = run_.state.clock.time();
  if (!blade_present(driven, blade, now, now)) {
    add_drive(driven, name, {to, to, now, now, false});
    forget_fronts(name);
    return;
  }
  const BladeSegment from = blade_place(driven, blade, now);
  const double way = std::max(vec::norm(vec::sub(to[0], from[0])), vec::norm(vec::sub(to[1], from[1])));
  const double fastest = drive_speed();
  if (way > fastest * seconds) {
    refuse(name, fmt::format("got a way of {:.4g} m within {:.4g} s; allowed is up to {:.4g} m/s, a quarter of a cell between "
                             "two updates of blades; lift_blade() takes it away, and then it may begin anywhere",
                             way, seconds, fastest));
  }
  add_drive(driven, name, {from, to, now, now + seconds, false});
}

void TopologyEdits::lift_blade_by_force(const std::string& name) {
  const BladeSegment at = blade_place(run_.state.driven_blades, blade_by_force(name), run_.state.clock.time());
  const double now = run_.state.clock.time();
  add_drive(run_.state.driven_blades, name, {at, at, now, now, true});
  forget_fronts(name);
}

void TopologyEdits::forget_fronts(const std::string& name) {
  const auto own = run_.state.pressed.find(name);
  if (own != run_.state.pressed.end()) own->second.forget_fronts();
}

}  // namespace pliant
