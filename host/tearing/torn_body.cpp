#include "tearing/torn_body.h"

#include <algorithm>
#include <limits>
#include <map>

#include "cutting/topology/cut_cell.h"
#include "geometry/vec.h"

namespace pliant {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

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
  return m.toughness > 0 ? m.toughness * m.integrity : std::numeric_limits<double>::infinity();
}

std::vector<TornBody::Peak> TornBody::peaks(const std::vector<Vec3d>& x) const {
  struct Sum {
    Matrix3d stress = Matrix3d::Zero();
    double volume = 0, strength = std::numeric_limits<double>::infinity();
  };
  std::vector<Sum> at(x.size());
  for (std::size_t t = 0; t < torn_.tets.size(); ++t) {
    const auto rest = corners(torn_.nodes, torn_.tets[t]);
    const auto stress = tet_stress(rest, corners(x, torn_.tets[t]), material_[t]);
    if (!stress) continue;
    const double volume = tet_geometry(rest).volume;
    for (const std::int32_t n : torn_.tets[t]) {
      at[n].stress += volume * *stress;
      at[n].volume += volume;
      at[n].strength = std::min(at[n].strength, strength(static_cast<std::int32_t>(t)));
    }
  }
  std::vector<Peak> all;
  for (std::size_t n = 0; n < at.size(); ++n) {
    if (!(at[n].volume > 0) || !(at[n].strength < std::numeric_limits<double>::infinity())) continue;
    const Matrix3d mean = at[n].stress / at[n].volume;
    const double largest = cutting_stress(mean, {});
    if (!(largest >= at[n].strength)) continue;
    Eigen::SelfAdjointEigenSolver<Matrix3d> solver(mean);
    all.push_back({largest / at[n].strength, static_cast<std::int32_t>(n), solver.eigenvectors().col(2), largest});
  }
  std::stable_sort(all.begin(), all.end(), [](const Peak& a, const Peak& b) { return a.excess > b.excess; });
  return all;
}

std::vector<TetFace> TornBody::breaking_faces(const std::vector<Vec3d>& x) const {
  const std::vector<Peak> found = peaks(x);
  std::vector<TetFace> faces;
  if (found.empty()) return faces;
  std::vector<std::vector<std::int32_t>> around(x.size());
  for (std::size_t t = 0; t < torn_.tets.size(); ++t) {
    for (const std::int32_t n : torn_.tets[t]) around[n].push_back(static_cast<std::int32_t>(t));
  }
  std::vector<char> waits(x.size(), 0);
  for (const Peak& peak : found) {
    if (waits[peak.node] != 0) continue;
    const auto in_front = [&](std::int32_t t) {
      Vec3d middle{};
      for (const Vec3d& p : corners(x, torn_.tets[t])) middle = vec::add(middle, vec::mul(p, 0.25));
      const Vec3d d = vec::sub(middle, x[peak.node]);
      return peak.normal.dot(Vector3d(d[0], d[1], d[2])) > 0;
    };
    const std::size_t before = faces.size();
    for (const std::int32_t t : around[peak.node]) {
      if (!in_front(t)) continue;
      for (std::size_t f = 0; f < 4; ++f) {
        const std::int32_t other = neighbors_[t][f].tet;
        if (torn_.tets[t][f] == peak.node || other < 0 || (broken_[t] >> f & 1) || in_front(other)) continue;
        if (peak.stress >= std::min(strength(t), strength(other))) faces.push_back({t, static_cast<std::int8_t>(f)});
      }
    }
    if (faces.size() == before) continue;
    for (const std::int32_t t : around[peak.node]) {
      for (const std::int32_t n : torn_.tets[t]) waits[n] = 1;
    }
  }
  return faces;
}

std::vector<std::int32_t> TornBody::tear(const std::vector<TetFace>& faces) {
  const auto before = std::move(torn_.tets);
  for (const TetFace& face : faces) broken_[face.tet] |= static_cast<std::uint8_t>(1 << face.face);
  torn_.tets = whole_->tets;
  const std::vector<std::int32_t> origin = part_at_faces(torn_.tets, whole_->nodes.size(), broken_);
  torn_.nodes.clear();
  for (const std::int32_t n : origin) torn_.nodes.push_back(whole_->nodes[n]);
  // Parts only ever become smaller, so the corners of a part had one node before.
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
