// Shared by the readers of volume formats: cell types, the mesh as in the file, and one function per format.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "geometry/mesh.h"
#include "mesh_io/read_volume_cursor.h"

namespace pliant::volume_file {

enum class CellKind {
  flat,         ///< points, lines, strips, polygons: not needed
  triangle,     ///< needed for its tags alone: the first three nodes are the corners
  quad,         ///< the same with four
  pixel,        ///< VTK's rectangle with x running fastest
  tet,          ///< the first four nodes are the corners
  hex,          ///< the first eight nodes are the corners, VTK order
  voxel,        ///< VTK's box with x running fastest
  unsupported,  ///< a volume cell that cannot be used; leaving it out would leave a hole in the body
};

struct CellType {
  const char* name;  ///< plural, for messages
  CellKind kind;
  int nodes;  ///< 0: varies
};

/// Null for a number the format does not define.
const CellType* gmsh_cell(std::int64_t type);
const CellType* vtk_cell(std::int64_t type);

/// Points and volume cells with the file's own numbers.
struct RawMesh {
  std::vector<Vec3d> points;
  std::vector<std::int64_t> point_numbers;  ///< empty: 0, 1, 2, ...
  std::vector<std::array<std::int32_t, 4>> tets;
  std::vector<std::int64_t> tet_numbers;
  std::vector<std::array<std::int32_t, 8>> hexes;
  std::vector<std::int64_t> hex_numbers;
  std::map<std::string, std::int64_t> others;  ///< cells that were passed over, by name

  /// The next members are filled if `tagged`: each cell's place among all cells of the file, and what arrays say of them.
  bool tagged = false;
  std::int64_t cells = 0;                          ///< of all kinds, so far
  std::vector<std::int64_t> tet_cell, hex_cell;    ///< parallel to tets and hexes
  std::vector<std::array<std::int32_t, 4>> faces;  ///< triangles and quadrangles; the last of a triangle is -1
  std::vector<std::int64_t> face_cell;
  struct Array {
    std::string name;
    std::vector<std::int64_t> cell, value;  ///< a cell may occur several times, or not at all
  };
  std::vector<Array> arrays;
  struct Values {
    std::string name;
    std::vector<std::int64_t> cell;
    std::vector<double> value;
  };
  std::vector<Values> values;
  std::map<std::pair<int, std::int64_t>, std::string> names;  ///< of a dimension (2, 3) and a number of the first array

  [[nodiscard]] std::int64_t point_number(std::size_t i) const {
    return point_numbers.empty() ? static_cast<std::int64_t>(i) : point_numbers[i];
  }
};

/// From the node numbers of a file, which may be any distinct integers, to indices.
class NodeNumbers {
 public:
  /// False if the number was there before.
  bool add(std::int64_t number) { return map_.emplace(number, static_cast<std::int32_t>(map_.size())).second; }
  /// -1 if unknown.
  [[nodiscard]] std::int32_t find(std::int64_t number) const {
    const auto it = map_.find(number);
    return it == map_.end() ? -1 : it->second;
  }
  [[nodiscard]] std::size_t size() const { return map_.size(); }

 private:
  std::unordered_map<std::int64_t, std::int32_t> map_;
};

/// Returns the array of this name, created if necessary.
RawMesh::Array& array_named(RawMesh& mesh, const std::string& name);
/// Values of all cells from `first_cell` on, in their order.
void add_cell_values(RawMesh& mesh, const std::string& name, std::int64_t first_cell, std::span<const std::int64_t> values);
/// The same from real numbers. An array with one that is not whole holds no tags, and values alone.
void add_cell_values(RawMesh& mesh, const std::string& name, std::int64_t first_cell, std::span<const double> values);

/// Add a cell whose nodes are already indices into the points. Throws through `at` for an unsupported volume cell.
void add_cell(RawMesh& mesh, const CellType& type, std::int64_t number, std::span<const std::int32_t> nodes, const Cursor& at);

/// Add cells in VTK's arrays: offsets[i] to offsets[i + 1] are the nodes of cell i. Numbers of cells and points start at the
/// given ones.
void append_vtk_cells(RawMesh& mesh, std::span<const std::int64_t> offsets, std::span<const std::int64_t> nodes,
                      std::span<const std::int64_t> types, std::int64_t first_cell, std::int64_t first_point, const Cursor& at);

/// `tagged`: with further data of its cells in addition to their nodes.
RawMesh read_gmsh(const std::filesystem::path& file, std::string_view data, bool tagged = false);
RawMesh read_vtk(const std::filesystem::path& file, std::string_view data, bool tagged = false);
RawMesh read_vtu(const std::filesystem::path& file, std::string_view data, bool tagged = false);
/// `node` and `ele` are the contents of the two files, whose names differ in the extension.
RawMesh read_tetgen(const std::filesystem::path& base, std::string_view node, std::string_view ele, bool tagged = false);

/// The arrays of Gmsh files: tags of physical groups, and of the geometry's own parts.
inline constexpr const char* kPhysical = "gmsh:physical";
inline constexpr const char* kGeometrical = "gmsh:geometrical";
/// Reads $PhysicalNames, called by read_gmsh; `at` is after the word.
void read_gmsh_names(Cursor& at, RawMesh& mesh);
/// The physical groups of the entities of Gmsh 4.0 and 4.1, by dimension (2, 3) and tag.
using GmshEntities = std::map<std::pair<int, std::int64_t>, std::vector<std::int64_t>>;
GmshEntities read_gmsh4_entities(Cursor& at, bool v41, bool binary);

/// VTK legacy files, called by read_vtk: bytes per value in a binary file, 0 for a type that is not read.
std::size_t vtk_type_size(const std::string& type);
std::string lower_word(std::string_view word);
/// Reads the rest of the file from POINT_DATA or CELL_DATA on; `at` is after that word, `cells` selects which. Integers of
/// cells are stored.
void read_vtk_attributes(Cursor& at, bool binary, bool cells, RawMesh& mesh);

/// Gmsh 4.0 and 4.1, called by read_gmsh; `at` is after $Nodes or $Elements.
void read_gmsh4_nodes(Cursor& at, bool v41, bool binary, RawMesh& mesh, NodeNumbers& numbers);
/// `entities` of each cell of the mesh from then on are appended: its dimension and tag.
void read_gmsh4_elements(Cursor& at, bool v41, bool binary, RawMesh& mesh, const NodeNumbers& numbers,
                         std::vector<std::pair<int, std::int64_t>>& entities);

/// $ElementData, called by read_gmsh: a number per element, in the file's own numbers of elements.
struct GmshValues {
  std::string name;
  std::vector<std::int64_t> element;
  std::vector<double> value;
};
/// `at` is after the word. The first of several time steps is stored; vectors and tensors are skipped.
void read_gmsh_element_data(Cursor& at, bool binary, std::vector<GmshValues>& out);
/// Once all elements are known.
void add_gmsh_values(const std::vector<GmshValues>& all, RawMesh& mesh);

/// Add one point of a format with explicit numbers; duplicates and non-finite coordinates are errors.
void add_point(RawMesh& mesh, NodeNumbers& numbers, std::int64_t number, const Vec3d& x, const Cursor& at);
/// Map the node numbers of one element; throws naming the element and the number that is unknown.
std::int32_t node_of(const NodeNumbers& numbers, std::int64_t number, std::int64_t element, const Cursor& at);

}  // namespace pliant::volume_file
