#include "tearing/torn_body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "cutting/topology/cut_cell.h"
#include "cutting/topology/mesh_edges.h"
#include "elements/elements.h"
#include "geometry/vec.h"

namespace pliant {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

Vector3d column(const Vec3d& v) { return {v[0], v[1], v[2]}; }

std::array<Vec3d, 4> corners(const std::vector<Vec3d>& x, const std::array<std::int32_t, 4>& tet) {
  return {x[tet[0]], x[tet[1]], x[tet[2]], x[tet[3]]};
}

std::array<std::int32_t, 3> sorted_face(const std::array<std::int32_t, 4>& tet, std::size_t face) {
  std::array<std::int32_t, 3> key{tet[kTetFaces[face][0]], tet[kTetFaces[face][1]], tet[kTetFaces[face][2]]};
  std::sort(key.begin(), key.end());
  return key;
}

}  // namespace

TornBody::TornBody(std::shared_ptr<const BodyMesh> whole, std::vector<Material> material)
    : whole_(std::move(whole)),
      material_(std::move(material)),
      neighbors_(tet_neighbors(whole_->tets)),
      broken_(whole_->tets.size(), 0),
      torn_(*whole_) {
  std::map<std::array<std::int32_t, 3>, TetFace> outside;
  for (std::size_t t = 0; t < neighbors_.size(); ++t) {
    for (std::size_t f = 0; f < 4; ++f) {
      if (neighbors_[t][f].tet >= 0) continue;
      outside[sorted_face(whole_->tets[t], f)] = {static_cast<std::int32_t>(t), static_cast<std::int8_t>(f)};
    }
  }
  for (const auto& triangle : whole_->triangles) {
    std::array<std::int32_t, 3> key{};
    for (std::size_t k = 0; k < 3; ++k) key[k] = whole_->surface_nodes[triangle[k]][0];
    std::sort(key.begin(), key.end());
    outside_.push_back(outside.at(key));
  }
}

/// The largest principal stress that a tetrahedron bears [Pa].
double TornBody::strength(std::int32_t tet) const {
  const Material& m = material_[tet];
  return m.toughness > 0 ? m.toughness * m.integrity : kInfinite;
}

std::vector<TornBody::NodeStress> TornBody::node_stresses(const std::vector<Vec3d>& x) const {
  std::vector<NodeStress> at(x.size());
  for (NodeStress& node : at) node.strength = kInfinite;
  const ElementKind kind = usual_element(4);
  for (std::size_t t = 0; t < torn_.tets.size(); ++t) {
    const auto rest = corners(torn_.nodes, torn_.tets[t]);
    const auto stress = tet_stress(rest, corners(x, torn_.tets[t]), material_[t]);
    if (!stress) continue;
    const double volume = element_volume(kind, element_record(kind, rest, material_[t], ""));
    for (const std::int32_t n : torn_.tets[t]) {
      at[n].mean += volume * *stress;
      at[n].volume += volume;
      at[n].strength = std::min(at[n].strength, strength(static_cast<std::int32_t>(t)));
    }
  }
  for (NodeStress& node : at) {
    if (node.volume > 0) node.mean /= node.volume;
  }
  return at;
}

std::vector<TornBody::Peak> TornBody::peaks(const std::vector<NodeStress>& at) {
  std::vector<Peak> all;
  for (std::size_t n = 0; n < at.size(); ++n) {
    if (!(at[n].volume > 0) || !(at[n].strength < kInfinite)) continue;
    const double largest = cutting_stress(at[n].mean, {});
    if (!(largest >= at[n].strength)) continue;
    Eigen::SelfAdjointEigenSolver<Matrix3d> solver(at[n].mean);
    all.push_back({largest / at[n].strength, static_cast<std::int32_t>(n), solver.eigenvectors().col(2), largest});
  }
  std::stable_sort(all.begin(), all.end(), [](const Peak& a, const Peak& b) { return a.excess > b.excess; });
  return all;
}

std::vector<TornBody::LongEdge> TornBody::long_edges(const std::vector<Vec3d>& x, double stretch) const {
  std::vector<LongEdge> all;
  if (!(stretch > 0)) return all;
  std::vector<char> at_tear(x.size(), 0);
  for (std::size_t t = 0; t < broken_.size(); ++t) {
    for (std::size_t f = 0; f < 4; ++f) {
      if (!(broken_[t] >> f & 1)) continue;
      for (const int k : kTetFaces[f]) at_tear[torn_.tets[t][k]] = 1;
    }
  }
  for (const auto& tet : torn_.tets) {
    for (const auto& [i, j] : kTetEdges) {
      const std::int32_t a = std::min(tet[i], tet[j]), b = std::max(tet[i], tet[j]);
      const double limit = at_tear[a] != 0 || at_tear[b] != 0 ? stretch : kWholeStretch * stretch;
      const Vec3d now = vec::sub(x[a], x[b]), rest = vec::sub(torn_.nodes[a], torn_.nodes[b]);
      const double squared = vec::dot(now, now) / vec::dot(rest, rest);
      if (squared > limit * limit && squared < kInfinite) all.push_back({std::sqrt(squared), {a, b}});
    }
  }
  std::sort(all.begin(), all.end(),
            [](const LongEdge& a, const LongEdge& b) { return a.excess != b.excess ? a.excess > b.excess : a.ends < b.ends; });
  const auto same = [](const LongEdge& a, const LongEdge& b) { return a.ends == b.ends; };
  all.erase(std::unique(all.begin(), all.end(), same), all.end());
  return all;
}

std::vector<TetFace> TornBody::faces_on(const Plane& plane, const std::vector<Vec3d>& x, const Around& around) const {
  const auto in_front = [&](std::int32_t t) {
    Vec3d middle{};
    for (const Vec3d& p : corners(x, torn_.tets[t])) middle = vec::add(middle, vec::mul(p, 0.25));
    if (std::find(torn_.tets[t].begin(), torn_.tets[t].end(), plane.beyond) != torn_.tets[t].end()) return true;
    return plane.normal.dot(column(vec::sub(middle, x[plane.node]))) > 0;
  };
  std::vector<TetFace> faces;
  for (const std::int32_t t : around[plane.node]) {
    if (!in_front(t)) continue;
    for (std::size_t f = 0; f < 4; ++f) {
      const std::int32_t other = neighbors_[t][f].tet;
      if (torn_.tets[t][f] == plane.node || other < 0 || (broken_[t] >> f & 1) || in_front(other)) continue;
      if (plane.stress >= std::min(strength(t), strength(other))) faces.push_back({t, static_cast<std::int8_t>(f)});
    }
  }
  return faces;
}

std::vector<TetFace> TornBody::parting_faces(const LongEdge& edge, double stretch, const std::vector<Vec3d>& x,
                                             const std::vector<NodeStress>& at, const Around& around) const {
  std::array<std::vector<TetFace>, 2> faces;
  std::array<double, 2> stress{};
  for (std::size_t end = 0; end < 2; ++end) {
    const std::int32_t node = edge.ends[end], beyond = edge.ends[1 - end];
    const Vector3d along = column(vec::sub(x[beyond], x[node])).normalized();
    faces[end] = faces_on({node, beyond, along, kInfinite}, x, around);
    stress[end] = along.dot(at[node].mean * along);
  }
  if (faces[0].empty() != faces[1].empty()) {
    if (!(edge.excess > kFreedStretch * stretch)) return {};
    return faces[0].empty() ? faces[1] : faces[0];
  }
  return stress[1] > stress[0] ? faces[1] : faces[0];
}

TornBody::Breaks TornBody::breaking_faces(const std::vector<Vec3d>& x, double stretch) const {
  Breaks breaks;
  const std::vector<LongEdge> edges = long_edges(x, stretch);
  const bool weak = std::any_of(material_.begin(), material_.end(), [](const Material& m) { return m.toughness > 0; });
  if (edges.empty() && !weak) return breaks;
  const std::vector<NodeStress> stresses = node_stresses(x);
  const std::vector<Peak> found = peaks(stresses);
  if (found.empty() && edges.empty()) return breaks;
  Around around(x.size());
  for (std::size_t t = 0; t < torn_.tets.size(); ++t) {
    for (const std::int32_t n : torn_.tets[t]) around[n].push_back(static_cast<std::int32_t>(t));
  }
  std::vector<char> waits(x.size(), 0);
  const auto take = [&](const std::vector<TetFace>& faces, std::span<const std::int32_t> nodes) {
    breaks.faces.insert(breaks.faces.end(), faces.begin(), faces.end());
    for (const std::int32_t node : nodes) {
      for (const std::int32_t t : around[node]) {
        for (const std::int32_t n : torn_.tets[t]) waits[n] = 1;
      }
    }
  };
  for (const LongEdge& edge : edges) {
    if (waits[edge.ends[0]] != 0 || waits[edge.ends[1]] != 0) continue;
    const std::vector<TetFace> faces = parting_faces(edge, stretch, x, stresses, around);
    if (faces.empty()) continue;
    take(faces, edge.ends);
    ++breaks.edges;
  }
  for (const Peak& peak : found) {
    if (waits[peak.node] != 0) continue;
    const std::vector<TetFace> faces = faces_on({peak.node, -1, peak.normal, peak.stress}, x, around);
    if (!faces.empty()) take(faces, {&peak.node, 1});
  }
  return breaks;
}

std::vector<std::int32_t> TornBody::tear(const std::vector<TetFace>& faces) {
  const auto before = std::move(torn_.tets);
  for (const TetFace& face : faces) broken_[face.tet] |= static_cast<std::uint8_t>(1 << face.face);
  torn_.tets = whole_->tets;
  const std::vector<std::int32_t> origin = part_at_faces(torn_.tets, whole_->nodes.size(), broken_);
  torn_.nodes.clear();
  for (const std::int32_t n : origin) torn_.nodes.push_back(whole_->nodes[n]);
  // A tear splits nodes and never joins them: all corners that share a node now shared one before, and any of them gives its
  // origin.
  std::vector<std::int32_t> from(origin.size(), -1);
  for (std::size_t t = 0; t < before.size(); ++t) {
    for (std::size_t a = 0; a < 4; ++a) from[torn_.tets[t][a]] = before[t][a];
  }
  for (std::size_t n = 0; n < from.size(); ++n) from[n] = from[n] < 0 ? origin[n] : from[n];
  make_surface();
  return from;
}

void TornBody::make_surface() {
  torn_.surface = whole_->surface;
  torn_.surface_nodes = whole_->surface_nodes;
  torn_.surface_weights = whole_->surface_weights;
  torn_.triangles.clear();
  torn_.triangle_cut.clear();
  torn_.triangle_middle.clear();
  std::map<std::int32_t, std::int32_t> vertex;  // of a node
  for (std::size_t v = 0; v < whole_->surface.size(); ++v) vertex[whole_->surface_nodes[v][0]] = static_cast<std::int32_t>(v);
  const auto add = [&](const TetFace& face, bool cut) {
    std::array<std::int32_t, 3> triangle{};
    Vec3d middle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t n = torn_.tets[face.tet][kTetFaces[face.face][k]];
      const auto [at, added] = vertex.emplace(n, static_cast<std::int32_t>(torn_.surface.size()));
      if (added) {
        torn_.surface.push_back(torn_.nodes[n]);
        torn_.surface_nodes.push_back({n, n, n, n, n, n, n, n});
        torn_.surface_weights.push_back({1, 0, 0, 0, 0, 0, 0, 0});
      }
      triangle[k] = at->second;
      middle = vec::add(middle, vec::mul(torn_.nodes[n], 1.0 / 3));
    }
    const double none = std::numeric_limits<double>::quiet_NaN();
    torn_.triangles.push_back(triangle);
    torn_.triangle_cut.push_back(cut ? 1 : 0);
    torn_.triangle_middle.push_back(cut ? Vec3d{none, none, none} : middle);
  };
  for (const TetFace& face : outside_) add(face, false);
  for (std::size_t t = 0; t < broken_.size(); ++t) {
    for (std::size_t f = 0; f < 4; ++f) {
      if (broken_[t] >> f & 1) add({static_cast<std::int32_t>(t), static_cast<std::int8_t>(f)}, true);
    }
  }
}

}  // namespace pliant
