// Gmsh .msh versions 1 and 2; version 4 is in read_volume_gmsh4.cpp.
#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "mesh_io/read_volume_parts.h"

namespace pliant::volume_file {
namespace {

struct Format {
  int version = 0;  ///< 1, 2, 40, 41
  bool binary = false;
};

Vec3d read_point(Cursor& at) {
  const double x = at.real("a coordinate");
  const double y = at.real("a coordinate");
  return {x, y, at.real("a coordinate")};
}

void read_nodes_text(Cursor& at, RawMesh& mesh, NodeNumbers& numbers) {
  const std::int64_t n = at.count("the number of nodes", 8);
  for (std::int64_t i = 0; i < n; ++i) {
    const std::int64_t number = at.integer("a node number");
    add_point(mesh, numbers, number, read_point(at), at);
  }
}

/// The tags of the cell that was added last. Zero is no physical group; a minus says that the file has the cell turned round.
void add_tags(RawMesh& mesh, std::int64_t physical, std::int64_t geometrical) {
  if (!mesh.tagged) return;
  const auto add = [&](const char* array, std::int64_t tag) {
    if (tag == 0 || tag == std::numeric_limits<std::int64_t>::min()) return;
    RawMesh::Array& to = array_named(mesh, array);
    to.cell.push_back(mesh.cells - 1);
    to.value.push_back(std::abs(tag));
  };
  add(kPhysical, physical);
  add(kGeometrical, geometrical);
}

/// Version 1: number type physical elementary count nodes. Version 2: number type tag-count tags nodes.
void read_elements_text(Cursor& at, int version, RawMesh& mesh, const NodeNumbers& numbers) {
  const std::int64_t n = at.count("the number of elements", 6);
  std::vector<std::int32_t> nodes;
  for (std::int64_t i = 0; i < n; ++i) {
    const std::int64_t number = at.integer("an element number");
    const std::int64_t type_number = at.integer("an element type");
    const CellType* type = gmsh_cell(type_number);
    if (type == nullptr) at.fail(fmt::format("element {} has type {}, which is not known", number, type_number));
    std::int64_t count = type->nodes;
    std::array<std::int64_t, 2> of{};  // physical and elementary
    if (version == 1) {
      of[0] = at.integer("a physical region");
      of[1] = at.integer("an elementary region");
      count = at.count("the number of nodes of an element", 1);
      if (count != type->nodes)
        at.fail(fmt::format("element {} has {} nodes; its type {} has {}", number, count, type_number, type->nodes));
    } else {
      const std::int64_t tags = at.count("the number of tags", 1);
      for (std::int64_t k = 0; k < tags; ++k) {
        const std::int64_t tag = at.integer("a tag");
        if (k < 2) of[static_cast<std::size_t>(k)] = tag;
      }
    }
    nodes.clear();
    for (std::int64_t k = 0; k < count; ++k) nodes.push_back(node_of(numbers, at.integer("a node of an element"), number, at));
    add_cell(mesh, *type, number, nodes, at);
    add_tags(mesh, of[0], of[1]);
  }
}

void read_nodes_binary(Cursor& at, RawMesh& mesh, NodeNumbers& numbers) {
  const std::int64_t n = at.count("the number of nodes", 1);
  at.line();
  at.binary(true);
  at.check_count(n, "the number of nodes", 28);
  for (std::int64_t i = 0; i < n; ++i) {
    const auto number = at.raw<std::int32_t>("a node number");
    Vec3d x;
    for (double& v : x) v = at.raw<double>("a coordinate");
    add_point(mesh, numbers, number, x, at);
  }
  at.binary(false);
}

void read_elements_binary(Cursor& at, RawMesh& mesh, const NodeNumbers& numbers) {
  const std::int64_t n = at.count("the number of elements", 1);
  at.line();
  at.binary(true);
  at.check_count(n, "the number of elements", 8);
  std::vector<std::int32_t> nodes;
  for (std::int64_t done = 0; done < n;) {
    const auto type_number = at.raw<std::int32_t>("an element type");
    const CellType* type = gmsh_cell(type_number);
    if (type == nullptr) at.fail(fmt::format("element type {} is not known", type_number));
    const std::int64_t block = at.raw<std::int32_t>("the number of elements of a block");
    const std::int64_t tags = at.raw<std::int32_t>("the number of tags");
    if (tags < 0 || block <= 0 || block > n - done)
      at.fail(fmt::format("a block of {} elements with {} tags, {} left", block, tags, n - done));
    at.check_count(tags, "the number of tags", 4);
    at.check_count(block, "the number of elements of a block", 4 * static_cast<std::size_t>(1 + tags + type->nodes));
    for (std::int64_t i = 0; i < block; ++i) {
      const auto number = at.raw<std::int32_t>("an element number");
      std::array<std::int64_t, 2> of{};
      for (std::int64_t k = 0; k < tags; ++k) {
        const auto tag = at.raw<std::int32_t>("a tag");
        if (k < 2) of[static_cast<std::size_t>(k)] = tag;
      }
      nodes.clear();
      for (int k = 0; k < type->nodes; ++k) {
        nodes.push_back(node_of(numbers, at.raw<std::int32_t>("a node of an element"), number, at));
      }
      add_cell(mesh, *type, number, nodes, at);
      add_tags(mesh, of[0], of[1]);
    }
    done += block;
  }
  at.binary(false);
}

Format read_format(Cursor& at) {
  Format format;
  const std::string version(at.token("the version of the format"));
  if (version == "4.1") {
    format.version = 41;
  } else if (version == "4" || version == "4.0") {
    format.version = 40;
  } else if (version == "2" || version.rfind("2.", 0) == 0) {
    format.version = 2;
  } else {
    at.fail(fmt::format("format version '{}' cannot be read; allowed are 1, 2, 2.x, 4.0 and 4.1", version.substr(0, 20)));
  }
  const std::int64_t type = at.integer("the file type (0 text, 1 binary)");
  if (type != 0 && type != 1) at.fail(fmt::format("file type {}; allowed are 0 (text) and 1 (binary)", type));
  format.binary = type == 1;
  const std::int64_t size = at.integer("the data size");
  if (format.binary && size != 8) at.fail(fmt::format("data size {}; binary files are read with 8 only", size));
  if (format.binary) {
    at.line();
    at.section("$MeshFormat");
    if (at.raw<std::int32_t>("the byte-order mark") != 1) {
      at.seek(at.position() - 4);
      at.swap(true);
      if (at.raw<std::int32_t>("the byte-order mark") != 1) at.fail("the byte-order mark is not 1 in either order");
    }
  }
  return format;
}

/// Move behind $End<name>, over anything in between.
void leave(Cursor& at, std::string_view name) {
  const std::string end = "$End" + std::string(name.substr(1));
  const std::size_t found = at.rest().find(end);
  if (found == std::string_view::npos) at.fail(fmt::format("section {} has no {}", name.substr(0, 40), end.substr(0, 44)));
  at.seek(at.position() + found + end.size());
}

using CellEntities = std::vector<std::pair<int, std::int64_t>>;

/// True if the section was one that holds the mesh.
bool read_section(Cursor& at, std::string_view name, const Format& format, RawMesh& mesh, NodeNumbers& numbers,
                  CellEntities& cell_entities) {
  const bool nodes = name == "$Nodes" || name == "$NOD";
  if (!nodes && name != "$Elements" && name != "$ELM") return false;
  if (format.version == 0) at.fail(fmt::format("{} before $MeshFormat", name));
  at.section(std::string(name));
  if (format.version >= 40) {
    if (format.binary) at.line();
    at.binary(format.binary);
    if (nodes) {
      read_gmsh4_nodes(at, format.version == 41, format.binary, mesh, numbers);
    } else {
      read_gmsh4_elements(at, format.version == 41, format.binary, mesh, numbers, cell_entities);
    }
    at.binary(false);
  } else if (format.binary) {
    nodes ? read_nodes_binary(at, mesh, numbers) : read_elements_binary(at, mesh, numbers);
  } else {
    nodes ? read_nodes_text(at, mesh, numbers) : read_elements_text(at, format.version, mesh, numbers);
  }
  const std::string_view end = at.token("the end of the section");
  const std::string expected = name == "$NOD" ? "$ENDNOD" : name == "$ELM" ? "$ENDELM" : "$End" + std::string(name.substr(1));
  if (end != expected) at.fail(fmt::format("expected {}: the section holds more than its count says", expected));
  return true;
}

/// The groups of each cell's entity, whichever section came first.
void add_entity_tags(const CellEntities& cells, const GmshEntities& entities, RawMesh& mesh) {
  if (cells.empty()) return;
  for (const char* name : {kPhysical, kGeometrical}) {
    RawMesh::Array array{name, {}, {}};
    const auto add = [&](std::size_t cell, std::int64_t tag) {
      array.cell.push_back(static_cast<std::int64_t>(cell));
      array.value.push_back(tag);
    };
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (name == kGeometrical) {
        add(c, cells[c].second);
      } else if (const auto groups = entities.find(cells[c]); groups != entities.end()) {
        for (const std::int64_t tag : groups->second) add(c, tag);
      }
    }
    if (!array.cell.empty()) mesh.arrays.push_back(std::move(array));
  }
}

/// The sections that only tags need; `leave` ends them.
void read_tag_section(Cursor& at, std::string_view name, const Format& format, RawMesh& mesh, GmshEntities& entities,
                      std::vector<GmshValues>& values) {
  at.section(std::string(name));
  if (name == "$PhysicalNames") read_gmsh_names(at, mesh);
  if (name == "$ElementData") read_gmsh_element_data(at, format.binary, values);
  if (name != "$Entities" || format.version < 40) return;
  if (format.binary) at.line();
  at.binary(format.binary);
  entities = read_gmsh4_entities(at, format.version == 41, format.binary);
  at.binary(false);
}

}  // namespace

RawMesh read_gmsh(const std::filesystem::path& file, std::string_view data, bool tagged) {
  Cursor at(file, data);
  RawMesh mesh;
  mesh.tagged = tagged;
  NodeNumbers numbers;
  Format format;
  GmshEntities entities;
  CellEntities cell_entities;
  std::vector<GmshValues> values;
  bool nodes = false;
  bool elements = false;
  while (!at.at_end()) {
    const std::string_view name = at.token("a section");
    if (name.front() != '$') at.fail("expected a section such as $MeshFormat, $Nodes or $NOD");
    if (name == "$MeshFormat") {
      format = read_format(at);
      leave(at, name);
    } else {
      if (name == "$NOD") format.version = 1;
      if (read_section(at, name, format, mesh, numbers, cell_entities)) {
        (name == "$Nodes" || name == "$NOD" ? nodes : elements) = true;
      } else {
        if (tagged) read_tag_section(at, name, format, mesh, entities, values);
        leave(at, name);
      }
    }
  }
  if (!nodes) at.fail("the file has no section with nodes ($Nodes or $NOD)");
  if (!elements) at.fail("the file has no section with elements ($Elements or $ELM)");
  add_entity_tags(cell_entities, entities, mesh);
  add_gmsh_values(values, mesh);
  return mesh;
}

}  // namespace pliant::volume_file
