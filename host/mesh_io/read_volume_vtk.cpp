// VTK legacy files: UNSTRUCTURED_GRID as text or big-endian binary, with CELLS as one list or as OFFSETS and CONNECTIVITY.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>

#include "mesh_io/read_volume_parts.h"

namespace pliant::volume_file {
namespace {

class Legacy {
 public:
  Legacy(const std::filesystem::path& file, std::string_view data, bool tagged) : at_(file, data) { mesh_.tagged = tagged; }
  RawMesh read();

 private:
  void head();
  void points();
  void cells();
  void cell_types();
  void field();
  void metadata();
  void build();
  void begin_values(const char* section);
  void end_values() { at_.binary(false); }
  std::vector<std::int64_t> integers(std::int64_t n, const std::string& type, const char* what);

  Cursor at_;
  bool binary_ = false;
  bool have_points_ = false;
  bool have_cells_ = false;
  bool have_types_ = false;
  RawMesh mesh_;
  std::vector<std::int64_t> offsets_;  ///< one more than there are cells
  std::vector<std::int64_t> nodes_;
  std::vector<std::int64_t> types_;
};

void Legacy::head() {
  if (at_.line().substr(0, 5) != "# vtk") at_.fail("the first line must start with '# vtk DataFile'");
  at_.line();
  const std::string mode = lower_word(at_.token("ASCII or BINARY"));
  if (mode != "ascii" && mode != "binary") at_.fail(fmt::format("expected ASCII or BINARY, found '{}'", mode));
  binary_ = mode == "binary";
  // Legacy binary data are big-endian.
  at_.swap(std::endian::native == std::endian::little);
  if (lower_word(at_.token("DATASET")) != "dataset") at_.fail("expected DATASET");
  const std::string kind = lower_word(at_.token("the kind of data set"));
  if (kind != "unstructured_grid")
    at_.fail(fmt::format("data set '{}' holds no volume cells; allowed is UNSTRUCTURED_GRID", kind));
}

void Legacy::begin_values(const char* section) {
  at_.section(section);
  if (!binary_) return;
  at_.line();
  at_.binary(true);
}

std::vector<std::int64_t> Legacy::integers(std::int64_t n, const std::string& type, const char* what) {
  const std::size_t size = vtk_type_size(type);
  if ((size != 4 && size != 8) || type == "float" || type == "double")
    at_.fail(fmt::format("{} of type '{}' cannot be read", what, type));
  begin_values(what);
  at_.check_count(n, what, binary_ ? size : 1);
  std::vector<std::int64_t> out(static_cast<std::size_t>(n));
  for (std::int64_t& v : out) {
    v = !binary_ ? at_.integer(what) : size == 4 ? at_.raw<std::int32_t>(what) : at_.raw<std::int64_t>(what);
  }
  end_values();
  return out;
}

void Legacy::points() {
  const std::int64_t n = at_.count("the number of points", 5);
  const std::string type = lower_word(at_.token("the type of the points"));
  if (type != "float" && type != "double") at_.fail(fmt::format("points of type '{}'; allowed are float and double", type));
  if (n > std::numeric_limits<std::int32_t>::max()) at_.fail("more than 2147483647 points");
  begin_values("POINTS");
  if (binary_) at_.check_count(n, "the number of points", 3 * vtk_type_size(type));
  mesh_.points.resize(static_cast<std::size_t>(n));
  for (Vec3d& x : mesh_.points) {
    for (double& v : x) {
      v = !binary_          ? at_.real("a coordinate")
          : type == "float" ? at_.raw<float>("a coordinate")
                            : at_.raw<double>("a coordinate");
    }
  }
  end_values();
  have_points_ = true;
}

void Legacy::cells() {
  const std::int64_t first = at_.count("the number of cells", 1);
  const std::int64_t second = at_.count("the length of the cell list", 1);
  at_.line();
  if (at_.rest().substr(0, 7) == "OFFSETS") {
    at_.token("OFFSETS");
    offsets_ = integers(first, lower_word(at_.token("a type")), "cell offsets");
    if (at_.token("CONNECTIVITY") != "CONNECTIVITY") at_.fail("expected CONNECTIVITY");
    nodes_ = integers(second, lower_word(at_.token("a type")), "cell connectivity");
  } else {
    // integers() skips the rest of the line, which is gone already.
    at_.seek(at_.position() - 1);
    const std::vector<std::int64_t> list = integers(second, "int", "cells");
    offsets_.assign(1, 0);
    for (std::size_t i = 0; i < list.size();) {
      const std::int64_t n = list[i++];
      if (n < 0 || static_cast<std::size_t>(n) > list.size() - i) {
        at_.fail(fmt::format("cell {} has {} nodes, but the list ends after {}", offsets_.size() - 1, n, list.size() - i));
      }
      nodes_.insert(nodes_.end(), list.begin() + static_cast<std::ptrdiff_t>(i),
                    list.begin() + static_cast<std::ptrdiff_t>(i) + n);
      offsets_.push_back(static_cast<std::int64_t>(nodes_.size()));
      i += static_cast<std::size_t>(n);
    }
    if (static_cast<std::int64_t>(offsets_.size()) - 1 != first) {
      at_.fail(fmt::format("the cell list holds {} cells, CELLS announces {}", offsets_.size() - 1, first));
    }
  }
  have_cells_ = true;
}

void Legacy::cell_types() {
  types_ = integers(at_.count("the number of cell types", 1), "int", "cell types");
  have_types_ = true;
}

/// Data that belong to the whole file, which some writers put before the points: passed over.
void Legacy::field() {
  at_.token("a field's name");
  for (std::int64_t arrays = at_.count("the number of arrays", 1); arrays > 0; --arrays) {
    at_.token("an array's name");
    const std::int64_t components = at_.count("the number of components", 1);
    const std::int64_t tuples = at_.count("the number of tuples", 1);
    const std::string type = lower_word(at_.token("an array's type"));
    const std::size_t size = vtk_type_size(type);
    if (size == 0) at_.fail(fmt::format("field array of type '{}' cannot be read", type));
    begin_values("FIELD");
    if (components > 0 && static_cast<std::uint64_t>(tuples) > at_.remaining() / static_cast<std::uint64_t>(components)) {
      at_.fail(fmt::format("an array of {} times {} values cannot fit in the file", components, tuples));
    }
    const std::int64_t n = at_.check_count(components * tuples, "the number of values", binary_ ? size : 1);
    if (binary_) {
      at_.skip(static_cast<std::size_t>(n) * size, "a value");
    } else {
      for (std::int64_t i = 0; i < n; ++i) at_.token("a value");
    }
    end_values();
  }
}

/// Ends with an empty line.
void Legacy::metadata() {
  at_.line();
  while (at_.remaining() > 0 && !at_.line().empty()) continue;
}

void Legacy::build() {
  if (!have_points_ || !have_cells_ || !have_types_) {
    at_.fail(fmt::format("the file has no {}", !have_points_ ? "POINTS" : !have_cells_ ? "CELLS" : "CELL_TYPES"));
  }
  if (offsets_.empty() || types_.size() != offsets_.size() - 1) {
    at_.fail(fmt::format("{} cell types for {} cells", types_.size(), offsets_.empty() ? 0 : offsets_.size() - 1));
  }
  append_vtk_cells(mesh_, offsets_, nodes_, types_, 0, 0, at_);
}

RawMesh Legacy::read() {
  head();
  while (!at_.at_end()) {
    const std::string key = lower_word(at_.token("a keyword"));
    if (key == "points") {
      points();
    } else if (key == "cells") {
      cells();
    } else if (key == "cell_types") {
      cell_types();
    } else if (key == "field") {
      field();
    } else if (key == "metadata") {
      metadata();
    } else if (key == "point_data" || key == "cell_data") {
      build();  // attributes follow the geometry
      if (mesh_.tagged) read_vtk_attributes(at_, binary_, key == "cell_data", mesh_);
      return std::move(mesh_);
    } else {
      at_.fail(fmt::format("expected POINTS, CELLS, CELL_TYPES, FIELD, POINT_DATA or CELL_DATA, found '{}'", key));
    }
  }
  build();
  return std::move(mesh_);
}

}  // namespace

void append_vtk_cells(RawMesh& mesh, std::span<const std::int64_t> offsets, std::span<const std::int64_t> nodes,
                      std::span<const std::int64_t> types, std::int64_t first_cell, std::int64_t first_point,
                      const Cursor& at) {
  const std::int64_t points = static_cast<std::int64_t>(mesh.points.size()) - first_point;
  std::vector<std::int32_t> corners;
  for (std::size_t i = 0; i < types.size(); ++i) {
    const std::int64_t number = first_cell + static_cast<std::int64_t>(i);
    const std::int64_t from = offsets[i];
    const std::int64_t to = offsets[i + 1];
    if (from < 0 || to < from || to > static_cast<std::int64_t>(nodes.size())) {
      at.fail(fmt::format("cell {} takes entries {} to {} of a connectivity of {}", number, from, to, nodes.size()));
    }
    const CellType* type = vtk_cell(types[i]);
    if (type == nullptr) at.fail(fmt::format("cell {} has type {}, which is not known", number, types[i]));
    if (type->nodes != 0 && to - from != type->nodes) {
      at.fail(fmt::format("cell {} has {} nodes; its type {} has {}", number, to - from, types[i], type->nodes));
    }
    corners.clear();
    for (std::int64_t k = from; k < to; ++k) {
      const std::int64_t node = nodes[static_cast<std::size_t>(k)];
      if (node < 0 || node >= points)
        at.fail(fmt::format("cell {} names point {}; there are points 0 to {}", number, node, points - 1));
      corners.push_back(static_cast<std::int32_t>(first_point + node));
    }
    add_cell(mesh, *type, number, corners, at);
  }
}

RawMesh read_vtk(const std::filesystem::path& file, std::string_view data, bool tagged) {
  return Legacy(file, data, tagged).read();
}

}  // namespace pliant::volume_file
