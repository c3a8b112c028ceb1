// Tags of the cells of a volume mesh file: numbers that identify tissues and faces.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace pliant {

struct MeshTags {
  /// One number of one cell.
  struct Tag {
    int dimension = 3;       ///< 3: an element, 2: a face
    std::int32_t place = 0;  ///< element: of the mesh, tetrahedra first, then hexahedra; face: in `faces`
    std::int64_t number = 0;
  };
  /// A cell may have several numbers (Gmsh's physical groups may overlap), or none.
  struct Array {
    std::string name;  ///< as in the file; "gmsh:physical" and "gmsh:geometrical" of a .msh file, "region" of TetGen
    std::vector<Tag> tags;
  };
  /// A number of one dimension, with how many cells have it.
  struct Region {
    int dimension = 3;
    std::int64_t number = 0;
    std::string name;  ///< of a physical group; empty: it has none
    std::int64_t cells = 0;
  };

  std::vector<std::array<std::int32_t, 4>>
      faces;  ///< triangles and quadrangles of the file, over the mesh's vertices; -1: none
  std::vector<Array> arrays;
  /// A number of each element.
  struct Values {
    std::string name;        ///< as in the file; of a .msh file that of $ElementData
    std::vector<double> of;  ///< tetrahedra first, then hexahedra; NaN where the file has none
  };
  std::vector<Values> values;                                 ///< scalars alone
  std::map<std::pair<int, std::int64_t>, std::string> names;  ///< by dimension and number of "gmsh:physical"

  /// Returns the array of this name, or null. An empty name selects the first of usual_arrays() in the file.
  [[nodiscard]] const Array* find(const std::string& name) const;
  /// Returns the values of this name, or null.
  [[nodiscard]] const Values* values_of(const std::string& name) const;
  /// Elements first, by number.
  [[nodiscard]] std::vector<Region> regions(const Array& array) const;

  /// "1 \"liver\" (120 elements), 7 (40 faces)", at most 20 of them.
  static std::string listed(const std::vector<Region>& regions);

  /// Under which names programs write the numbers of materials; upper and lower case are alike.
  static const std::vector<std::string>& usual_arrays();
};

}  // namespace pliant
