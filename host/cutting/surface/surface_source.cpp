#include "cutting/surface/surface_source.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "geometry/orient.h"
#include "geometry/polygon.h"

namespace pliant::overlay {
namespace {

// Triangles this close to a cell, as a share of the spacing, count as meeting it: more than snapping and rounding can move
// anything.
constexpr double kSourceMargin = 1e-6;

using HalfEdges = std::unordered_map<std::uint64_t, std::vector<std::array<std::int32_t, 2>>>;  // {triangle, side}

std::uint64_t pair_key(std::int32_t a, std::int32_t b) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(a)) << 32 | static_cast<std::uint32_t>(b);
}

bool degenerate(const std::array<std::int32_t, 3>& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

// The half-edges that have no partner, by their first vertex.
std::unordered_map<std::int32_t, std::vector<std::int32_t>> open_half_edges(const TriangleMesh& mesh) {
  std::unordered_map<std::uint64_t, std::int32_t> excess;  // directed from the lower vertex
  for (const auto& t : mesh.triangles) {
    for (int i = 0; i < 3 && !degenerate(t); ++i) {
      const std::int32_t u = t[i], w = t[(i + 1) % 3];
      excess[pair_key(std::min(u, w), std::max(u, w))] += u < w ? 1 : -1;
    }
  }
  std::vector<std::array<std::int32_t, 2>> open;
  for (const auto& [key, count] : excess) {
    const auto low = static_cast<std::int32_t>(key >> 32), high = static_cast<std::int32_t>(key & 0xffffffffU);
    for (std::int32_t i = 0; i < std::abs(count); ++i)
      open.push_back(count > 0 ? std::array{low, high} : std::array{high, low});
  }
  std::sort(open.begin(), open.end());
  std::unordered_map<std::int32_t, std::vector<std::int32_t>> out;
  for (const auto& [u, w] : open) out[w].push_back(u);  // a filler runs the other way
  return out;
}

// Two axes in the plane of a loop, so that it runs counter-clockwise.
std::vector<FlatPoint> flatten(const TriangleMesh& mesh, const std::vector<std::int32_t>& loop) {
  Vec3d normal{};
  const Vec3d& base = mesh.vertices[loop[0]];
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    normal = vec::add(normal, vec::cross(vec::sub(mesh.vertices[loop[i]], base), vec::sub(mesh.vertices[loop[i + 1]], base)));
  }
  const double length = vec::norm(normal);
  const Vec3d n = length > 0 ? vec::mul(normal, 1 / length) : Vec3d{0, 0, 1};
  const int least =
      std::abs(n[0]) < std::abs(n[1]) ? (std::abs(n[0]) < std::abs(n[2]) ? 0 : 2) : (std::abs(n[1]) < std::abs(n[2]) ? 1 : 2);
  Vec3d axis{};
  axis[least] = 1;
  const Vec3d u = vec::cross(axis, n), v = vec::cross(n, u);
  std::vector<FlatPoint> points;
  for (const std::int32_t vertex : loop) {
    const Vec3d d = vec::sub(mesh.vertices[vertex], base);
    points.push_back({vec::dot(d, u), vec::dot(d, v), 0});
  }
  return points;
}

}  // namespace

GridIndex CutGrid::cell_at(const Vec3d& p) const {
  GridIndex cell{};
  for (int a = 0; a < 3; ++a) {
    const double x = std::floor((p[a] - origin[a]) / spacing);
    cell[a] = static_cast<std::int32_t>(std::clamp(x, -1.0, static_cast<double>(size[a])));
  }
  return cell;
}

SurfaceSource::SurfaceSource(TriangleMesh mesh, const CutGrid& grid) : mesh_(std::move(mesh)), grid_(grid) {
  orient_outward(mesh_);
  vec::Box box;
  box.extend(grid_.position({-1, -1, -1}));
  box.extend(grid_.position({grid.size[0] + 1, grid.size[1] + 1, grid.size[2] + 1}));
  for (const Vec3d& v : mesh_.vertices) box.extend(v);
  frame_ = ExactFrame(box);
  for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
    exact_.push_back(frame_.snap(mesh_.vertices[v], -1 - static_cast<std::int64_t>(v)));
  }
  close_holes();
  pair_edges();
  sort_into_cells();
}

void SurfaceSource::close_holes() {
  auto open = open_half_edges(mesh_);
  std::vector<std::int32_t> starts;
  for (const auto& [vertex, ends] : open) starts.push_back(vertex);
  std::sort(starts.begin(), starts.end());
  for (const std::int32_t start : starts) {
    while (!open[start].empty()) {
      std::vector<std::int32_t> path{start};
      std::unordered_map<std::int32_t, std::size_t> seen{{start, 0}};
      while (!path.empty()) {  // a walk; whenever it meets itself the loop is cut off and filled
        auto& ends = open[path.back()];
        if (ends.empty()) break;
        const std::int32_t next = ends.back();
        ends.pop_back();
        const auto [found, is_new] = seen.emplace(next, path.size());
        if (is_new) {
          path.push_back(next);
          continue;
        }
        const std::vector<std::int32_t> loop(path.begin() + static_cast<std::ptrdiff_t>(found->second), path.end());
        for (std::size_t i = found->second + 1; i < path.size(); ++i) seen.erase(path[i]);
        path.resize(found->second + 1);
        for (const auto& t : triangulate(flatten(mesh_, loop), {{[&] {
                                                                   std::vector<std::int32_t> all(loop.size());
                                                                   for (std::size_t i = 0; i < all.size(); ++i)
                                                                     all[i] = static_cast<std::int32_t>(i);
                                                                   return all;
                                                                 }(),
                                                                 false}})) {
          mesh_.triangles.push_back({loop[t[0]], loop[t[1]], loop[t[2]]});
          ++fillers_;
        }
      }
    }
  }
}

void SurfaceSource::pair_edges() {
  triangle_edges_.assign(mesh_.triangles.size(), {-1, -1, -1});
  HalfEdges waiting;
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const auto& corners = mesh_.triangles[t];
    const auto triangle = static_cast<std::int32_t>(t);
    for (std::int32_t i = 0; i < 3 && !degenerate(corners); ++i) {
      const std::int32_t u = corners[i], w = corners[(i + 1) % 3];
      auto& partners = waiting[pair_key(w, u)];
      if (!partners.empty()) {
        const auto [other, side] = partners.front();
        partners.erase(partners.begin());
        const std::int32_t edge = triangle_edges_[other][side];
        triangle_edges_[t][i] = edge;
        edges_[edge].face[1] = triangle;
      } else {
        waiting[pair_key(u, w)].push_back({triangle, i});
        triangle_edges_[t][i] = static_cast<std::int32_t>(edges_.size());
        edges_.push_back({u, w, {triangle, -1}});
      }
    }
  }
}

void SurfaceSource::sort_into_cells() {
  std::vector<std::pair<std::int64_t, std::int32_t>> pairs;
  const double h = grid_.spacing;
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const auto& c = mesh_.triangles[t];
    if (degenerate(c)) continue;
    const Vec3d &p = mesh_.vertices[c[0]], &q = mesh_.vertices[c[1]], &r = mesh_.vertices[c[2]];
    GridIndex low{}, high{};
    for (int a = 0; a < 3; ++a) {
      const auto index = [&](double x, double margin) {
        return static_cast<std::int32_t>(
            std::clamp(std::floor((x - grid_.origin[a]) / h + margin), -1.0, static_cast<double>(grid_.size[a])));
      };
      low[a] = index(std::min({p[a], q[a], r[a]}), -kSourceMargin);
      high[a] = index(std::max({p[a], q[a], r[a]}), kSourceMargin);
    }
    const Vec3d n = vec::cross(vec::sub(q, p), vec::sub(r, p));
    const double reach = (0.5 + 2 * kSourceMargin) * h * (std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]));
    const bool many = low != high;
    for (std::int32_t k = low[2]; k <= high[2]; ++k) {
      for (std::int32_t j = low[1]; j <= high[1]; ++j) {
        for (std::int32_t i = low[0]; i <= high[0]; ++i) {
          const Vec3d middle = vec::add(grid_.position({i, j, k}), {0.5 * h, 0.5 * h, 0.5 * h});
          if (many && std::abs(vec::dot(n, vec::sub(middle, p))) > reach) continue;
          pairs.emplace_back(grid_.number({i, j, k}), static_cast<std::int32_t>(t));
        }
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  cell_offset_.assign(grid_.numbers() + 1, 0);
  for (const auto& [cell, triangle] : pairs) {
    cell_triangles_.push_back(triangle);
    ++cell_offset_[cell + 1];
  }
  std::partial_sum(cell_offset_.begin(), cell_offset_.end(), cell_offset_.begin());
}

std::span<const std::int32_t> SurfaceSource::triangles_at(const GridIndex& cell) const {
  for (int a = 0; a < 3; ++a) {
    if (cell[a] < -1 || cell[a] > grid_.size[a]) return {};
  }
  const std::int64_t number = grid_.number(cell);
  return {cell_triangles_.data() + cell_offset_[number], cell_triangles_.data() + cell_offset_[number + 1]};
}

int SurfaceSource::winding(const GridIndex& corner) {
  auto& row = windings_[grid_.number({-1, corner[1], corner[2]})];
  if (row.empty()) {
    row.push_back(0);  // corner -1 lies outside
    int now = 0;
    std::vector<std::int32_t> near;
    for (std::int32_t i = -1; i <= grid_.size[0]; ++i) {
      near.clear();
      for (const GridIndex& cell : {GridIndex{i, corner[1], corner[2]}, GridIndex{i, corner[1] - 1, corner[2]},
                                    GridIndex{i, corner[1], corner[2] - 1}, GridIndex{i, corner[1] - 1, corner[2] - 1}}) {
        if (cell[1] < -1 || cell[2] < -1) continue;
        const auto some = triangles_at(cell);
        near.insert(near.end(), some.begin(), some.end());
      }
      std::sort(near.begin(), near.end());
      near.erase(std::unique(near.begin(), near.end()), near.end());
      const ExactPoint p = exact_corner({i, corner[1], corner[2]}), q = exact_corner({i + 1, corner[1], corner[2]});
      for (const std::int32_t t : near) now -= crossing(p, q, t);
      row.push_back(static_cast<std::int8_t>(std::clamp(now, -127, 127)));
    }
  }
  return row[static_cast<std::size_t>(corner[0]) + 1];
}

}  // namespace pliant::overlay
