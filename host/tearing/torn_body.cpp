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
#include "tearing/plain_surface.h"

namespace pliant {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

Vector3d column(const Vec3d& v) { return {v[0], v[1], v[2]}; }

std::array<Vec3d, 4> corners(const std::vector<Vec3d>& x, const std::array<std::int32_t, 4>& tet) {
  return {x[tet[0]], x[tet[1]], x[tet[2]], x[tet[3]]};
}

}  // namespace

TornBody::TornBody(std::shared_ptr<const BodyMesh> whole, std::vector<Material> material)
    : whole_(std::move(whole)),
      material_(std::move(material)),
      tets_(whole_->tets, whole_->nodes.size()),
      hexes_(whole_->hexes, whole_->nodes.size()),
      broken_(whole_->size(), 0),
      waiting_(whole_->size(), 0),
      torn_(*whole_) {
  std::map<std::array<std::int32_t, 3>, std::int32_t> outside;  // elements, by any three corners of an outer face
  for (std::size_t i = 0; i < faces() * whole_->size(); ++i) {
    const std::size_t e = i / faces();
    if (neighbor(static_cast<std::int32_t>(e), i % faces()).tet >= 0) continue;
    const std::span<const std::int32_t> corner = whole_->corners(e);
    const std::span<const int> face = face_corners(i % faces());
    for (std::size_t without = 0; without < (face.size() == 3 ? 1 : face.size()); ++without) {
      std::array<std::int32_t, 3> key{};
      for (std::size_t k = 0; k < 3; ++k) key[k] = corner[static_cast<std::size_t>(face[(without + k) % face.size()])];
      outside[face_key(key)] = static_cast<std::int32_t>(e);
    }
  }
  for (const auto& triangle : whole_->triangles) {
    std::array<std::int32_t, 3> node{};
    for (std::size_t k = 0; k < 3; ++k) node[k] = whole_->surface_nodes[triangle[k]][0];
    Corners at{outside.at(face_key(node)), {}};
    const std::span<const std::int32_t> corner = whole_->corners(static_cast<std::size_t>(at.element));
    for (std::size_t k = 0; k < 3; ++k)
      at.corner[k] = static_cast<std::int8_t>(std::find(corner.begin(), corner.end(), node[k]) - corner.begin());
    outside_.push_back(at);
  }
}

std::span<const int> TornBody::face_corners(std::size_t face) const {
  if (whole_->tets.empty()) return ElementShape<8>::faces[face];
  return ElementShape<4>::faces[face];
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
      const std::int32_t other = neighbor(t, f).tet;
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

std::vector<std::int32_t> TornBody::piece_at(std::int32_t tet, const std::vector<std::uint8_t>& broken) const {
  std::vector<std::int32_t> piece{tet};
  for (std::size_t i = 0; i < piece.size() && piece.size() < kLeastPiece; ++i) {
    for (std::size_t f = 0; f < 4; ++f) {
      const TetFace other = neighbor(piece[i], f);
      if (other.tet < 0 || (broken[piece[i]] >> f & 1) || (broken[other.tet] >> other.face & 1)) continue;
      if (std::find(piece.begin(), piece.end(), other.tet) == piece.end()) piece.push_back(other.tet);
    }
  }
  return piece;
}

std::vector<TetFace> TornBody::without_crumbs(std::vector<TetFace> faces, std::vector<std::uint8_t>& broken) const {
  for (const TetFace& face : faces) mark(broken, face);
  for (std::size_t i = 0; i < faces.size();) {
    const std::size_t here = piece_at(faces[i].tet, broken).size();
    const std::size_t there = piece_at(neighbor(faces[i].tet, static_cast<std::size_t>(faces[i].face)).tet, broken).size();
    if (here >= kLeastPiece && there >= kLeastPiece) {
      ++i;
      continue;
    }
    mark(broken, faces[i], false);
    faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(i));
    i = 0;  // what stays together now is larger
  }
  return faces;
}

TornBody::Breaks TornBody::breaking_faces(const std::vector<Vec3d>& x, double stretch) const {
  Breaks breaks;
  if (whole_->tets.empty()) return breaks;
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
  std::vector<std::uint8_t> broken = broken_;  // with the faces taken so far
  const auto take = [&](const std::vector<TetFace>& faces, std::span<const std::int32_t> nodes) {
    breaks.faces.insert(breaks.faces.end(), faces.begin(), faces.end());
    for (const TetFace& face : faces) mark(broken, face);
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
    const std::vector<TetFace> faces = without_crumbs(faces_on({peak.node, -1, peak.normal, peak.stress}, x, around), broken);
    if (!faces.empty()) take(faces, {&peak.node, 1});
  }
  return breaks;
}

std::vector<std::int32_t> TornBody::tear(const std::vector<TetFace>& faces) {
  for (const TetFace& face : faces) broken_[face.tet] |= static_cast<std::uint8_t>(1 << face.face);
  return open(nullptr);
}

std::vector<std::int32_t> TornBody::part(const std::vector<TetFace>& faces) {
  std::vector<TetFace> wait;
  for (const TetFace& face : faces) waiting_[face.tet] |= static_cast<std::uint8_t>(1 << face.face);
  for (std::size_t e = 0; e < waiting_.size(); ++e) {
    for (std::size_t f = 0; f < this->faces(); ++f) {
      const TetFace face{static_cast<std::int32_t>(e), static_cast<std::int8_t>(f)};
      if ((waiting_[e] >> f & 1) == 0 || (broken_[e] >> f & 1) != 0) continue;
      mark(broken_, face);
      wait.push_back(face);
    }
  }
  std::vector<std::int32_t> from = open(&wait);
  set_waiting(wait);
  return from;
}

void TornBody::set_waiting(const std::vector<TetFace>& faces) {
  std::fill(waiting_.begin(), waiting_.end(), std::uint8_t{0});
  for (const TetFace& face : faces) mark(waiting_, face);
}

void TornBody::mark(std::vector<std::uint8_t>& bits, const TetFace& face, bool on) const {
  for (const TetFace& side : {face, neighbor(face.tet, static_cast<std::size_t>(face.face))}) {
    if (side.tet < 0) continue;
    const auto bit = static_cast<std::uint8_t>(1 << side.face);
    bits[side.tet] = static_cast<std::uint8_t>(on ? bits[side.tet] | bit : bits[side.tet] & ~bit);
  }
}

/// Gives the elements the nodes that the broken faces leave them.
std::vector<std::int32_t> TornBody::open(std::vector<TetFace>* wait) {
  BodyElements before;
  before.tets = std::move(torn_.tets);
  before.hexes = std::move(torn_.hexes);
  torn_.tets = whole_->tets;
  torn_.hexes = whole_->hexes;
  const std::vector<std::int32_t> origin = torn_.tets.empty() ? part_at_faces(torn_.hexes, hexes_, broken_, {}, wait)
                                                              : part_at_faces(torn_.tets, tets_, broken_, {}, wait);
  torn_.nodes.clear();
  for (const std::int32_t n : origin) torn_.nodes.push_back(whole_->nodes[n]);
  torn_.whole_nodes = whole_->nodes.size();
  // A tear splits nodes and never joins them: all corners that share a node now shared one before, and any of them gives its
  // origin.
  std::vector<std::int32_t> from(origin.size(), -1);
  for (std::size_t e = 0; e < torn_.size(); ++e) {
    const std::span<const std::int32_t> now = torn_.corners(e), then = before.corners(e);
    for (std::size_t a = 0; a < now.size(); ++a) from[now[a]] = then[a];
  }
  for (std::size_t n = 0; n < from.size(); ++n) from[n] = from[n] < 0 ? origin[n] : from[n];
  make_surface();
  return from;
}

/// The triangles of one side of a broken face. Both sides of a quadrilateral may share its four nodes; so that no edge has more
/// than two triangles, they are divided along different diagonals.
std::vector<TornBody::Corners> TornBody::triangles_of(const TetFace& face) const {
  const std::span<const int> c = face_corners(static_cast<std::size_t>(face.face));
  const auto triangle = [&](std::size_t i, std::size_t j, std::size_t k) {
    return Corners{face.tet,
                   {static_cast<std::int8_t>(c[i % c.size()]), static_cast<std::int8_t>(c[j % c.size()]),
                    static_cast<std::int8_t>(c[k % c.size()])}};
  };
  if (c.size() == 3) return {triangle(0, 1, 2)};
  const std::span<const std::int32_t> node = whole_->corners(static_cast<std::size_t>(face.tet));
  std::size_t first = 0;  // the lowest node, the same on both sides
  for (std::size_t k = 1; k < 4; ++k)
    first = node[static_cast<std::size_t>(c[k])] < node[static_cast<std::size_t>(c[first])] ? k : first;
  if (neighbor(face.tet, static_cast<std::size_t>(face.face)).tet < face.tet) ++first;
  return {triangle(first, first + 1, first + 2), triangle(first, first + 2, first + 3)};
}

void TornBody::make_surface() {
  std::vector<OuterFace> outer;
  const auto add = [&](const Corners& at, std::int32_t source) {
    const std::span<const std::int32_t> nodes = torn_.corners(static_cast<std::size_t>(at.element));
    OuterFace face{{}, source};
    for (std::size_t k = 0; k < 3; ++k) face.nodes[k] = nodes[static_cast<std::size_t>(at.corner[k])];
    outer.push_back(face);
  };
  for (std::size_t t = 0; t < outside_.size(); ++t) add(outside_[t], static_cast<std::int32_t>(t));
  for (std::size_t e = 0; e < broken_.size(); ++e) {
    for (std::size_t f = 0; f < faces(); ++f) {
      if ((broken_[e] >> f & 1) == 0) continue;
      for (const Corners& at : triangles_of({static_cast<std::int32_t>(e), static_cast<std::int8_t>(f)})) add(at, -1);
    }
  }
  surface_of_faces(*whole_, outer, torn_);
}

}  // namespace pliant
