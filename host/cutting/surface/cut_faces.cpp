#include "cutting/surface/cut_faces.h"

#include <algorithm>
#include <utility>

namespace pliant::overlay {
namespace {

void erase_value(std::vector<std::int32_t>& from, std::int32_t value) {
  from.erase(std::remove(from.begin(), from.end(), value), from.end());
}

}  // namespace

std::int32_t CutFaces::find_point(const InterfacePoint& p) {
  const auto [found, is_new] = point_of_.try_emplace(p.id, static_cast<std::int32_t>(points_.size()));
  if (is_new) points_.emplace_back();
  FacePoint& point = points_[found->second];
  if (is_new || point.x != p.x) {
    point.x = p.x;
    point.exact = frame_.snap(p.x, p.id);
    point.has_winding = false;
  }
  return found->second;
}

std::int32_t CutFaces::find_edge(std::int32_t p, std::int32_t q) {
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

std::int32_t CutFaces::find_face(const std::array<std::int32_t, 3>& p) {
  const VertexKey key{static_cast<std::int64_t>(p[0]) << 32 | p[1], p[2]};
  const auto [found, is_new] = face_of_.try_emplace(key, static_cast<std::int32_t>(faces_.size()));
  if (is_new) faces_.emplace_back();
  return found->second;
}

std::int32_t CutFaces::add(const std::array<std::int32_t, 3>& corners, std::int64_t cell, const std::array<Carrier, 2>& carrier,
                           bool air) {
  std::array<std::int32_t, 3> p = corners;
  std::rotate(p.begin(), std::min_element(p.begin(), p.end()), p.end());
  const std::int32_t f = find_face(p);
  std::array<std::int32_t, 3> e{};
  for (int i = 0; i < 3; ++i) e[i] = find_edge(p[i], p[(i + 1) % 3]);
  CutFace& face = faces_[f];
  face.p = p;
  face.edge = e;
  face.cell = cell;
  face.carrier = carrier;
  face.air = air;
  for (int i = 0; i < 3; ++i) {
    FaceEdge& edge = edges_[e[i]];
    face.forward[i] = edge.p == p[i];
    edge.faces.push_back(f);
    edge.sorted = false;
    points_[p[i]].faces.push_back(f);
    mark(p[i]);
  }
  return f;
}

void CutFaces::remove(std::int32_t f) {
  CutFace& face = faces_[f];
  for (int i = 0; i < 3; ++i) {
    mark(face.p[i]);
    erase_value(points_[face.p[i]].faces, f);
    FaceEdge& edge = edges_[face.edge[i]];
    erase_value(edge.faces, f);
    edge.sorted = false;
    if (edge.faces.empty()) edge.hits.clear();
  }
  face = {};
}

void CutFaces::mark(std::int32_t point) {
  if (std::exchange(points_[point].dirty, true)) return;
  marked_.push_back(point);
}

std::vector<std::int32_t> CutFaces::take_marked() {
  std::vector<std::int32_t> marked = std::exchange(marked_, {});
  std::sort(marked.begin(), marked.end());
  for (const std::int32_t p : marked) points_[p].dirty = false;
  return marked;
}

}  // namespace pliant::overlay
