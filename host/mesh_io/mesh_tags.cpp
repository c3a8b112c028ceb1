#include "mesh_io/mesh_tags.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace pliant {

namespace {

bool alike(const std::string& a, const std::string& b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace

const std::vector<std::string>& MeshTags::usual_arrays() {
  static const std::vector<std::string> names{"gmsh:physical", "medit:ref", "CellEntityIds", "MaterialIds",
                                              "material",      "region",    "label"};
  return names;
}

std::string MeshTags::listed(const std::vector<Region>& regions) {
  constexpr std::size_t most = 20;
  std::string text;
  for (std::size_t i = 0; i < regions.size() && i < most; ++i) {
    const Region& r = regions[i];
    text += fmt::format("{}{}{} ({} {}{})", i == 0 ? "" : ", ", r.number, r.name.empty() ? "" : " \"" + r.name + "\"", r.cells,
                        r.dimension == 3 ? "element" : "face", r.cells == 1 ? "" : "s");
  }
  if (regions.size() > most) text += fmt::format(" and {} more", regions.size() - most);
  return text;
}

const MeshTags::Array* MeshTags::find(const std::string& name) const {
  for (const std::string& usual : name.empty() ? usual_arrays() : std::vector<std::string>{name}) {
    for (const Array& array : arrays) {
      if (name.empty() ? alike(array.name, usual) : array.name == usual) return &array;
    }
  }
  return nullptr;
}

const MeshTags::Values* MeshTags::values_of(const std::string& name) const {
  const auto found = std::find_if(values.begin(), values.end(), [&](const Values& v) { return v.name == name; });
  return found == values.end() ? nullptr : &*found;
}

std::vector<MeshTags::Region> MeshTags::regions(const Array& array) const {
  std::map<std::pair<int, std::int64_t>, std::int64_t> cells;  // by -dimension, so that elements come first
  for (const Tag& tag : array.tags) ++cells[{-tag.dimension, tag.number}];
  std::vector<Region> out;
  for (const auto& [key, count] : cells) {
    const auto name = array.name == "gmsh:physical" ? names.find({-key.first, key.second}) : names.end();
    out.push_back({-key.first, key.second, name == names.end() ? "" : name->second, count});
  }
  return out;
}

}  // namespace pliant
