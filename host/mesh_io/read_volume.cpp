// Reading a volume mesh: choice of format, then the checks that hold for all of them.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <numeric>
#include <system_error>
#include <tuple>

#include "mesh_io/lacking.h"
#include "mesh_io/mesh_io.h"
#include "mesh_io/mesh_tags.h"
#include "mesh_io/read_volume_parts.h"
#include "pliant/error.h"

namespace pliant {
namespace fs = std::filesystem;
using volume_file::RawMesh;
namespace {

RawMesh read_any(const fs::path& file, bool tagged) {
  std::string ext = file.extension().string();
  std::transform(ext.begin(), ext.end(), ext.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ext == ".node" || ext == ".ele") {
    fs::path base = file;
    const std::string node = volume_file::load(base.replace_extension(".node"));
    return volume_file::read_tetgen(base, node, volume_file::load(base.replace_extension(".ele")), tagged);
  }
  if (ext != ".msh" && ext != ".vtk" && ext != ".vtu") {
    throw Error(
        ErrorCode::bad_input,
        fmt::format("cannot read mesh '{}': extension '{}'; allowed are .msh (Gmsh), .vtk, .vtu, .node and .ele (TetGen){}",
                    file.string(), ext, lacking("mesh", ext)));
  }
  const std::string data = volume_file::load(file);
  return ext == ".msh"   ? volume_file::read_gmsh(file, data, tagged)
         : ext == ".vtk" ? volume_file::read_vtk(file, data, tagged)
                         : volume_file::read_vtu(file, data, tagged);
}

void check_vertices(const RawMesh& raw, const fs::path& file) {
  for (std::size_t i = 0; i < raw.points.size(); ++i) {
    const Vec3d& x = raw.points[i];
    if (!std::isfinite(x[0]) || !std::isfinite(x[1]) || !std::isfinite(x[2])) {
      throw Error(ErrorCode::bad_input, fmt::format("{}: vertex {} is not finite ({}, {}, {})", file.string(),
                                                    raw.point_number(i), x[0], x[1], x[2]));
    }
  }
}

void check_cells(const RawMesh& raw, const fs::path& file) {
  if (!raw.tets.empty() || !raw.hexes.empty()) return;
  std::string found;
  for (const auto& [name, n] : raw.others) found += fmt::format("{}{} {}", found.empty() ? "" : ", ", n, name);
  throw Error(ErrorCode::bad_input, fmt::format("{}: no tetrahedra or hexahedra; found {} vertices, {}", file.string(),
                                                raw.points.size(), found.empty() ? "no cells" : found));
}

double determinant(const Vec3d& o, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d u{a[0] - o[0], a[1] - o[1], a[2] - o[2]};
  const Vec3d v{b[0] - o[0], b[1] - o[1], b[2] - o[2]};
  const Vec3d w{c[0] - o[0], c[1] - o[1], c[2] - o[2]};
  return u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) + u[2] * (v[0] * w[1] - v[1] * w[0]);
}

/// The corner Jacobians of a hexahedron: at corner i, its edges towards r, s and t form a right-handed frame when it is valid.
constexpr std::array<std::array<std::size_t, 4>, 8> kHexCorners{
    {{0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6}, {3, 0, 2, 7}, {4, 7, 5, 0}, {5, 4, 6, 1}, {6, 5, 7, 2}, {7, 6, 4, 3}}};

template <std::size_t N>
double longest_cubed(const RawMesh& raw, const std::array<std::int32_t, N>& cell) {
  double longest = 0;
  for (std::size_t i = 1; i < N; ++i) {
    const Vec3d& a = raw.points[static_cast<std::size_t>(cell[0])];
    const Vec3d& b = raw.points[static_cast<std::size_t>(cell[i])];
    longest = std::max(longest, std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]));
  }
  return longest * longest * longest;
}

/// What decides a cell's orientation: the volume of a tetrahedron; of a hexahedron the mean of its corner Jacobians, which is
/// its volume when the faces are parallel.
double size_of(const RawMesh& raw, const std::array<std::int32_t, 4>& c) {
  const auto x = [&](std::size_t i) -> const Vec3d& { return raw.points[static_cast<std::size_t>(c[i])]; };
  return determinant(x(0), x(1), x(2), x(3)) / 6;
}

std::array<double, 8> corner_jacobians(const RawMesh& raw, const std::array<std::int32_t, 8>& c) {
  const auto x = [&](std::size_t i) -> const Vec3d& { return raw.points[static_cast<std::size_t>(c[i])]; };
  std::array<double, 8> out{};
  for (std::size_t i = 0; i < 8; ++i) {
    const auto& k = kHexCorners[i];
    out[i] = determinant(x(k[0]), x(k[1]), x(k[2]), x(k[3]));
  }
  return out;
}

double size_of(const RawMesh& raw, const std::array<std::int32_t, 8>& c) {
  const auto j = corner_jacobians(raw, c);
  return std::accumulate(j.begin(), j.end(), 0.0) / 8;
}

/// Below this share of the cube of its longest edge a volume is rounding error.
constexpr double kFlatVolume = 1e-13;

void flip(std::array<std::int32_t, 4>& c) { std::swap(c[2], c[3]); }
void flip(std::array<std::int32_t, 8>& c) { std::swap_ranges(c.begin(), c.begin() + 4, c.begin() + 4); }

/// Orient all cells of a kind; a file may use the opposite convention throughout, but a mixture is an error.
template <std::size_t N>
void orient(RawMesh& raw, std::vector<std::array<std::int32_t, N>>& cells, const std::vector<std::int64_t>& numbers,
            const char* name, const fs::path& file) {
  std::size_t negative = 0;
  std::size_t first = cells.size();
  double first_size = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double v = size_of(raw, cells[i]);
    if (!(std::abs(v) > kFlatVolume * longest_cubed(raw, cells[i])) || !std::isfinite(v)) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("{}: {} {} has no volume ({:.6g} in the file's units)", file.string(), name, numbers[i], v));
    }
    if (v > 0) continue;
    if (negative++ == 0) {
      first = i;
      first_size = v;
    }
  }
  if (negative == 0) return;
  if (negative < cells.size()) {
    throw Error(ErrorCode::bad_input, fmt::format("{}: {} {} is inverted (volume {:.6g} in the file's units); {} of {} are",
                                                  file.string(), name, numbers[first], first_size, negative, cells.size()));
  }
  for (auto& c : cells) flip(c);
}

/// A hexahedron in another node order, or folded, has a corner that is inside out although its volume may be positive.
void check_folds(const RawMesh& raw, const fs::path& file) {
  for (std::size_t i = 0; i < raw.hexes.size(); ++i) {
    const auto j = corner_jacobians(raw, raw.hexes[i]);
    const double scale = longest_cubed(raw, raw.hexes[i]);
    for (std::size_t k = 0; k < 8; ++k) {
      if (j[k] < -1e-9 * scale) {
        throw Error(
            ErrorCode::bad_input,
            fmt::format(
                "{}: hexahedron {} is folded at its corner {} (vertex {}, Jacobian {:.6g}); corners must follow VTK's order",
                file.string(), raw.hex_numbers[i], k, raw.point_number(static_cast<std::size_t>(raw.hexes[i][k])), j[k]));
      }
    }
  }
}

/// Drop cells that occur again with the same corners: Gmsh writes an element once for each physical group it belongs to.
/// Returns which of the kept cells each one is.
template <std::size_t N>
std::vector<std::int32_t> drop_repeated(std::vector<std::array<std::int32_t, N>>& cells, std::vector<std::int64_t>& numbers) {
  std::vector<std::pair<std::array<std::int32_t, N>, std::size_t>> keys(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    keys[i] = {cells[i], i};
    std::sort(keys[i].first.begin(), keys[i].first.end());
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::size_t> first(cells.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const bool repeated = i > 0 && keys[i].first == keys[i - 1].first;
    first[keys[i].second] = repeated ? first[keys[i - 1].second] : keys[i].second;
  }
  std::vector<std::int32_t> place(cells.size());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    place[i] = first[i] == i ? static_cast<std::int32_t>(kept) : place[first[i]];  // the first of equal ones comes first
    if (first[i] != i) continue;
    cells[kept] = cells[i];
    numbers[kept++] = numbers[i];
  }
  cells.resize(kept);
  numbers.resize(kept);
  return place;
}

/// `faces` follow the new numbers of vertices; a face with one that is in no element is -1 throughout.
VolumeMesh compact(RawMesh& raw, double scale, const Vec3d& translate) {
  VolumeMesh out;
  std::vector<std::int32_t> index(raw.points.size(), -1);
  const auto mark = [&](auto& cells) {
    for (const auto& c : cells) {
      for (const std::int32_t i : c) index[static_cast<std::size_t>(i)] = 0;
    }
  };
  mark(raw.tets);
  mark(raw.hexes);
  for (std::size_t i = 0; i < index.size(); ++i) {
    if (index[i] < 0) continue;
    index[i] = static_cast<std::int32_t>(out.vertices.size());
    const Vec3d& x = raw.points[i];
    out.vertices.push_back({x[0] * scale + translate[0], x[1] * scale + translate[1], x[2] * scale + translate[2]});
  }
  const auto renumber = [&](auto& cells) {
    for (auto& c : cells) {
      for (std::int32_t& i : c) i = index[static_cast<std::size_t>(i)];
    }
  };
  renumber(raw.tets);
  renumber(raw.hexes);
  for (auto& face : raw.faces) {
    const bool on = std::all_of(face.begin(), face.end(), [&](std::int32_t i) { return i < 0 || index[i] >= 0; });
    for (std::int32_t& i : face) i = on && i >= 0 ? index[i] : -1;
  }
  out.tets = std::move(raw.tets);
  out.hexes = std::move(raw.hexes);
  return out;
}

/// From cells of the file to elements and faces of the mesh. `tet`, `hex`: what drop_repeated said.
MeshTags tags_of(RawMesh& raw, const std::vector<std::int32_t>& tet, const std::vector<std::int32_t>& hex, std::size_t tets,
                 std::size_t elements) {
  struct Place {
    int dimension = 0;  ///< 0: neither an element nor a face on one
    std::int32_t at = 0;
  };
  std::vector<Place> place(static_cast<std::size_t>(raw.cells));
  for (std::size_t i = 0; i < tet.size(); ++i) place[raw.tet_cell[i]] = {3, tet[i]};
  for (std::size_t i = 0; i < hex.size(); ++i) place[raw.hex_cell[i]] = {3, static_cast<std::int32_t>(tets) + hex[i]};
  for (std::size_t i = 0; i < raw.faces.size(); ++i) {
    if (raw.faces[i][0] >= 0) place[raw.face_cell[i]] = {2, static_cast<std::int32_t>(i)};
  }
  MeshTags out;
  out.faces = std::move(raw.faces);
  out.names = std::move(raw.names);
  for (const RawMesh::Array& array : raw.arrays) {
    MeshTags::Array& to = out.arrays.emplace_back(MeshTags::Array{array.name, {}});
    for (std::size_t i = 0; i < array.cell.size(); ++i) {
      const Place& p = place[static_cast<std::size_t>(array.cell[i])];
      if (p.dimension != 0) to.tags.push_back({p.dimension, p.at, array.value[i]});
    }
    const auto key = [](const MeshTags::Tag& t) { return std::make_tuple(-t.dimension, t.place, t.number); };
    std::sort(to.tags.begin(), to.tags.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
    const auto same = [&](const auto& a, const auto& b) { return key(a) == key(b); };
    to.tags.erase(std::unique(to.tags.begin(), to.tags.end(), same), to.tags.end());
    if (to.tags.empty()) out.arrays.pop_back();
  }
  for (const RawMesh::Values& array : raw.values) {
    MeshTags::Values to{array.name, std::vector<double>(elements, std::numeric_limits<double>::quiet_NaN())};
    bool any = false;
    for (std::size_t i = 0; i < array.cell.size(); ++i) {
      const Place& p = place[static_cast<std::size_t>(array.cell[i])];
      if (p.dimension != 3) continue;
      to.of[static_cast<std::size_t>(p.at)] = array.value[i];
      any = true;
    }
    if (any) out.values.push_back(std::move(to));
  }
  return out;
}

}  // namespace

VolumeMesh read_volume(const fs::path& file, double scale, const Vec3d& translate, MeshTags* tags) {
  if (!(scale > 0) || !std::isfinite(scale))
    throw Error(ErrorCode::bad_input, fmt::format("mesh '{}': scale {} must be positive", file.string(), scale));
  RawMesh raw = read_any(file, tags != nullptr);
  check_vertices(raw, file);
  check_cells(raw, file);
  const std::vector<std::int32_t> tet = drop_repeated(raw.tets, raw.tet_numbers);
  const std::vector<std::int32_t> hex = drop_repeated(raw.hexes, raw.hex_numbers);
  orient(raw, raw.tets, raw.tet_numbers, "tetrahedron", file);
  orient(raw, raw.hexes, raw.hex_numbers, "hexahedron", file);
  check_folds(raw, file);
  VolumeMesh mesh = compact(raw, scale, translate);
  if (tags != nullptr) *tags = tags_of(raw, tet, hex, mesh.tets.size(), mesh.tets.size() + mesh.hexes.size());
  return mesh;
}

}  // namespace pliant
