// What the methods share: adjacency, boundary, figures, the stable step of plain elements.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "cutting/topology/cut_cell.h"
#include "elements/elements.h"
#include "geometry/disjoint_sets.h"
#include "geometry/vec.h"
#include "tearing/method.h"

namespace pliant {
namespace {

std::array<Vec3d, 4> corners_of(const ElementMesh& mesh, const std::array<std::int32_t, 4>& tet) {
  return {mesh.nodes[tet[0]], mesh.nodes[tet[1]], mesh.nodes[tet[2]], mesh.nodes[tet[3]]};
}

double volume_of(const std::array<Vec3d, 4>& x) {
  return vec::dot(vec::cross(vec::sub(x[1], x[0]), vec::sub(x[2], x[0])), vec::sub(x[3], x[0])) / 6;
}

/// VolumeMesh wants VTK's order of corners.
VolumeMesh as_volume_mesh(const ElementMesh& mesh) {
  VolumeMesh out{mesh.nodes, mesh.tets, {}};
  for (const auto& hex : mesh.hexes) {
    std::array<std::int32_t, 8> corners{};
    for (int a = 0; a < 8; ++a) corners[a] = hex[kVtkFromBits[a]];
    out.hexes.push_back(corners);
  }
  return out;
}

}  // namespace

std::int64_t singular_edges(const std::vector<std::array<std::int32_t, 3>>& triangles) {
  std::map<std::array<std::int32_t, 2>, std::array<int, 2>> uses;  // of an edge, upwards and downwards
  for (const auto& t : triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::int32_t a = t[k], b = t[(k + 1) % 3];
      ++uses[{std::min(a, b), std::max(a, b)}][a < b ? 0 : 1];
    }
  }
  std::int64_t singular = 0;
  for (const auto& [edge, count] : uses) singular += count[0] != 1 || count[1] != 1;
  return singular;
}

ElementMesh plain_mesh(const BodyMesh& solid) {
  return {solid.nodes, solid.tets, solid.tets.empty() ? solid.hexes : decltype(solid.hexes){}, solid.fill};
}

ElementMesh kuhn_tetrahedra(const ElementMesh& mesh) {
  if (mesh.hexes.empty()) return mesh;
  ElementMesh out;
  out.nodes = mesh.nodes;
  for (std::size_t e = 0; e < mesh.hexes.size(); ++e) {
    const auto& h = mesh.hexes[e];
    for (const auto& t : kKuhnTets) out.tets.push_back({h[t[0]], h[t[1]], h[t[2]], h[t[3]]});
    out.fill.resize(out.tets.size(), mesh.fill[e]);
  }
  return out;
}

std::vector<std::array<std::int32_t, 3>> boundary_of(const ElementMesh& mesh) {
  return boundary_triangles(as_volume_mesh(mesh));
}

BodyMesh solid_of(const ElementMesh& mesh) {
  BodyMesh solid;
  solid.tets = mesh.tets;
  solid.hexes = mesh.hexes;
  solid.fill = mesh.fill;
  // Nodes that no element is left to have would be nodes without mass.
  std::vector<std::int32_t> kept(mesh.nodes.size(), -1);
  const auto keep = [&](std::int32_t& n) {
    if (kept[n] < 0) {
      kept[n] = static_cast<std::int32_t>(solid.nodes.size());
      solid.nodes.push_back(mesh.nodes[n]);
    }
    n = kept[n];
  };
  for (auto& tet : solid.tets) std::for_each(tet.begin(), tet.end(), keep);
  for (auto& hex : solid.hexes) std::for_each(hex.begin(), hex.end(), keep);
  solid.triangles = boundary_of({solid.nodes, solid.tets, solid.hexes, {}});
  surface_on_nodes(solid);
  return solid;
}

double tet_quality(const std::array<Vec3d, 4>& x) {
  double edges = 0;
  for (const auto& [a, b] : kTetEdges) {
    const Vec3d e = vec::sub(x[b], x[a]);
    edges += vec::dot(e, e);
  }
  const double volume = volume_of(x);
  return edges > 0 ? std::copysign(12 * std::cbrt(9 * volume * volume) / edges, volume) : 0;
}

double mean_edge(const ElementMesh& mesh) {
  double sum = 0;
  for (const auto& tet : mesh.tets) {
    for (const auto& [a, b] : kTetEdges) sum += vec::norm(vec::sub(mesh.nodes[tet[a]], mesh.nodes[tet[b]]));
  }
  return mesh.tets.empty() ? 0 : sum / (6.0 * static_cast<double>(mesh.tets.size()));
}

double element_bound(const ElementMesh& mesh, const Material& material) {
  double highest = 0;
  const auto ask = [&](std::span<const Vec3d> x) {
    const ElementKind kind = usual_element(static_cast<int>(x.size()));
    const std::vector<double> record = element_record(kind, x, material, "an element to cut");
    highest = std::max(highest, element_frequency(kind, record, material));
  };
  for (const auto& tet : mesh.tets) ask(corners_of(mesh, tet));
  for (const auto& hex : mesh.hexes) {
    std::array<Vec3d, 8> x;
    for (int a = 0; a < 8; ++a) x[a] = mesh.nodes[hex[a]];
    ask(x);
  }
  return highest > 0 ? 2 / highest : 0;
}

MeshFigures figures_of(const ElementMesh& mesh) {
  MeshFigures f;
  f.elements = static_cast<std::int64_t>(mesh.tets.size() + mesh.hexes.size());
  f.least_quality = mesh.tets.empty() ? 0 : std::numeric_limits<double>::infinity();
  DisjointSets sets(mesh.nodes.size());
  std::vector<char> used(mesh.nodes.size(), 0);
  const auto join = [&](const auto& nodes) {
    for (const std::int32_t n : nodes) {
      used[n] = 1;
      sets.join(nodes[0], n);
    }
  };
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    const auto x = corners_of(mesh, mesh.tets[e]);
    f.material += volume_of(x) * (mesh.fill.empty() ? 1 : mesh.fill[e]);
    f.least_quality = std::min(f.least_quality, tet_quality(x));
    join(mesh.tets[e]);
  }
  const ElementMesh parts = kuhn_tetrahedra({mesh.nodes, {}, mesh.hexes, std::vector<double>(mesh.hexes.size(), 1.0)});
  for (std::size_t t = 0; t < parts.tets.size(); ++t) {
    const std::size_t e = t / kKuhnTets.size();
    f.material += volume_of(corners_of(parts, parts.tets[t])) * (mesh.fill.empty() ? 1 : mesh.fill[e]);
  }
  for (const auto& hex : mesh.hexes) join(hex);
  for (std::size_t n = 0; n < used.size(); ++n) {
    f.nodes += used[n];
    f.pieces += used[n] != 0 && sets.find(static_cast<std::int32_t>(n)) == static_cast<std::int32_t>(n);
  }
  const auto triangles = boundary_of(mesh);
  f.enclosed = signed_volume({mesh.nodes, triangles});
  f.singular_edges = pliant::singular_edges(triangles);
  return f;
}

namespace {

template <std::size_t Corners>
auto neighbors_of(const std::vector<std::array<std::int32_t, Corners>>& elements) {
  using Shape = ElementShape<Corners>;
  constexpr std::size_t kFaces = Shape::faces.size(), kNodes = Shape::faces[0].size();
  struct Side {
    std::array<std::int32_t, kNodes> key;
    TetFace at;
  };
  std::vector<Side> sides;
  sides.reserve(kFaces * elements.size());
  for (std::size_t e = 0; e < elements.size(); ++e) {
    for (std::size_t f = 0; f < kFaces; ++f) {
      std::array<std::int32_t, kNodes> key{};
      for (std::size_t k = 0; k < kNodes; ++k) key[k] = elements[e][static_cast<std::size_t>(Shape::faces[f][k])];
      std::sort(key.begin(), key.end());
      sides.push_back({key, {static_cast<std::int32_t>(e), static_cast<std::int8_t>(f)}});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return a.key != b.key ? a.key < b.key : a.at.tet < b.at.tet; });
  std::array<TetFace, kFaces> alone;
  alone.fill({-1, 0});
  std::vector<std::array<TetFace, kFaces>> out(elements.size(), alone);
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    if (sides[i].key != sides[i + 1].key) continue;
    const TetFace a = sides[i].at, b = sides[i + 1].at;
    out[a.tet][a.face] = b;
    out[b.tet][b.face] = a;
    ++i;
  }
  return out;
}

}  // namespace

std::vector<std::array<TetFace, 4>> element_neighbors(const std::vector<std::array<std::int32_t, 4>>& tets) {
  return neighbors_of(tets);
}

std::vector<std::array<TetFace, 6>> element_neighbors(const std::vector<std::array<std::int32_t, 8>>& hexes) {
  return neighbors_of(hexes);
}

}  // namespace pliant
