// Surfaces that a host gives a tool while a scene runs (World::set_tool_mesh).
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "geometry/band_distance.h"
#include "model/contact/contact.h"

namespace pliant {

/// A surface, in a frame of its own that follows the tool's rigid motion, like a frame of a sequence.
struct GivenSurface {
  double time = 0;       ///< when the tool has this shape [s]
  double begin = 0;      ///< when it begins to change to it from the shape before [s]
  Pose pose;             ///< of its frame in the tool's frame
  TriangleMesh surface;  ///< closed, outward, in its frame [m]
  /// Signed distances at the nodes of GivenSurfaces::grid [m], or null: not computed yet.
  std::shared_ptr<const std::vector<double>> distance;
};

/// The last surfaces of a tool, with ascending times: those to come, the present one, and as many that are over as there is
/// room for. The result depends on all of them, so that it is the same after a checkpoint.
struct GivenSurfaces {
  NodeGrid grid;  ///< in the frame of every surface
  std::vector<GivenSurface> surfaces;
};

/// Maximum number of surfaces: three may be to come.
inline constexpr std::size_t most_given_surfaces = 4;

/// Returns the surface of a mesh tool's file, with a grid around it. Throws what tool_form() throws.
GivenSurfaces first_surface(const ContactTool& tool);

/// Returns the last surfaces of `before` and one more, with its distances; the grid contains all of them and is that of
/// `before` where they fit. Throws Error: bad_input for a surface that is empty, not closed, without volume or not finite;
/// usage for a time that does not rise.
GivenSurfaces next_surface(const std::string& tool, TriangleMesh mesh, double time, GivenSurfaces before);

/// Appends the last surface of `next` at the time `now` [s], to which the tool changes from now on or from when it has the one
/// before. One that comes too late is reached as much later, at the speed at which it was meant to be. Throws Error (usage)
/// if there are too many surfaces to come.
void append_surface(const std::string& tool, GivenSurfaces& all, const GivenSurfaces& next, double now);

/// Returns the form of a tool with these surfaces and computes the distances that are missing.
ToolForm tool_form(const ContactTool& tool, GivenSurfaces& given);

/// Throws Error (bad_input) for surfaces that no host could have given.
void check_given(const std::string& tool, const GivenSurfaces& given);

}  // namespace pliant
