#include "cutting/blade/blade.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "cutting/blade/rest_edges.h"
#include "geometry/predicates.h"
#include "geometry/spatial_hash.h"
#include "pliant/error.h"

namespace pliant {
namespace {

/// Cells of the body and the triangles in reach of each other.
class CrossingSearch {
 public:
  CrossingSearch(const CutTopology& body, std::span<const Vec3d> x, std::span<const SweepTriangle> triangles)
      : body_(body), x_(x), triangles_(triangles) {}

  CutEdges run() {
    for (const SweepTriangle& t : triangles_) {
      for (const Vec3d& p : t) reach_.extend(p);
    }
    find_cells();
    if (near_.empty()) return {};
    frame_ = ExactFrame(frame_box());
    SpatialHash hash(mean_edge_ > 0 ? mean_edge_ : 1);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      vec::Box box;
      for (std::size_t k = 0; k < 3; ++k) {
        box.extend(triangles_[t][k]);
      }
      box = grown(box);
      corner_.resize(corner_.size() + 3);
      if (!box.overlaps(all_)) continue;
      for (std::size_t k = 0; k < 3; ++k)
        corner_[3 * t + k] = frame_.snap(triangles_[t][k], blade_point_number(triangles_[t][k]));
      hash.insert(box, static_cast<std::int32_t>(t));
    }
    for (const auto& [cell, box] : near_) {
      hits_.clear();
      hash.query(box, [&](std::int32_t t) { hits_.push_back(t); });
      std::sort(hits_.begin(), hits_.end());
      for (const std::int32_t t : hits_) test(cell, t);
    }
    for (const auto& [pair, hit] : found_) result_.emplace(pair, hit.at);
    return std::move(result_);
  }

 private:
  struct Hit {
    std::int32_t triangle;
    double at;
  };

  /// Snapping moves points by less than this.
  [[nodiscard]] static vec::Box grown(vec::Box box) {
    for (int a = 0; a < 3; ++a) {
      const double slack = 1e-9 * std::max({std::abs(box.lower[a]), std::abs(box.upper[a]), 1e-30});
      box.lower[a] -= slack;
      box.upper[a] += slack;
    }
    return box;
  }

  void find_cells() {
    const CutMesh& mesh = body_.mesh();
    const vec::Box reach = grown(reach_);
    double sum = 0;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      vec::Box box;
      bool finite = true;
      for (int a = 0; a < mesh.shape->corners; ++a) {
        const Vec3d& p = x_[mesh.cells[c][a]];
        finite = finite && vec::finite(p);
        box.extend(p);
      }
      if (!finite || !box.overlaps(reach)) continue;
      near_.emplace_back(static_cast<std::int32_t>(c), box);
      sum += box.upper[0] - box.lower[0] + box.upper[1] - box.lower[1] + box.upper[2] - box.lower[2];
      all_.extend(box);
    }
    if (!near_.empty()) mean_edge_ = sum / (3 * static_cast<double>(near_.size()));
  }

  /// A cube around the origin whose half width is a power of two: the grid hardly ever changes while a body moves.
  [[nodiscard]] vec::Box frame_box() const {
    double largest = 0;
    for (const vec::Box* box : {&all_, &reach_}) {
      for (int a = 0; a < 3; ++a) largest = std::max({largest, std::abs(box->lower[a]), std::abs(box->upper[a])});
    }
    const double half = largest > 0 ? std::ldexp(1.0, std::ilogb(largest) + 1) : 1;
    return {{-half, -half, -half}, {half, half, half}};
  }

  void test(std::int32_t cell, std::int32_t t) {
    const CutMesh& mesh = body_.mesh();
    const CellShape& shape = *mesh.shape;
    const ExactPoint* tri = &corner_[3 * static_cast<std::size_t>(t)];
    std::array<ExactPoint, 8> p;
    std::array<int, 8> side{};
    for (int a = 0; a < shape.corners; ++a) {
      p[a] = frame_.snap(x_[mesh.cells[cell][a]], mesh.cells[cell][a]);
      side[a] = orient(tri[0], tri[1], tri[2], p[a]);
    }
    for (const auto& [i, j] : shape.edges) {
      if (side[i] == side[j]) continue;
      const NodePair pair = node_pair(mesh.cells[cell][i], mesh.cells[cell][j]);
      const auto known = found_.find(pair);
      if ((known != found_.end() && known->second.triangle <= t) || body_.edges().count(pair) != 0) continue;
      const bool swap = mesh.cells[cell][i] > mesh.cells[cell][j];
      if (crosses(p[swap ? j : i], p[swap ? i : j], tri[0], tri[1], tri[2]) == 0) continue;
      found_[pair] = {t, place(pair, triangles_[t])};
    }
  }

  [[nodiscard]] double place(const NodePair& pair, const SweepTriangle& t) const {
    const Vec3d normal = vec::cross(vec::sub(t[1], t[0]), vec::sub(t[2], t[0]));
    const double from = vec::dot(normal, vec::sub(x_[pair[0]], t[0])), to = vec::dot(normal, vec::sub(x_[pair[1]], t[0]));
    const double at = from / (from - to);
    return std::isfinite(at) ? std::clamp(at, kLeastCrossing, 1 - kLeastCrossing) : 0.5;
  }

  const CutTopology& body_;
  std::span<const Vec3d> x_;
  std::span<const SweepTriangle> triangles_;
  ExactFrame frame_;
  std::vector<ExactPoint> corner_;  // three per triangle
  std::vector<std::pair<std::int32_t, vec::Box>> near_;
  std::vector<std::int32_t> hits_;
  vec::Box reach_, all_;
  double mean_edge_ = 0;
  std::map<NodePair, Hit> found_;
  CutEdges result_;
};

}  // namespace

std::vector<SweepTriangle> sweep(const BladeSegment& from, const BladeSegment& to) {
  std::vector<SweepTriangle> triangles;
  for (const SweepTriangle& t : {SweepTriangle{from[0], from[1], to[1]}, SweepTriangle{from[0], to[1], to[0]}}) {
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
  return triangles;
}

CutEdges crossed_edges(const CutTopology& body, std::span<const Vec3d> x, std::span<const SweepTriangle> triangles) {
  if (x.size() < body.mesh().rest.size()) {
    throw Error(ErrorCode::internal, fmt::format("{} positions for a body of {} nodes", x.size(), body.mesh().rest.size()));
  }
  for (const SweepTriangle& t : triangles) {
    for (const Vec3d& p : t) {
      if (!vec::finite(p)) {
        throw Error(ErrorCode::bad_input,
                    fmt::format("a corner of a blade's sweep is [{}] m; allowed are finite numbers", fmt::join(p, ", ")));
      }
    }
  }
  if (triangles.empty()) return {};
  return CrossingSearch(body, x, triangles).run();
}

}  // namespace pliant
