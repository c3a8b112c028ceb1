#include "tearing/swept_faces.h"

#include <algorithm>

#include "cutting/cut_body.h"
#include "geometry/vec.h"

namespace pliant {
namespace {

constexpr std::size_t kFaces = 4;
constexpr std::array<std::array<int, 2>, 4> kSpokes{{{0, 1}, {0, 2}, {0, 3}, {0, 4}}};

/// A middle and those across the faces of a tetrahedron.
const CellShape& spokes_shape() {
  static const CellShape shape{5, {}, kSpokes, {}, {}};
  return shape;
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
  mesh->shape = &spokes_shape();
  mesh->rest = middles_of(body.solid(), body.solid().nodes);
  for (std::size_t e = 0; e < body.solid().size(); ++e) {
    const auto own = static_cast<std::int32_t>(e);
    auto& cell = mesh->cells.emplace_back();
    cell.fill(own);  // where no neighbour is, a line without length, which nothing crosses
    for (std::size_t f = 0; f < 4; ++f) cell[f + 1] = std::max(body.neighbor(own, f).tet, own);
    mesh->fill.push_back(1);
  }
  follow();
  const CutMesh& elements = topology_->mesh();
  constexpr std::size_t kSample = 1000;
  double count = 0;
  for (std::size_t c = 0; c < std::min(elements.cells.size(), kSample); ++c) {
    for (const auto& [a, b] : elements.shape->edges) {
      edge_ += vec::norm(vec::sub(elements.rest[elements.cells[c][a]], elements.rest[elements.cells[c][b]]));
      ++count;
    }
  }
  edge_ /= std::max(count, 1.0);
  middles_ = std::make_unique<CutTopology>(std::move(mesh));
  lines_ = std::make_unique<RestEdges>(middles_->mesh(), edge_);
}

void SweptFaces::follow() { topology_ = std::make_unique<CutTopology>(cut_mesh(body_.solid(), "")); }

void SweptFaces::place_middles(std::span<const Vec3d> x) { now_ = middles_of(body_.solid(), x); }

/// The largest distance between what was one corner of a face.
void SweptFaces::measure_gaps(std::span<const Vec3d> x) {
  gap_.clear();
  const BodyMesh &now = body_.solid(), &whole = body_.whole();
  for (std::size_t e = 0; e < now.size(); ++e) {
    for (std::size_t f = 0; f < kFaces; ++f) {
      if ((body_.broken()[e] >> f & 1) == 0) continue;
      if (gap_.empty()) gap_.resize(kFaces * now.size());
      const TetFace other = body_.neighbor(static_cast<std::int32_t>(e), f);
      const std::span<const std::int32_t> was = whole.corners(static_cast<std::size_t>(other.tet));
      for (const int k : kTetFaces[f]) {
        const auto corner = static_cast<std::size_t>(k);
        const auto there = std::find(was.begin(), was.end(), whole.corners(e)[corner]) - was.begin();
        const std::int32_t here = now.corners(e)[corner];
        const std::int32_t beyond = now.corners(static_cast<std::size_t>(other.tet))[static_cast<std::size_t>(there)];
        double& gap = gap_[kFaces * e + f];
        gap = std::max(gap, vec::norm(vec::sub(x[static_cast<std::size_t>(here)], x[static_cast<std::size_t>(beyond)])));
      }
    }
  }
}

BladeSweep SweptFaces::sweep(std::span<const Vec3d> x) {
  place_middles(x);
  measure_gaps(x);
  return {*topology_, x, SweptPairs{*lines_, middles_->mesh().rest, now_, body_.whole().nodes.size(), gap_}, edge_};
}

InverseMap SweptFaces::inverse_map(std::span<const Vec3d> x, const vec::Box& region, double reach) {
  measure_gaps(x);
  return {*topology_, x, region, edge_, reach, gap_};
}

CutEdges SweptFaces::crossed(std::span<const Vec3d> x, std::span<const SweepTriangle> triangles) {
  if (triangles.empty()) return {};
  place_middles(x);
  return crossed_edges(*middles_, now_, triangles);
}

TetFace SweptFaces::face_between(const NodePair& pair) const {
  for (std::size_t f = 0; f < 4; ++f) {
    if (body_.neighbor(pair[0], f).tet == pair[1]) return {pair[0], static_cast<std::int8_t>(f)};
  }
  return {-1, 0};
}

void SweptFaces::keep_joined(CutEdges& pairs) const {
  std::erase_if(pairs, [&](const auto& entry) {
    const TetFace face = face_between(entry.first);
    return face.tet < 0 || (body_.broken()[static_cast<std::size_t>(face.tet)] >> face.face & 1) != 0;
  });
}

std::vector<TetFace> SweptFaces::faces(const CutEdges& pairs) const {
  std::vector<TetFace> faces;
  for (const auto& entry : pairs) faces.push_back(face_between(entry.first));
  return faces;
}

}  // namespace pliant
