#include "tearing/swept_faces.h"

#include <algorithm>
#include <map>
#include <set>

#include "geometry/vec.h"
#include "tearing/uncut_mesh.h"

namespace pliant {
namespace {

constexpr std::array<std::array<int, 2>, 6> kSpokes{{{0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}, {0, 6}}};

/// A middle and those across the faces of an element.
const CellShape& spokes_shape(std::size_t faces) {
  static const CellShape of_tet{5, {}, std::span(kSpokes).first(4), {}, {}}, of_hex{7, {}, kSpokes, {}, {}};
  return faces == 4 ? of_tet : of_hex;
}

std::vector<Vec3d> middles_of(const BodyElements& solid, std::span<const Vec3d> x) {
  std::vector<Vec3d> middles;
  middles.reserve(solid.size());
  for (std::size_t e = 0; e < solid.size(); ++e) {
    const std::span<const std::int32_t> corners = solid.corners(e);
    Vec3d sum{};
    for (const std::int32_t n : corners) sum = vec::add(sum, x[static_cast<std::size_t>(n)]);
    middles.push_back(vec::mul(sum, 1.0 / static_cast<double>(corners.size())));
  }
  return middles;
}

}  // namespace

SweptFaces::SweptFaces(const TornBody& body) : body_(body) {
  auto mesh = std::make_shared<CutMesh>();
  mesh->shape = &spokes_shape(body.faces());
  mesh->rest = middles_of(body.solid(), body.solid().nodes);
  for (std::size_t e = 0; e < body.solid().size(); ++e) {
    const auto own = static_cast<std::int32_t>(e);
    auto& cell = mesh->cells.emplace_back();
    cell.fill(own);  // where no neighbour is, a line without length, which nothing crosses
    for (std::size_t f = 0; f < body.faces(); ++f) cell[f + 1] = std::max(body.neighbor(own, f).tet, own);
    mesh->fill.push_back(1);
  }
  follow();
  edge_ = mean_edge(topology_->mesh());
  middles_ = std::make_unique<CutTopology>(std::move(mesh));
  lines_ = std::make_unique<RestEdges>(middles_->mesh(), edge_);
}

void SweptFaces::follow() { topology_ = std::make_unique<CutTopology>(uncut_mesh(body_.solid())); }

void SweptFaces::place_middles(std::span<const Vec3d> x) { now_ = middles_of(body_.solid(), x); }

void SweptFaces::measure_gaps(std::span<const Vec3d> x) {
  gap_.clear();
  const BodyMesh &now = body_.solid(), &whole = body_.whole();
  if (now.nodes.size() == whole.nodes.size()) return;
  gap_.resize(now.nodes.size());
  std::map<std::int32_t, std::set<std::int32_t>> parts;  // the nodes that were one
  for (std::size_t e = 0; e < now.size(); ++e) {
    const std::span<const std::int32_t> here = now.corners(e), was = whole.corners(e);
    for (std::size_t a = 0; a < here.size(); ++a) {
      if (here[a] != was[a]) parts[was[a]].insert({here[a], was[a]});
    }
  }
  for (const auto& part : parts) {
    for (const std::int32_t m : part.second) {
      for (const std::int32_t n : part.second) gap_[m] = std::max(gap_[m], vec::norm(vec::sub(x[m], x[n])));
    }
  }
}

BladeSweep SweptFaces::sweep(std::span<const Vec3d> x) {
  place_middles(x);
  measure_gaps(x);
  return {*topology_, x, SweptPairs{*lines_, middles_->mesh().rest, now_, body_.whole().nodes.size(), gap_}, edge_};
}

CutEdges SweptFaces::crossed(std::span<const Vec3d> x, std::span<const SweepTriangle> triangles) {
  if (triangles.empty()) return {};
  place_middles(x);
  return crossed_edges(*middles_, now_, triangles);
}

TetFace SweptFaces::face_between(const NodePair& pair) const {
  for (std::size_t f = 0; f < body_.faces(); ++f) {
    if (body_.neighbor(pair[0], f).tet == pair[1]) return {pair[0], static_cast<std::int8_t>(f)};
  }
  return {-1, 0};
}

void SweptFaces::keep_joined(CutEdges& pairs) const {
  std::erase_if(pairs, [&](const auto& entry) {
    const TetFace face = face_between(entry.first);
    if (face.tet < 0) return true;
    const auto element = static_cast<std::size_t>(face.tet);
    return ((body_.broken()[element] | body_.waiting()[element]) >> face.face & 1) != 0;
  });
}

std::vector<TetFace> SweptFaces::faces(const CutEdges& pairs) const {
  std::vector<TetFace> faces;
  for (const auto& entry : pairs) faces.push_back(face_between(entry.first));
  return faces;
}

}  // namespace pliant
