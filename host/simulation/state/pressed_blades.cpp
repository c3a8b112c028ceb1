#include "simulation/state/pressed_blades.h"

#include "geometry/vec.h"

namespace pliant {

BladeSegment BladeDrive::at(double time) const {
  if (time >= end) return to;
  const double share = (time - start) / (end - start);
  BladeSegment there;
  for (std::size_t e = 0; e < 2; ++e) there[e] = vec::add(from[e], vec::mul(vec::sub(to[e], from[e]), share));
  return there;
}

BladeSegment blade_place(const BladeDrives& driven, const Blade& blade, double time) {
  const BladeDrive* own = drive_at(driven, blade.name, time);
  return own != nullptr ? own->at(time) : blade.at(time);
}

bool blade_present(const BladeDrives& driven, const Blade& blade, double from, double until) {
  if (const BladeDrive* own = drive_at(driven, blade.name, from)) return !own->lifted;
  return until >= blade.begins() && from <= blade.ends();
}

}  // namespace pliant
