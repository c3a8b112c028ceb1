// What assimp does not check in a glTF file and then reads beyond its buffers, recurses or allocates without bound.
#pragma once
#include <filesystem>

namespace pliant {

/// Validates a .gltf or .glb file before assimp reads it. Throws Error with the file, the place (a JSON pointer), the value
/// received and the values allowed, if the file is not glTF 2; a chunk reaches beyond the file; a view reaches beyond its
/// buffer
/// or an accessor beyond its view; an accessor is sparse or has no view (compressed meshes); or the nodes form no tree of at
/// most 256 levels. Indices of meshes and materials are left to assimp, which checks them.
void screen_gltf(const std::filesystem::path& file);

}  // namespace pliant
