// Gmsh .msh versions 4.0 and 4.1: nodes and elements in blocks of one geometric entity each.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>

#include "mesh_io/read_volume_parts.h"

namespace pliant::volume_file {
namespace {

/// Numbers that are words in text files and of a given width in binary ones.
class Numbers {
 public:
  Numbers(Cursor& at, bool binary) : at_(at), binary_(binary) {}
  std::int64_t small(const char* what) { return binary_ ? at_.raw<std::int32_t>(what) : at_.integer(what); }
  std::int64_t large(const char* what) { return binary_ ? at_.raw<std::int64_t>(what) : at_.integer(what); }
  double real(const char* what) { return binary_ ? at_.raw<double>(what) : at_.real(what); }
  /// `bytes`: what one item takes at least in a binary file; in text two characters per number are the least.
  std::int64_t count(const char* what, std::size_t bytes, std::size_t text_bytes) {
    return at_.check_count(large(what), what, binary_ ? bytes : text_bytes);
  }

 private:
  Cursor& at_;
  bool binary_;
};

struct Block {
  std::int64_t dimension = 0;
  std::int64_t entity = 0;
  std::int64_t type = 0;  ///< parametric flag of nodes, element type of elements
  std::int64_t count = 0;
};

/// 4.0 writes the entity's tag before its dimension, 4.1 after.
Block read_block(Numbers& in, bool v41, const char* type, std::size_t bytes, std::size_t text_bytes) {
  const std::int64_t first = in.small("the entity of a block");
  const std::int64_t second = in.small("the entity of a block");
  Block b;
  b.dimension = v41 ? first : second;
  b.entity = v41 ? second : first;
  b.type = in.small(type);
  b.count = in.count("the number of entries of a block", bytes, text_bytes);
  return b;
}

Vec3d read_point(Numbers& in, std::int64_t parameters) {
  Vec3d x;
  for (double& v : x) v = in.real("a coordinate");
  for (; parameters > 0; --parameters) in.real("a parametric coordinate");
  return x;
}

/// One entity of $Entities; its physical groups are added where it has cells that count.
void read_entity(Numbers& in, bool v41, int dimension, GmshEntities& out) {
  const std::int64_t tag = in.small("an entity's tag");
  for (int k = 0; k < (v41 && dimension == 0 ? 3 : 6); ++k) in.real("a bound of an entity");
  for (std::int64_t groups = in.count("the number of physical groups", 4, 2); groups > 0; --groups) {
    const std::int64_t group = in.small("a physical group");
    if (group == 0 || group == std::numeric_limits<std::int64_t>::min()) continue;
    if (dimension >= 2) out[{dimension, tag}].push_back(std::abs(group));
  }
  if (dimension == 0) return;
  for (std::int64_t bounds = in.count("the number of bounding entities", 4, 2); bounds > 0; --bounds)
    in.small("a bounding entity");
}

}  // namespace

GmshEntities read_gmsh4_entities(Cursor& at, bool v41, bool binary) {
  Numbers in(at, binary);
  std::array<std::int64_t, 4> counts{};
  for (std::int64_t& n : counts) n = in.count("the number of entities", 20, 2);
  GmshEntities out;
  for (std::size_t dimension = 0; dimension < 4; ++dimension) {
    for (std::int64_t i = 0; i < counts[dimension]; ++i) read_entity(in, v41, static_cast<int>(dimension), out);
  }
  return out;
}

void read_gmsh_names(Cursor& at, RawMesh& mesh) {
  const std::int64_t n = at.count("the number of physical names", 5);
  for (std::int64_t i = 0; i < n; ++i) {
    const std::int64_t dimension = at.integer("the dimension of a physical group");
    const std::int64_t number = at.integer("the number of a physical group");
    const std::string_view rest = at.line();
    const std::size_t open = rest.find('"'), close = rest.rfind('"');
    if (open == std::string_view::npos || close == open)
      at.fail(fmt::format("physical group {} of dimension {} has no name in quotation marks", number, dimension));
    if (dimension == 2 || dimension == 3)
      mesh.names[{static_cast<int>(dimension), number}] = rest.substr(open + 1, close - open - 1);
  }
}

void read_gmsh4_nodes(Cursor& at, bool v41, bool binary, RawMesh& mesh, NodeNumbers& numbers) {
  Numbers in(at, binary);
  const std::int64_t blocks = in.count("the number of node blocks", 20, 7);
  const std::int64_t total = in.count("the number of nodes", 28, 7);
  if (v41) {
    in.large("the least node number");
    in.large("the greatest node number");
  }
  std::int64_t found = 0;
  std::vector<std::int64_t> tags;
  for (std::int64_t b = 0; b < blocks; ++b) {
    const Block block = read_block(in, v41, "the parametric flag", v41 ? 32 : 28, 7);
    if (block.dimension < 0 || block.dimension > 3)
      at.fail(fmt::format("entity dimension {}; allowed are 0 to 3", block.dimension));
    const std::int64_t parameters = block.type == 0 ? 0 : v41 ? block.dimension : std::min<std::int64_t>(block.dimension, 2);
    if (v41) {
      tags.resize(static_cast<std::size_t>(block.count));
      for (std::int64_t& tag : tags) tag = in.large("a node number");
      for (const std::int64_t tag : tags) add_point(mesh, numbers, tag, read_point(in, parameters), at);
    } else {
      for (std::int64_t i = 0; i < block.count; ++i) {
        const std::int64_t tag = in.small("a node number");
        add_point(mesh, numbers, tag, read_point(in, parameters), at);
      }
    }
    found += block.count;
  }
  if (found != total) at.fail(fmt::format("the blocks hold {} nodes, the section announces {}", found, total));
}

void read_gmsh4_elements(Cursor& at, bool v41, bool binary, RawMesh& mesh, const NodeNumbers& numbers,
                         std::vector<std::pair<int, std::int64_t>>& entities) {
  Numbers in(at, binary);
  const std::int64_t blocks = in.count("the number of element blocks", 20, 7);
  const std::int64_t total = in.count("the number of elements", 8, 3);
  if (v41) {
    in.large("the least element number");
    in.large("the greatest element number");
  }
  std::int64_t found = 0;
  std::vector<std::int32_t> nodes;
  for (std::int64_t b = 0; b < blocks; ++b) {
    const Block block = read_block(in, v41, "the element type", 8, 3);
    const CellType* type = gmsh_cell(block.type);
    if (type == nullptr) at.fail(fmt::format("element type {} is not known", block.type));
    for (std::int64_t i = 0; i < block.count; ++i) {
      const std::int64_t number = v41 ? in.large("an element number") : in.small("an element number");
      nodes.clear();
      for (int k = 0; k < type->nodes; ++k) {
        const std::int64_t node = v41 ? in.large("a node of an element") : in.small("a node of an element");
        nodes.push_back(node_of(numbers, node, number, at));
      }
      add_cell(mesh, *type, number, nodes, at);
      if (mesh.tagged) entities.emplace_back(static_cast<int>(block.dimension), block.entity);
    }
    found += block.count;
  }
  if (found != total) at.fail(fmt::format("the blocks hold {} elements, the section announces {}", found, total));
}

}  // namespace pliant::volume_file
