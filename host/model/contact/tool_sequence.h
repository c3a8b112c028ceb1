// Converts tool meshes to grids of signed distances; a sequence has one grid per frame.
#pragma once
#include <cstdint>
#include <filesystem>

#include "geometry/distance.h"
#include "geometry/vec.h"
#include "model/contact/contact.h"

namespace pliant {

/// Number of cells by which a tool's grid extends beyond its mesh.
inline constexpr std::int32_t kToolGridBeyond = 2;

/// Reads a mesh, in metres. Throws what read_surface() throws.
TriangleMesh read_tool_mesh(const ContactTool& tool, const std::filesystem::path& file);
/// Throws Error (bad_input) for an open surface.
void check_closed(const ContactTool& tool, const std::filesystem::path& file, const SurfaceDistance& surface);
/// How fine the grid of a mesh is.
struct GridDetail {
  double cells = 64;            ///< along the longest side
  double most_nodes = 4194304;  ///< however thin its parts are
};
/// Returns a grid around a box, with at least two cells across a part of `thickness` [m] if the nodes suffice.
NodeGrid lay_grid(const vec::Box& box, double thickness, const GridDetail& detail = {});
/// Twice the volume over the area [m]: the thickness of a plate, the radius of a long rod.
double mesh_thickness(const TriangleMesh& mesh);
/// Appends the signed distances at all nodes of the grid.
void append_distances(const SurfaceDistance& surface, ToolForm& form);

/// Loads one mesh per file of a folder, in the order of their names (digits compare as numbers). The meshes may have
/// different topologies. Throws Error (bad_input) for a folder without meshes, a mesh that cannot be read or is not closed,
/// and for more frames than the grids allow.
void load_sequence(const ContactTool& tool, ToolForm& form);

}  // namespace pliant
