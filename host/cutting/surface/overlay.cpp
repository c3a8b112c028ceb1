#include "cutting/surface/overlay.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "cutting/surface/overlay_order.h"
#include "pliant/error.h"

namespace pliant::overlay {
namespace {

template <class T>
void erase_value(std::vector<T>& from, const T& value) {
  from.erase(std::remove(from.begin(), from.end(), value), from.end());
}

void make_unique(std::vector<std::int32_t>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

template <class... Points>
vec::Box box_of(double margin, const Points&... points) {
  vec::Box box;
  (box.extend(points), ...);
  for (int a = 0; a < 3; ++a) {
    box.lower[a] -= margin;
    box.upper[a] += margin;
  }
  return box;
}

constexpr double kMargin = 1e-6;  // share of the spacing; more than snapping moves a point

}  // namespace

void Overlay::update(const std::vector<CutGridCell>& cells) {
  dirty_points_.clear();
  dirty_faces_.clear();
  dirty_triangles_.clear();
  moved_vertices.clear();
  std::vector<std::int64_t> changed;
  for (const CutGridCell& cell : cells) {
    const std::int64_t number = source_.grid().number(cell.index);
    CellState& state = cells_[number];
    if (state.cell == cell) continue;
    remove_faces(state);
    state.cell = cell;
    changed.push_back(number);
  }
  for (const std::int64_t number : changed) add_faces(cells_[number], number);
  for (const std::int64_t number : changed) {
    for (const std::int32_t f : cells_[number].faces) make_segments(f);
    for (const std::int32_t f : cells_[number].faces) make_cap(f);
  }
  collect_dirty();
  for (const std::int64_t number : changed) locate_vertices(cells_[number]);
}

std::int32_t Overlay::find_point(const InterfacePoint& p) {
  const auto [found, is_new] = point_of_.try_emplace(p.id, static_cast<std::int32_t>(points_.size()));
  if (is_new) points_.emplace_back();
  Point& point = points_[found->second];
  if (is_new || point.x != p.x) {
    point.x = p.x;
    point.exact = source_.frame().snap(p.x, p.id);
    point.has_winding = false;
  }
  return found->second;
}

std::int32_t Overlay::find_edge(std::int32_t p, std::int32_t q) {
  if (p > q) std::swap(p, q);
  const std::uint64_t key = static_cast<std::uint64_t>(p) << 32 | static_cast<std::uint32_t>(q);
  const auto [found, is_new] = edge_of_.try_emplace(key, static_cast<std::int32_t>(edges_.size()));
  if (is_new) {
    edges_.emplace_back();
    edges_.back().p = p;
    edges_.back().q = q;
  }
  return found->second;
}

std::int32_t Overlay::find_face(const std::array<std::int32_t, 3>& p) {
  const VertexKey key{static_cast<std::int64_t>(p[0]) << 32 | p[1], p[2]};
  const auto [found, is_new] = face_of_.try_emplace(key, static_cast<std::int32_t>(faces_.size()));
  if (is_new) faces_.emplace_back();
  return found->second;
}

void Overlay::mark(std::int32_t point) {
  if (std::exchange(points_[point].dirty, true)) return;
  dirty_points_.push_back(point);
}

void Overlay::remove_faces(CellState& state) {
  for (const std::int32_t f : state.faces) {
    Face& face = faces_[f];
    for (int i = 0; i < 3; ++i) {
      mark(face.p[i]);
      erase_value(points_[face.p[i]].faces, f);
      Edge& edge = edges_[face.edge[i]];
      erase_value(edge.faces, f);
      edge.sorted = false;
      if (edge.faces.empty()) edge.hits.clear();
    }
    for (const auto& [source_edge, sign] : face.crossed) {
      auto& cuts = edge_cuts_[source_edge];
      std::erase_if(cuts, [f](const EdgeCut& cut) { return cut.face == f; });
    }
    for (const Segment& s : face.segments) {
      dirty_triangles_.push_back(s.triangle);
      const auto found = triangle_faces_.find(s.triangle);
      erase_value(found->second, f);
      if (found->second.empty()) triangle_faces_.erase(found);
    }
    face = {};
    dirty_faces_.push_back(f);
  }
  state.faces.clear();
}

void Overlay::add_faces(CellState& state, std::int64_t number) {
  state.shape = interface_of(source_.grid(), state.cell);
  std::vector<std::int32_t> points;
  for (const InterfacePoint& p : state.shape.points) points.push_back(find_point(p));
  for (const InterfaceFace& shape : state.shape.faces) {
    std::array<std::int32_t, 3> p{points[shape.point[0]], points[shape.point[1]], points[shape.point[2]]};
    std::rotate(p.begin(), std::min_element(p.begin(), p.end()), p.end());
    const std::int32_t f = find_face(p);
    std::array<std::int32_t, 3> e{};
    for (int i = 0; i < 3; ++i) e[i] = find_edge(p[i], p[(i + 1) % 3]);
    Face& face = faces_[f];
    face.p = p;
    face.edge = e;
    face.cell = number;
    face.carrier = {state.cell.carrier[shape.back], state.cell.carrier[shape.front]};
    face.air = state.cell.air;
    for (int i = 0; i < 3; ++i) {
      Edge& edge = edges_[e[i]];
      face.forward[i] = edge.p == p[i];
      if (edge.faces.empty()) find_hits(edge, state.cell.index);
      edge.faces.push_back(f);
      edge.sorted = false;
      points_[p[i]].faces.push_back(f);
      mark(p[i]);
    }
    state.faces.push_back(f);
  }
  cross_edges(state.faces, state.cell.index);
}

void Overlay::find_hits(Edge& edge, const GridIndex& cell) {
  const Point &p = points_[edge.p], &q = points_[edge.q];
  const vec::Box box = box_of(kMargin * source_.grid().spacing, p.x, q.x);
  const auto& x = source_.mesh().vertices;
  for (const std::int32_t triangle : source_.triangles_at(cell)) {
    const auto& t = source_.mesh().triangles[triangle];
    if (!box.overlaps(box_of(0, x[t[0]], x[t[1]], x[t[2]]))) continue;
    const int sign = source_.crossing(p.exact, q.exact, triangle);
    if (sign != 0) edge.hits.push_back({triangle, sign, on_plane(p.x, q.x, x[t[0]], x[t[1]], x[t[2]])});
  }
  sort_along(
      edge.hits, p, q, [this](const Hit& hit) { return corners_of(hit.triangle); }, [](const Hit& hit) { return hit.x; });
}

void Overlay::cross_edges(const std::vector<std::int32_t>& faces, const GridIndex& cell) {
  std::vector<std::int32_t> candidates;
  for (const std::int32_t t : source_.triangles_at(cell)) {
    for (const std::int32_t e : source_.edges_of(t)) candidates.push_back(e);
  }
  make_unique(candidates);
  const auto& x = source_.mesh().vertices;
  std::vector<vec::Box> boxes;
  for (const std::int32_t f : faces) {
    const Face& face = faces_[f];
    boxes.push_back(box_of(kMargin * source_.grid().spacing, points_[face.p[0]].x, points_[face.p[1]].x, points_[face.p[2]].x));
  }
  for (const std::int32_t e : candidates) {
    const SourceEdge& edge = source_.edges()[e];
    const vec::Box box = box_of(0, x[edge.from], x[edge.to]);
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (!box.overlaps(boxes[i])) continue;
      const auto c = corners(faces_[faces[i]]);
      const int sign = crosses(source_.exact(edge.from), source_.exact(edge.to), c[0], c[1], c[2]);
      if (sign == 0) continue;
      faces_[faces[i]].crossed.push_back({e, sign});
      edge_cuts_[e].push_back({faces[i], sign});
      dirty_edges_.insert(e);
    }
  }
}

void Overlay::make_segments(std::int32_t f) {
  Face& face = faces_[f];
  struct Entry {
    std::int32_t triangle;
    bool start;
    End end;
  };
  std::vector<Entry> entries;
  for (int i = 0; i < 3; ++i) {
    // On the way around the face the boundary is followed inside the body, and the segment outside of it.
    for (const Hit& hit : edges_[face.edge[i]].hits) {
      entries.push_back({hit.triangle, (hit.sign > 0) == face.forward[i], {false, face.edge[i]}});
    }
  }
  for (const auto& [source_edge, sign] : face.crossed) {
    const auto& triangles = source_.edges()[source_edge].face;
    entries.push_back({triangles[0], sign < 0, {true, source_edge}});
    entries.push_back({triangles[1], sign > 0, {true, source_edge}});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.triangle != b.triangle ? a.triangle < b.triangle : a.start > b.start;
  });
  for (std::size_t i = 0; i < entries.size(); i += 2) {
    const Entry& a = entries[i];
    if (i + 1 == entries.size() || entries[i + 1].triangle != a.triangle || !a.start || entries[i + 1].start) {
      throw Error(ErrorCode::internal, "a surface triangle and a cut face do not cross in one segment");
    }
    face.segments.push_back({a.triangle, a.end, entries[i + 1].end});
    triangle_faces_[a.triangle].push_back(f);
  }
}

int Overlay::winding(std::int32_t p, const GridIndex& cell) {
  Point& point = points_[p];
  if (!point.has_winding) {
    const ExactPoint corner = source_.exact_corner(cell);
    point.winding = source_.winding(cell);
    for (const std::int32_t t : source_.triangles_at(cell)) point.winding -= source_.crossing(corner, point.exact, t);
    point.has_winding = true;
  }
  return point.winding;
}

void Overlay::sort_around(Edge& edge) const {
  edge.sorted = true;
  if (edge.faces.size() < 3) return;
  const ExactPoint &p = points_[edge.p].exact, &q = points_[edge.q].exact;
  const auto third = [&](std::int32_t f) -> const ExactPoint& {
    for (const std::int32_t corner : faces_[f].p) {
      if (corner != edge.p && corner != edge.q) return points_[corner].exact;
    }
    return p;
  };
  const ExactPoint& first = third(*std::min_element(edge.faces.begin(), edge.faces.end()));
  const auto half = [&](const ExactPoint& r) { return r.id == first.id ? 0 : orient(p, q, first, r) > 0 ? 1 : 2; };
  std::sort(edge.faces.begin(), edge.faces.end(), [&](std::int32_t f, std::int32_t g) {
    if (f == g) return false;
    const ExactPoint &r = third(f), &s = third(g);
    const int a = half(r), b = half(s);
    return a != b ? a < b : orient(p, q, r, s) > 0;
  });
}

std::int32_t Overlay::across(const Edge& edge, std::int32_t side) const {
  const auto forward = [&](std::int32_t f) {
    const Face& face = faces_[f];
    for (int i = 0; i < 3; ++i) {
      if (face.p[i] == edge.p && face.p[(i + 1) % 3] == edge.q) return true;
    }
    return false;
  };
  const std::int32_t f = side / 2;
  const std::size_t count = edge.faces.size();
  const auto at = static_cast<std::size_t>(std::find(edge.faces.begin(), edge.faces.end(), f) - edge.faces.begin());
  const bool onward = (side % 2 == 1) == forward(f);  // the side faces counter-clockwise
  const std::int32_t other = edge.faces[(at + (onward ? 1 : count - 1)) % count];
  return 2 * other + (forward(other) != onward ? 1 : 0);
}

void Overlay::find_sectors(std::int32_t p) {
  Point& point = points_[p];
  std::vector<std::int32_t>& faces = sorted_faces_;
  faces = point.faces;
  std::sort(faces.begin(), faces.end());
  std::vector<std::int32_t>& root = side_root_;  // by place: twice the face's place in the list, and which side
  root.resize(2 * faces.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](std::int32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (const std::int32_t e : faces_[faces[i]].edge) {
      const Edge& edge = edges_[e];
      if (edge.p != p && edge.q != p) continue;
      for (std::int32_t half = 0; half < 2; ++half) {
        const std::int32_t other = across(edge, 2 * faces[i] + half);
        const auto at = std::lower_bound(faces.begin(), faces.end(), other / 2) - faces.begin();
        const std::int32_t a = find(static_cast<std::int32_t>(2 * i) + half),
                           b = find(static_cast<std::int32_t>(2 * at) + other % 2);
        root[std::max(a, b)] = std::min(a, b);
      }
    }
  }
  point.root.clear();
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(root.size()); ++i) {
    const std::int32_t lowest = find(i);
    point.root.push_back({2 * faces[i / 2] + i % 2, 2 * faces[lowest / 2] + lowest % 2});
  }
}

void Overlay::collect_dirty() {
  std::sort(dirty_points_.begin(), dirty_points_.end());
  for (const std::int32_t p : dirty_points_) {
    points_[p].dirty = false;
    for (const std::int32_t f : points_[p].faces) dirty_faces_.push_back(f);
  }
  make_unique(dirty_faces_);
  for (const std::int32_t f : dirty_faces_) {
    if (faces_[f].cell < 0) continue;
    for (const std::int32_t e : faces_[f].edge) {
      if (!edges_[e].sorted) sort_around(edges_[e]);
    }
    for (const Segment& s : faces_[f].segments) dirty_triangles_.push_back(s.triangle);
  }
  for (const std::int32_t p : dirty_points_) find_sectors(p);
  make_unique(dirty_triangles_);
  for (const std::int32_t e : dirty_edges_) sort_cuts(e);
  dirty_edges_.clear();
}

void Overlay::sort_cuts(std::int32_t e) {
  const SourceEdge& edge = source_.edges()[e];
  struct Ends {
    const ExactPoint& exact;
    const Vec3d& x;
  };
  const Ends u{source_.exact(edge.from), source_.mesh().vertices[edge.from]};
  const Ends w{source_.exact(edge.to), source_.mesh().vertices[edge.to]};
  sort_along(
      edge_cuts_[e], u, w, [this](const EdgeCut& cut) { return corners(faces_[cut.face]); },
      [this, e](const EdgeCut& cut) { return cut_position(e, cut.face); });
}

Vec3d Overlay::cut_position(std::int32_t source_edge, std::int32_t f) const {
  const SourceEdge& edge = source_.edges()[source_edge];
  const Face& face = faces_[f];
  return on_plane(source_.mesh().vertices[edge.from], source_.mesh().vertices[edge.to], points_[face.p[0]].x,
                  points_[face.p[1]].x, points_[face.p[2]].x);
}

void Overlay::locate_vertices(const CellState& state) {
  std::vector<std::int32_t> near;
  for (const std::int32_t t : source_.triangles_at(state.cell.index)) {
    for (const std::int32_t v : source_.mesh().triangles[t]) near.push_back(v);
  }
  make_unique(near);
  const CutGrid& grid = source_.grid();
  if (state.faces.empty()) {  // not divided: how its vertices are embedded is not decided here
    for (const std::int32_t v : near) {
      const auto found = vertex_cell_.find(v);
      if (found != vertex_cell_.end() && found->second == grid.number(state.cell.index)) vertex_cell_.erase(found);
    }
    return;
  }
  const vec::Box box =
      box_of(kMargin * grid.spacing, grid.position(state.cell.index), grid.position(corner_index(state.cell.index, 7)));
  for (const std::int32_t v : near) {
    const Vec3d& x = source_.mesh().vertices[v];
    if (box.distance2(x) > 0) continue;
    const int component = component_at(source_, state.cell, state.shape, source_.exact(v));
    if (component < 0) continue;
    vertex_cell_[v] = grid.number(state.cell.index);
    moved_vertices[v] = state.cell.carrier[component];
  }
}

}  // namespace pliant::overlay
