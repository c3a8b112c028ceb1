// Gmsh .msh: what $ElementData says of each element, one number.
#include <fmt/format.h>

#include <limits>
#include <unordered_map>

#include "mesh_io/read_volume_parts.h"

namespace pliant::volume_file {
namespace {

/// A line with a name, which programs put in quotes.
std::string read_tag(Cursor& at) {
  std::string_view text = at.line();
  while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.remove_suffix(1);
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return std::string(text);
}

}  // namespace

void read_gmsh_element_data(Cursor& at, bool binary, std::vector<GmshValues>& out) {
  const std::int64_t strings = at.count("the number of names", 1);
  at.line();
  GmshValues values;
  for (std::int64_t i = 0; i < strings; ++i) {
    const std::string text = read_tag(at);
    if (i == 0) values.name = text;
  }
  for (std::int64_t n = at.count("the number of real tags", 1); n > 0; --n) at.real("a real tag");
  const std::int64_t integers = at.count("the number of whole tags", 1);
  if (integers < 3)
    at.fail(fmt::format("{} whole tags; expected a time step, a number of components and one of elements", integers));
  std::int64_t components = 0, count = 0;
  for (std::int64_t i = 0; i < integers; ++i) {
    const std::int64_t tag = at.integer("a whole tag");
    if (i == 1) components = tag;
    if (i == 2) count = tag;
  }
  if (components != 1) return;  // a vector or a tensor, which is no number of an element
  if (binary) {
    at.line();
    at.binary(true);
  }
  at.check_count(count, "the number of elements", binary ? 12 : 4);
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t number = binary ? at.raw<std::int32_t>("an element number") : at.integer("an element number");
    values.element.push_back(number);
    values.value.push_back(binary ? at.raw<double>("a value") : at.real("a value"));
  }
  at.binary(false);
  for (const GmshValues& before : out) {
    if (before.name == values.name) return;  // of a later time step
  }
  out.push_back(std::move(values));
}

void add_gmsh_values(const std::vector<GmshValues>& all, RawMesh& mesh) {
  if (all.empty()) return;
  std::unordered_map<std::int64_t, std::int64_t> cell;  // of an element's number
  for (std::size_t i = 0; i < mesh.tet_cell.size(); ++i) cell.emplace(mesh.tet_numbers[i], mesh.tet_cell[i]);
  for (std::size_t i = 0; i < mesh.hex_cell.size(); ++i) cell.emplace(mesh.hex_numbers[i], mesh.hex_cell[i]);
  for (const GmshValues& values : all) {
    RawMesh::Values to{values.name, {}, {}};
    for (std::size_t i = 0; i < values.element.size(); ++i) {
      const auto at = cell.find(values.element[i]);
      if (at == cell.end()) continue;  // of a face, a line or a point
      to.cell.push_back(at->second);
      to.value.push_back(values.value[i]);
    }
    mesh.values.push_back(std::move(to));
  }
}

}  // namespace pliant::volume_file
