#include "cutting/surface/cut_sectors.h"

#include <algorithm>
#include <numeric>

namespace pliant::overlay {

void Sectors::sort_edges_of(std::int32_t face) {
  for (const std::int32_t e : faces_.face(face).edge) {
    if (!faces_.edge(e).sorted) sort_around(faces_.edge(e));
  }
}

void Sectors::sort_around(FaceEdge& edge) const {
  edge.sorted = true;
  if (edge.faces.size() < 3) return;
  const ExactPoint &p = faces_.point(edge.p).exact, &q = faces_.point(edge.q).exact;
  const auto third = [&](std::int32_t f) -> const ExactPoint& {
    for (const std::int32_t corner : faces_.face(f).p) {
      if (corner != edge.p && corner != edge.q) return faces_.point(corner).exact;
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

std::int32_t Sectors::across(const FaceEdge& edge, std::int32_t side) const {
  const auto forward = [&](std::int32_t f) {
    const CutFace& face = faces_.face(f);
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

void Sectors::find_around(std::int32_t p) {
  FacePoint& point = faces_.point(p);
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
    for (const std::int32_t e : faces_.face(faces[i]).edge) {
      const FaceEdge& edge = faces_.edge(e);
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

std::int32_t Sectors::root_of(std::int32_t p, std::int32_t side) const {
  const auto& root = faces_.point(p).root;
  return (*std::lower_bound(root.begin(), root.end(), std::array{side, -1}))[1];
}

bool Sectors::merged_at(std::int32_t e, std::int32_t f) const {
  const FaceEdge& edge = faces_.edge(e);
  return std::min(2 * f, across(edge, 2 * f)) == std::min(2 * f + 1, across(edge, 2 * f + 1));
}

bool Sectors::pinched(const FaceEdge& edge) const {
  if (edge.faces.size() < 2) return false;
  std::vector<std::array<std::int32_t, 2>> ends;  // of each sector
  for (const std::int32_t f : edge.faces) {
    for (std::int32_t side = 2 * f; side <= 2 * f + 1; ++side) {
      if (side < across(edge, side)) ends.push_back({root_of(edge.p, side), root_of(edge.q, side)});
    }
  }
  std::sort(ends.begin(), ends.end());
  return std::adjacent_find(ends.begin(), ends.end()) != ends.end();
}

CutVertex Sectors::vertex_on_face(std::int32_t source_edge, std::int32_t side) const {
  return {{VertexKey::of(VertexKey::edge_face, source_edge), side}, {}, carrier_of(side)};
}

CutVertex Sectors::vertex_on_edge(std::int32_t triangle, std::int32_t e, std::int32_t side) const {
  const std::int32_t other = across(faces_.edge(e), side);
  const std::int32_t low = std::min(side, other), high = std::max(side, other);
  return {{VertexKey::of(VertexKey::triangle_edge, triangle), static_cast<std::int64_t>(e) << 32 | low},
          {},
          carrier_of(in_air(low) && !in_air(high) ? high : low)};
}

CutVertex Sectors::vertex_at(std::int32_t p, std::int32_t level, std::int32_t side) const {
  const auto& root = faces_.point(p).root;
  const std::int32_t lowest = root_of(p, side);
  std::int32_t best = lowest;
  for (const auto& [member, its_root] : root) {
    if (its_root == lowest && in_air(best) && !in_air(member)) best = member;
  }
  return {{VertexKey::of(VertexKey::point, p), static_cast<std::int64_t>(lowest) << 32 | (level + 128)}, {}, carrier_of(best)};
}

}  // namespace pliant::overlay
