// Meshes of tools become grids of signed distances; a sequence of meshes one grid per frame.
#pragma once
#include <cstdint>
#include <filesystem>

#include "geometry/distance.h"
#include "geometry/vec.h"
#include "model/contact/contact.h"

namespace pliant {

/// The grid of a tool reaches this many of its cells beyond the mesh.
inline constexpr std::int32_t kToolGridBeyond = 2;

/// In metres. Throws what read_surface() throws.
TriangleMesh read_tool_mesh(const ContactTool& tool, const std::filesystem::path& file);
/// Throws Error (bad_input) for a surface with a rim.
void check_closed(const ContactTool& tool, const std::filesystem::path& file, const SurfaceDistance& surface);
/// Place and size of a grid around a box, with at least two cells across a part as thick as `thickness` [m] if a grid of
/// 2^22 nodes has them.
void lay_grid(const vec::Box& box, double thickness, ToolForm& form);
/// Signed distances at all nodes of the grid, behind those that are there.
void append_distances(const SurfaceDistance& surface, ToolForm& form);

/// One mesh per file of a folder, in the order of their names (numbers in them count as numbers). Each may have a topology of
/// its own. Throws Error (bad_input) for a folder without meshes, a mesh that cannot be read or is not closed, and for more
/// frames than the grids may have.
void load_sequence(const ContactTool& tool, ToolForm& form);

/// The pose that takes the frame `pose` stands for to where `surface` is met best by the points `x`, by area: iterated closest
/// points, point to plane (Chen and Medioni 1992), from a first guess. What the shape leaves free, as the turn of a sphere,
/// stays.
Pose registered(const TriangleMesh& mesh, const SurfaceDistance& surface, const Pose& guess);

}  // namespace pliant
