#include "simulation/state/pressed_blades.h"

#include "geometry/vec.h"

namespace pliant {

BladeSegment blade_place(const BladeDrives& driven, const Blade& blade, double time) {
  const auto own = driven.find(blade.name);
  if (own == driven.end()) return blade.at(time);
  const BladeDrive& d = own->second;
  if (time >= d.end) return d.to;
  if (time <= d.start) return d.from;
  const double share = (time - d.start) / (d.end - d.start);
  BladeSegment at;
  for (std::size_t end = 0; end < 2; ++end) at[end] = vec::add(d.from[end], vec::mul(vec::sub(d.to[end], d.from[end]), share));
  return at;
}

bool blade_present(const BladeDrives& driven, const Blade& blade, double from, double until) {
  const auto own = driven.find(blade.name);
  if (own != driven.end()) return !own->second.lifted;
  return until >= blade.begins() && from <= blade.ends();
}

}  // namespace pliant
