#include "simulation/state/pressed_blades.h"

#include "geometry/vec.h"

namespace pliant {

BladeSegment blade_place(const BladeDrives& driven, const Blade& blade, double time) {
  const BladeDrive* own = drive_at(driven, blade.name, time);
  if (own == nullptr) return blade.at(time);
  const BladeDrive& d = *own;
  if (time >= d.end) return d.to;
  const double share = (time - d.start) / (d.end - d.start);
  BladeSegment at;
  for (std::size_t end = 0; end < 2; ++end) at[end] = vec::add(d.from[end], vec::mul(vec::sub(d.to[end], d.from[end]), share));
  return at;
}

bool blade_present(const BladeDrives& driven, const Blade& blade, double from, double until) {
  if (const BladeDrive* own = drive_at(driven, blade.name, from)) return !own->lifted;
  return until >= blade.begins() && from <= blade.ends();
}

}  // namespace pliant
