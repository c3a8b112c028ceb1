// Triangles of the tools of a simulation, for drawing and for measures of overlap.
#pragma once
#include <memory>
#include <vector>

#include "geometry/mesh.h"
#include "simulation/simulation.h"

namespace pliant {

inline constexpr int kToolSides = 64;  ///< sides of round parts, for drawing

/// Triangles of a shape in its own frame at `time` [s], outward: `fixed`, or of a sequence the nearer frame.
TriangleMesh shape_at(const ToolForm& form, const TriangleMesh& fixed, double time);

/// The present shapes of tools. Parts that do not change in time are made once.
class ToolShapes {
 public:
  /// `around`: sides of round parts, a multiple of four. `volume`: round shapes keep their volume, so that their corners lie
  /// a little outside; otherwise the corners lie on them.
  explicit ToolShapes(int around, bool volume = false) : around_(around), volume_(volume) {}

  /// Triangles in the tool's own frame at the present time; none of a half space.
  TriangleMesh own(const Simulation& simulation, std::size_t tool);
  /// The same where the tool is now [m].
  TriangleMesh placed(const Simulation& simulation, std::size_t tool);

 private:
  int around_;
  bool volume_;
  std::shared_ptr<const ToolForms> made_of_;
  std::vector<TriangleMesh> fixed_;
};

/// The part of a half space's plane around a box [m], three times as wide as its diagonal, as two triangles in the tool's own
/// frame. Empty for other shapes and for an empty box.
TriangleMesh plane_around(const ToolForm& form, const Pose& pose, const vec::Box& box);

}  // namespace pliant
