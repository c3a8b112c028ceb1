// Stanford PLY: text, little and big endian.
#pragma once
#include <filesystem>
#include <string_view>

#include "geometry/mesh.h"

namespace pliant {

/// Read the elements `vertex` (x, y, z of any type) and `face` (the list vertex_indices or vertex_index, of integers). Polygons
/// become fans around their first vertex, those with fewer than three vertices are left out; other elements and properties are
/// skipped. Vertices keep the file's numbering and units, so every encoding of the same numbers gives the same mesh; nothing
/// is welded. Throws Error naming the file and the line, or the element and the byte, when the file is not PLY 1.0, is
/// truncated or longer than its header says, or holds an index out of range or a coordinate that is not finite. Memory stays
/// within a small multiple of the file's size whatever counts it claims.
TriangleMesh read_ply(const std::filesystem::path& file);

/// The same for the bytes of a file; its name is for messages.
TriangleMesh read_ply(const std::filesystem::path& file, std::string_view data);

}  // namespace pliant
