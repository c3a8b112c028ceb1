// Strokes of blades that cut by force, as the surface tells them (docs/cutting.md). Part of RunReport: no step depends on them.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "geometry/vec3.h"

namespace pliant {

/// A potential cutting attempt (Mendoza and Laugier 2003): the vertex in contact has changed. Vertices are those of the uncut
/// surface, numbered over all bodies.
struct StrokeAttempt {
  std::int64_t stroke = 0;  ///< of the blade, counted from 0
  std::int32_t body = 0;
  std::int32_t from = 0, to = 0;
  double time = 0;        ///< [s]
  Vec3d place{};          ///< of the point of contact then [m]
  Vec3d rest{};           ///< the same place on the undeformed surface [m]
  bool gave_way = false;  ///< tissue had given way there (the physical criterion)
};

/// A place at which the edge of a blade meets the surface of a body.
struct StrokeContact {
  std::int64_t stroke = 0;
  std::int32_t body = 0;
  std::int32_t triangle = 0;  ///< of the body's uncut surface
  std::int32_t vertex = 0;    ///< in contact, v_c, as in StrokeAttempt
  Vec3d rest{}, place{};      ///< as in StrokeAttempt [m]
  double time = 0;            ///< of the last look [s]
};

struct BladeStrokes {
  static constexpr std::size_t kMost = 256;
  std::int64_t strokes = 0;             ///< begun so far
  std::int64_t attempts = 0;            ///< made so far
  std::vector<StrokeContact> contacts;  ///< now
  std::vector<StrokeAttempt> last;      ///< the last kMost of the attempts, oldest first

  /// Calls `take` with the attempts after the first `seen` ones, as far as they are known.
  template <class Take>
  void after(std::int64_t seen, Take&& take) const {
    const auto known = static_cast<std::int64_t>(last.size());
    for (std::int64_t i = seen > attempts - known ? known - (attempts - seen) : 0; i < known; ++i)
      take(last[static_cast<std::size_t>(i)]);
  }
};
using CutStrokesState = std::map<std::string, BladeStrokes>;  ///< by name of the blade

template <class V>
void visit(V& v, StrokeAttempt& s) {
  v("stroke", s.stroke), v("body", s.body), v("from", s.from), v("to", s.to), v("time", s.time), v("place", s.place);
  v("rest", s.rest), v("gave_way", s.gave_way);
}
template <class V>
void visit(V& v, StrokeContact& s) {
  v("stroke", s.stroke), v("body", s.body), v("triangle", s.triangle), v("vertex", s.vertex), v("rest", s.rest);
  v("place", s.place), v("time", s.time);
}
template <class V>
void visit(V& v, BladeStrokes& s) {
  v("strokes", s.strokes), v("attempts", s.attempts), v("contacts", s.contacts), v("last", s.last);
}

}  // namespace pliant
