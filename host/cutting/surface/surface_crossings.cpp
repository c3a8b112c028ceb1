#include "cutting/surface/surface_crossings.h"

#include <algorithm>

#include "cutting/surface/overlay_order.h"
#include "pliant/error.h"

namespace pliant::overlay {

void SurfaceCrossings::cross_face_edges(std::int32_t face, const GridIndex& cell) {
  for (const std::int32_t e : faces_.face(face).edge) {
    FaceEdge& edge = faces_.edge(e);
    if (edge.faces.size() == 1) find_hits(edge, cell);
  }
}

void SurfaceCrossings::find_hits(FaceEdge& edge, const GridIndex& cell) const {
  const FacePoint &p = faces_.point(edge.p), &q = faces_.point(edge.q);
  const vec::Box box = box_of(kSnapMargin * source_.grid().spacing, p.x, q.x);
  const auto& x = source_.mesh().vertices;
  for (const std::int32_t triangle : source_.triangles_at(cell)) {
    const auto& t = source_.mesh().triangles[triangle];
    if (!box.overlaps(box_of(0, x[t[0]], x[t[1]], x[t[2]]))) continue;
    const int sign = source_.crossing(p.exact, q.exact, triangle);
    if (sign != 0) edge.hits.push_back({triangle, sign, on_plane(p.x, q.x, x[t[0]], x[t[1]], x[t[2]])});
  }
  const auto corners_of = [this](const Hit& hit) {
    const auto& t = source_.mesh().triangles[hit.triangle];
    return std::array<ExactPoint, 3>{source_.exact(t[0]), source_.exact(t[1]), source_.exact(t[2])};
  };
  sort_along(edge.hits, p, q, corners_of, [](const Hit& hit) { return hit.x; });
}

void SurfaceCrossings::cross_source_edges(const std::vector<std::int32_t>& faces, const GridIndex& cell) {
  std::vector<std::int32_t> candidates;
  for (const std::int32_t t : source_.triangles_at(cell)) {
    for (const std::int32_t e : source_.edges_of(t)) candidates.push_back(e);
  }
  std::sort(candidates.begin(), candidates.end());
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  const auto& x = source_.mesh().vertices;
  std::vector<vec::Box> boxes;
  for (const std::int32_t f : faces) {
    const auto& p = faces_.face(f).p;
    boxes.push_back(
        box_of(kSnapMargin * source_.grid().spacing, faces_.point(p[0]).x, faces_.point(p[1]).x, faces_.point(p[2]).x));
  }
  for (const std::int32_t e : candidates) {
    const SourceEdge& edge = source_.edges()[e];
    const vec::Box box = box_of(0, x[edge.from], x[edge.to]);
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (!box.overlaps(boxes[i])) continue;
      const auto c = faces_.corners(faces[i]);
      const int sign = crosses(source_.exact(edge.from), source_.exact(edge.to), c[0], c[1], c[2]);
      if (sign == 0) continue;
      faces_.face(faces[i]).crossed.push_back({e, sign});
      edge_cuts_[e].push_back({faces[i], sign});
      changed_edges_.insert(e);
    }
  }
}

void SurfaceCrossings::make_segments(std::int32_t f) {
  CutFace& face = faces_.face(f);
  struct Entry {
    std::int32_t triangle;
    bool start;
    SegmentEnd end;
  };
  std::vector<Entry> entries;
  for (int i = 0; i < 3; ++i) {
    // On the way around the face the boundary is followed inside the body, and the segment outside of it.
    for (const Hit& hit : faces_.edge(face.edge[i]).hits) {
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

void SurfaceCrossings::remove(std::int32_t f) {
  const CutFace& face = faces_.face(f);
  for (const auto& [source_edge, sign] : face.crossed) {
    std::erase_if(edge_cuts_[source_edge], [f](const EdgeCut& cut) { return cut.face == f; });
  }
  for (const Segment& s : face.segments) {
    const auto found = triangle_faces_.find(s.triangle);
    std::erase(found->second, f);
    if (found->second.empty()) triangle_faces_.erase(found);
  }
}

void SurfaceCrossings::sort_changed() {
  for (const std::int32_t e : changed_edges_) sort_cuts(e);
  changed_edges_.clear();
}

void SurfaceCrossings::sort_cuts(std::int32_t e) {
  const SourceEdge& edge = source_.edges()[e];
  struct Ends {
    const ExactPoint& exact;
    const Vec3d& x;
  };
  const Ends u{source_.exact(edge.from), source_.mesh().vertices[edge.from]};
  const Ends w{source_.exact(edge.to), source_.mesh().vertices[edge.to]};
  sort_along(
      edge_cuts_[e], u, w, [this](const EdgeCut& cut) { return faces_.corners(cut.face); },
      [this, e](const EdgeCut& cut) { return cut_position(e, cut.face); });
}

const std::vector<std::int32_t>* SurfaceCrossings::faces_across(std::int32_t triangle) const {
  const auto found = triangle_faces_.find(triangle);
  return found == triangle_faces_.end() ? nullptr : &found->second;
}

const std::vector<EdgeCut>* SurfaceCrossings::cuts_of(std::int32_t source_edge) const {
  const auto found = edge_cuts_.find(source_edge);
  return found == edge_cuts_.end() ? nullptr : &found->second;
}

Vec3d SurfaceCrossings::cut_position(std::int32_t source_edge, std::int32_t f) const {
  const SourceEdge& edge = source_.edges()[source_edge];
  const auto& p = faces_.face(f).p;
  return on_plane(source_.mesh().vertices[edge.from], source_.mesh().vertices[edge.to], faces_.point(p[0]).x,
                  faces_.point(p[1]).x, faces_.point(p[2]).x);
}

}  // namespace pliant::overlay
