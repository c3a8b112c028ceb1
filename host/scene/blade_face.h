// The two faces of a blade that cuts by force: tools on its two sides, which it carries.
#pragma once
#include <string>
#include <vector>

#include "scene/blade.h"
#include "scene/contact_tool.h"
#include "scene/scene.h"

namespace pliant {

/// Both faces of a blade: first the one towards x of its frame. ContactTool::size is thickness, height and length.
std::vector<ContactTool> faces_of(const Blade& blade);
bool is_face(const ContactTool& tool);
/// Takes blades and their faces out of a scene.
void drop_blades(Scene& scene);

/// The frame of a blade whose edge is at `at`: the origin is the middle of its plate, y leads from the edge to the back, z
/// along the edge. The back follows the shortest turn of the edge from where its path begins, so the blade does not roll about
/// it.
Pose blade_frame(const Blade& blade, const std::array<Vec3d, 2>& at);

/// The profile of a face, rising from the edge, from the back and from both ends [m of half a thickness per m].
struct FaceSlopes {
  double up = 0;     ///< from the edge and from the back, within a third of the height
  double along = 0;  ///< from the ends, within as much, a quarter of the length at most
};
FaceSlopes face_slopes(const Vec3d& size);

}  // namespace pliant
