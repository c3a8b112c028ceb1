// A random body under load, and random strokes of blades through it: what part strokes runs.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "cutting/blade/blade.h"
#include "scene/scene.h"

namespace pliant::bench {

/// A place of a blade, in the box around the body when its stroke begins: 0 and 1 are its faces.
struct BladePlace {
  std::string blade;
  BladeSegment at{};
  std::int64_t steps = 0;  ///< of the body before the blade comes here
  bool first = false;      ///< of its stroke: the blade is put there, and cuts nothing
};

struct StrokeTrial {
  std::int64_t number = 0;
  Scene scene;
  bool box = false;  ///< the lattice fills it exactly, so its pieces have a volume to be compared with
  std::int64_t strokes = 0;
  std::vector<BladePlace> places;
  std::int64_t steps_after = 0;
};

/// What a trial is drawn for. `organ` has one body in a lattice.
struct StrokeKind {
  BladeMethod method = BladeMethod::virtual_nodes;
  ElementKind element = ElementKind::hex8;
  const Scene& organ;
};

/// The same number gives the same strokes, whatever the method and the element.
StrokeTrial draw_stroke_trial(std::int64_t number, const StrokeKind& kind);

}  // namespace pliant::bench
