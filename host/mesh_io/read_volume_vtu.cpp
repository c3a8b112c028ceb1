// VTK XML unstructured grids (.vtu).
#include <fmt/format.h>

#include <limits>
#include <pugixml.hpp>

#include "mesh_io/read_volume_parts.h"
#include "mesh_io/read_volume_vtu_data.h"

namespace pliant::volume_file {
namespace {

/// Separates the XML from the appended data, since raw data would not be well-formed.
struct Split {
  std::string xml;
  VtuEncoding encoding;
};

Split split(std::string_view data, const Cursor& at) {
  Split s;
  const std::size_t tag = data.find("<AppendedData");
  if (tag == std::string_view::npos) {
    s.xml = data;
    return s;
  }
  const std::size_t close = data.find('>', tag);
  const std::size_t underscore = close == std::string_view::npos ? close : data.find('_', close);
  if (underscore == std::string_view::npos) at.fail("the appended data do not start with an underscore");
  const std::string_view head = data.substr(tag, close - tag);
  if (head.find("base64") != std::string_view::npos) {
    s.encoding.appended_raw = false;
  } else if (head.find("raw") == std::string_view::npos) {
    at.fail("the appended data are encoded neither as raw nor as base64");
  }
  s.encoding.appended = data.substr(underscore + 1);
  s.xml = std::string(data.substr(0, tag)) + "</VTKFile>";
  return s;
}

void read_encoding(const pugi::xml_node& root, VtuEncoding& e, const Cursor& at) {
  const std::string type = root.attribute("type").value();
  if (type != "UnstructuredGrid") at.fail(fmt::format("type '{}' holds no volume cells; allowed is UnstructuredGrid", type));
  const std::string order = root.attribute("byte_order").value();
  e.swap = (order == "BigEndian") != (std::endian::native == std::endian::big);
  e.wide = std::string(root.attribute("header_type").value()) == "UInt64";
  e.compressor = root.attribute("compressor").value();
}

VtuArrayText array_text(const pugi::xml_node& node) {
  return {node.attribute("type").value(), node.attribute("format").as_string("ascii"), node.child_value(),
          node.attribute("offset").as_ullong()};
}

template <class T>
std::vector<T> read_array(const pugi::xml_node& node, const std::string& where, const VtuEncoding& e, Cursor& at) {
  at.section(where);
  if (!node) at.fail("the array is missing");
  return vtu_values<T>(array_text(node), e, at);
}

/// Whole numbers of cells, one each; other arrays are no tags.
void read_cell_data(const pugi::xml_node& node, const std::string& name, std::int64_t first_cell, std::size_t cells,
                    const VtuEncoding& e, RawMesh& mesh, Cursor& at) {
  for (const pugi::xml_node& array : node.child("CellData").children("DataArray")) {
    const std::string array_name = array.attribute("Name").value();
    if (array_name.empty() || array.attribute("NumberOfComponents").as_int(1) > 1) continue;
    const std::string where = fmt::format("{}/CellData/{}", name, shown(array_name));
    const auto keep = [&](const auto& values) {
      if (values.size() != cells) at.fail(fmt::format("{} values for {} cells", values.size(), cells));
      add_cell_values(mesh, array_name, first_cell, values);
    };
    const std::string type = array.attribute("type").value();
    if (type == "Float32" || type == "Float64") {
      keep(read_array<double>(array, where, e, at));
    } else if (type.find("Int") != std::string::npos) {
      keep(read_array<std::int64_t>(array, where, e, at));
    }
  }
}

struct Piece {
  std::int64_t cells = 0;  ///< of the pieces before
  std::size_t index = 0;
};

void read_piece(const pugi::xml_node& node, const VtuEncoding& e, Piece& piece, RawMesh& mesh, Cursor& at) {
  const std::string name = fmt::format("Piece {}", piece.index++);
  const auto first_point = static_cast<std::int64_t>(mesh.points.size());
  const std::vector<double> x = read_array<double>(node.child("Points").child("DataArray"), name + "/Points", e, at);
  if (x.size() != 3 * node.attribute("NumberOfPoints").as_ullong()) {
    at.fail(fmt::format("{} coordinates for NumberOfPoints=\"{}\"", x.size(), node.attribute("NumberOfPoints").value()));
  }
  if (mesh.points.size() + x.size() / 3 > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    at.fail("more than 2147483647 points");
  for (std::size_t i = 0; i < x.size(); i += 3) mesh.points.push_back({x[i], x[i + 1], x[i + 2]});

  const pugi::xml_node cells = node.child("Cells");
  const auto ints = [&](const char* array) {
    return read_array<std::int64_t>(cells.find_child_by_attribute("DataArray", "Name", array), name + "/Cells/" + array, e, at);
  };
  const std::vector<std::int64_t> nodes = ints("connectivity");
  std::vector<std::int64_t> offsets = ints("offsets");
  const std::vector<std::int64_t> types = ints("types");
  if (types.size() != node.attribute("NumberOfCells").as_ullong() || types.size() != offsets.size()) {
    at.fail(fmt::format("{} types and {} offsets for NumberOfCells=\"{}\"", types.size(), offsets.size(),
                        node.attribute("NumberOfCells").value()));
  }
  offsets.insert(offsets.begin(), 0);
  at.section(name + "/Cells");
  append_vtk_cells(mesh, offsets, nodes, types, piece.cells, first_point, at);
  if (mesh.tagged) read_cell_data(node, name, piece.cells, types.size(), e, mesh, at);
  piece.cells += static_cast<std::int64_t>(types.size());
}

}  // namespace

RawMesh read_vtu(const std::filesystem::path& file, std::string_view data, bool tagged) {
  Cursor at(file, data);
  at.section("VTKFile");
  at.section_only();
  Split s = split(data, at);
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(s.xml.data(), s.xml.size());
  if (!result) {
    Cursor text(file, s.xml);
    text.seek(std::min(static_cast<std::size_t>(result.offset), s.xml.size()));
    text.fail(fmt::format("not well-formed XML: {}", result.description()));
  }
  const pugi::xml_node root = document.child("VTKFile");
  if (!root) at.fail("the file has no VTKFile element");
  read_encoding(root, s.encoding, at);
  RawMesh mesh;
  mesh.tagged = tagged;
  Piece piece;
  for (const pugi::xml_node& node : root.child("UnstructuredGrid").children("Piece"))
    read_piece(node, s.encoding, piece, mesh, at);
  if (piece.index == 0) at.fail("the file has no UnstructuredGrid with a Piece");
  return mesh;
}

}  // namespace pliant::volume_file
