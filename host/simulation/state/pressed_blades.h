// Blades that cut by force: the tissue that their edges meet, and their results (docs/cutting.md). Part of RunState.
#pragma once
#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "cutting/blade/blade_trace.h"
#include "scene/blade.h"
#include "simulation/state/drive_history.h"

namespace pliant {

/// Relation of a sample of an edge to tissue.
enum class FrontKind : std::int32_t {
  none,   ///< it is near nothing
  ahead,  ///< its front point is on the surface that it comes to
  held,   ///< it presses, or has pressed and is still in its cut
  beside  ///< beyond the end of the cut, it goes with the nearest sample that cuts, without a force
};

/// A sample of the edge of a blade.
struct FrontSample {
  std::int32_t kind = 0;  ///< FrontKind
  std::int32_t body = 0;
  MaterialPoint point{};  ///< the front point
  double advance = 0;     ///< of the front beyond that point [m], as of the end of the last batch
  double pressed = 0;     ///< steps since the last update in which it pressed
  double depth = 0;       ///< way of the front through material [m]
  double zeta = 1;        ///< integrity that is left
  double limit = 0;       ///< F* [N]
};

/// A blade that cuts by force.
struct PressedBlade {
  Vec3d normal{};                    ///< n1, the direction in which it presses; 0: none yet
  std::vector<FrontSample> samples;  ///< at equal distances along the edge, both ends included
  double work = 0;                   ///< on the tissue [J]
  double fracture = 0;               ///< as of the last update of the fronts, see fracture_now() [J]
  double max_force = 0;              ///< [N]
  double first = -1;                 ///< time at which tissue first gave way [s]; -1: not yet
  std::int64_t by_contact = 0;       ///< samples that gave way by the traction of the edge, summed over updates
  std::int64_t by_stress = 0;        ///< by the stress of the element below
  bool here = false;                 ///< of one with faces: it was in the scene at the start of the last batch

  [[nodiscard]] bool touches() const {
    return std::any_of(samples.begin(), samples.end(), [](const FrontSample& s) { return s.kind != 0; });
  }
  /// Of the work, what cutting took: sum of F* times the way of the front [J].
  [[nodiscard]] double fracture_now() const {
    double sum = fracture;
    for (const FrontSample& s : samples) sum += s.limit * s.advance;
    return sum;
  }
  /// Call when the blade is taken elsewhere: it touches nothing.
  void forget_fronts() {
    std::fill(samples.begin(), samples.end(), FrontSample{});
    normal = {};
  }
};

/// Motion of a blade between two places at constant speed, requested by the host; its path has ended.
struct BladeDrive {
  BladeSegment from{}, to{};
  double start = 0, end = 0;  ///< [s]
  bool lifted = false;        ///< it is nowhere until it is driven again
  [[nodiscard]] BladeSegment at(double time) const;
};
using BladeDrives = DriveHistory<BladeDrive>;

/// The ends of a blade at a time [m].
BladeSegment blade_place(const BladeDrives& driven, const Blade& blade, double time);
/// Returns true if a blade is anywhere between two times [s].
bool blade_present(const BladeDrives& driven, const Blade& blade, double from, double until);

template <class V>
void visit(V& v, BladeDrive& s) {
  v("from", s.from), v("to", s.to), v("start", s.start), v("end", s.end), v("lifted", s.lifted);
}
template <class V>
void visit(V& v, FrontSample& s) {
  v("kind", s.kind), v("body", s.body), v("point", s.point), v("advance", s.advance), v("pressed", s.pressed);
  v("depth", s.depth), v("zeta", s.zeta), v("limit", s.limit);
}
template <class V>
void visit(V& v, PressedBlade& s) {
  v("normal", s.normal), v("samples", s.samples), v("work", s.work), v("fracture", s.fracture);
  v("max_force", s.max_force), v("first", s.first), v("by_contact", s.by_contact), v("by_stress", s.by_stress);
  v.last("here", s.here);
}

}  // namespace pliant
