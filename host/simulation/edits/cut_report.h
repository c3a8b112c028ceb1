// What goes into an edit of the topology, and what comes out.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "geometry/vec3.h"

namespace pliant {

/// Where a blade is to go.
struct BladePose {
  std::string blade;               ///< any name
  std::array<Vec3d, 2> segment{};  ///< [m]
};

/// What an edit of the topology did, and the time it took [s]. `surface` is what the model waited for its surface, `step` the
/// look at what an automatic step may be after it.
struct CutReport {
  std::int64_t edges = 0;  ///< newly cut
  bool changed = false;    ///< whether elements were split
  double search = 0, topology = 0, surface = 0, model = 0, upload = 0, step = 0;
  [[nodiscard]] double seconds() const { return search + topology + surface + model + upload + step; }
};

}  // namespace pliant
