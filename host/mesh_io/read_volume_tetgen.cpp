// TetGen .node and .ele: text, comments from '#', numbered from 0 or 1.
#include <fmt/format.h>

#include "mesh_io/read_volume_parts.h"

namespace pliant::volume_file {

RawMesh read_tetgen(const std::filesystem::path& base, std::string_view node, std::string_view ele, bool tagged) {
  RawMesh mesh;
  mesh.tagged = tagged;
  NodeNumbers numbers;
  std::filesystem::path file = base;
  Cursor at(file.replace_extension(".node"), node);
  at.comment('#');
  const std::int64_t points = at.count("the number of nodes", 8);
  const std::int64_t dimension = at.integer("the dimension");
  if (dimension != 3) at.fail(fmt::format("dimension {}; only 3 is allowed", dimension));
  // Attributes and markers follow each point; their number is bounded by what one line can hold.
  const std::int64_t extra = at.count("the number of attributes", 1) + (at.integer("the marker flag (0 or 1)") != 0 ? 1 : 0);
  for (std::int64_t i = 0; i < points; ++i) {
    const std::int64_t number = at.integer("a node number");
    Vec3d x;
    for (double& v : x) v = at.real("a coordinate");
    add_point(mesh, numbers, number, x, at);
    for (std::int64_t k = 0; k < extra; ++k) at.real("an attribute");
  }

  Cursor in(file.replace_extension(".ele"), ele);
  in.comment('#');
  const std::int64_t cells = in.count("the number of tetrahedra", 10);
  const std::int64_t corners = in.integer("the nodes of a tetrahedron (4 or 10)");
  if (corners != 4 && corners != 10) in.fail(fmt::format("{} nodes per tetrahedron; allowed are 4 and 10", corners));
  const std::int64_t attributes = in.count("the number of attributes", 1);
  const CellType type{"tetrahedra", CellKind::tet, static_cast<int>(corners)};
  std::vector<std::int32_t> nodes;
  std::vector<double> regions;  // TetGen's switch -A makes the first attribute the number of a region
  for (std::int64_t i = 0; i < cells; ++i) {
    const std::int64_t number = in.integer("a tetrahedron's number");
    nodes.clear();
    for (std::int64_t k = 0; k < corners; ++k)
      nodes.push_back(node_of(numbers, in.integer("a node of a tetrahedron"), number, in));
    add_cell(mesh, type, number, nodes, in);
    for (std::int64_t k = 0; k < attributes; ++k) {
      const double value = in.real("an attribute");
      if (k == 0 && tagged) regions.push_back(value);
    }
  }
  if (!regions.empty()) add_cell_values(mesh, "region", 0, regions);
  return mesh;
}

}  // namespace pliant::volume_file
