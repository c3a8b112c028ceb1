// Input and result of a topology edit.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "geometry/vec3.h"

namespace pliant {

/// The new segment of a blade.
struct BladePose {
  std::string blade;               ///< any name
  std::array<Vec3d, 2> segment{};  ///< [m]
};

/// Result of a topology edit, and the time it took [s]. `surface` is the time that the model waited for its surface, `step`
/// the time to determine the new automatic step.
struct CutReport {
  std::int64_t edges = 0;     ///< number of edges cut, of faces passed by a blade that separates, or of elements removed
  std::int64_t in_part = 0;   ///< cells with one of these edges that still hold together there (CutTopology::cut_in_part)
  bool changed = false;       ///< true if elements were split, parted or removed
  bool asked = false;         ///< the host asked for it
  bool opened = false;        ///< stretch alone has cut the edges
  bool pending = false;       ///< the edit is built beside the steps; TopologyEdits::take_built() reports it
  std::int64_t elements = 0;  ///< by how many there are more, negative: fewer (decomposition, removal)
  double mass_lost = 0;       ///< with the elements that were removed [kg]
  double step_before = 0, step_after = 0;  ///< the step of the run before the edit and after it [s]; 0: no edit
  double search = 0, topology = 0, surface = 0, model = 0, upload = 0, step = 0;
  [[nodiscard]] double seconds() const { return search + topology + surface + model + upload + step; }
};

}  // namespace pliant
