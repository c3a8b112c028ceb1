// The bodies that Pliant ships: organs of realistic size as smooth implicit shapes, and exact beam, cube and cylinder. y is up.
#pragma once
#include <string>
#include <vector>

#include "geometry/mesh.h"

namespace pliant {

/// Names that make_shape knows.
std::vector<std::string> shape_names();

/// A closed, outward triangle mesh around the origin, in metres:
/// apple (diameter 0.08), liver (0.22 x 0.15 x 0.12: right lobe at -x, left lobe thinning towards +x, notch and gallbladder bed
/// below), kidney (0.06 x 0.11 x 0.05, long axis up, hilum at +x), beam (0.1 x 0.02 x 0.02 along x), cube (0.1),
/// block (0.12 x 0.04 x 0.08), sheet (0.16 x 0.008 x 0.06), cylinder (radius 0.02, length 0.1 along y), tube (radii 0.0105 and
/// 0.024, length 0.1 along x). Throws Error for any other name.
TriangleMesh make_shape(const std::string& name);

/// Write as Wavefront OBJ with six significant digits. The file appears under its name only when it is complete.
void write_obj_text(const TriangleMesh& mesh, const std::string& comment, const std::string& path);

}  // namespace pliant
