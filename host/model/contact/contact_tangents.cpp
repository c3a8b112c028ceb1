// The surface around contact points: derivatives with respect to the nodes, patches, and where a cut parts nothing.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "geometry/vec.h"
#include "layout.h"
#include "model/contact/contact_samples.h"

namespace pliant {
namespace {

constexpr double kAlongSurface = 0.1;
/// Extent of a patch beyond its sides, in distances between points, over which its fraction of the force falls to zero.
constexpr double kBeyond = 0.8, kAtBorder = 0.06;
constexpr double kNoSide = 1e6;  // [m]

using Gradients = std::array<Vec3d, 8>;

/// Gradients of the trilinear shape functions of an axis-aligned cube at the point; empty if the nodes do not form one.
bool cube_gradients(const std::array<Vec3d, 8>& x, const std::array<std::int32_t, 8>& weights, Gradients& out) {
  const double d = x[1][0] - x[0][0];
  if (!(d > 0)) return false;
  Vec3d local{};
  for (std::size_t a = 0; a < 8; ++a) {
    for (std::size_t c = 0; c < 3; ++c) {
      const bool high = (a >> c & 1) != 0;
      if (std::abs(x[a][c] - x[0][c] - (high ? d : 0)) > 1e-6 * d) return false;
      if (high) local[c] += static_cast<double>(weights[a]) / contact_weight_unit;
    }
  }
  for (std::size_t a = 0; a < 8; ++a) {
    for (std::size_t c = 0; c < 3; ++c) {
      out[a][c] = 1 / d;
      for (std::size_t k = 0; k < 3; ++k) {
        const bool high = (a >> k & 1) != 0;
        out[a][c] *= k == c ? (high ? 1.0 : -1.0) : (high ? local[k] : 1 - local[k]);
      }
    }
  }
  return true;
}

/// Gradients of the least-squares linear field through the nodes' values, restricted to the directions that they span.
Gradients linear_gradients(const std::array<Vec3d, 8>& x, const std::array<std::int32_t, 8>& nodes) {
  const auto first_of = [&](std::size_t a) {
    return std::find(nodes.begin(), nodes.begin() + a, nodes[a]) == nodes.begin() + a;
  };
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  int count = 0;
  for (std::size_t a = 0; a < 8; ++a) {
    if (!first_of(a)) continue;
    middle += Eigen::Vector3d(x[a].data());
    ++count;
  }
  middle /= count;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (std::size_t a = 0; a < 8; ++a) {
    if (!first_of(a)) continue;
    const Eigen::Vector3d r = Eigen::Vector3d(x[a].data()) - middle;
    spread += r * r.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 3; ++k) {
    if (axes.eigenvalues()[k] > 1e-8 * axes.eigenvalues()[2])
      inverse += axes.eigenvectors().col(k) * axes.eigenvectors().col(k).transpose() / axes.eigenvalues()[k];
  }
  Gradients out{};
  for (std::size_t a = 0; a < 8; ++a) {
    if (!first_of(a)) continue;
    const Eigen::Vector3d g = inverse * (Eigen::Vector3d(x[a].data()) - middle);
    out[a] = {g[0], g[1], g[2]};
  }
  return out;
}

/// Components of gradients in integer units with sum zero, so that the moment of a point exerts no net force.
std::array<std::int32_t, 8> whole(const Gradients& gradient, const Vec3d& along, double unit) {
  std::array<std::int32_t, 8> out{};
  std::int32_t sum = 0;
  std::size_t largest = 0;
  for (std::size_t a = 0; a < 8; ++a) {
    out[a] = static_cast<std::int32_t>(std::lround(vec::dot(gradient[a], along) / unit));
    sum += out[a];
    if (std::abs(out[a]) > std::abs(out[largest])) largest = a;
  }
  out[largest] -= sum;
  return out;
}

/// Largest distances between points on the two sides of a cut at rest, across it and along it, as fractions of a cell.
constexpr double kAcrossCut = 0.05, kAlongCut = 0.5;
/// Greatest cosine between the normals of two points on the two sides of a cut.
constexpr double kOpposite = -0.8;
/// Two points of which more than this hangs on the same nodes do not part.
constexpr double kCommon = 0.5;

/// What two points have in common: the sum over their nodes of the lesser weight.
double common_weight(const ContactPoints& points, std::size_t i, std::size_t k) {
  std::int32_t sum = 0;
  for (std::size_t a = 0; a < 8; ++a) {
    for (std::size_t b = 0; b < 8; ++b) {
      if (points.nodes[i][a] == points.nodes[k][b]) sum += std::min(points.weights[i][a], points.weights[k][b]);
    }
  }
  return static_cast<double>(sum) / contact_weight_unit;
}

}  // namespace

ContactTangents contact_tangents(const ContactPoints& points, std::size_t point, const std::vector<Vec3d>& rest) {
  const auto& nodes = points.nodes[point];
  std::array<Vec3d, 8> x{};
  for (std::size_t a = 0; a < 8; ++a) x[a] = rest[static_cast<std::size_t>(nodes[a])];
  Gradients gradient{};
  if (!cube_gradients(x, points.weights[point], gradient)) gradient = linear_gradients(x, nodes);
  const Vec3d& n = points.normal[point];
  ContactTangents t;
  const std::size_t away =
      std::abs(n[0]) < std::abs(n[1]) ? (std::abs(n[0]) < std::abs(n[2]) ? 0 : 2) : (std::abs(n[1]) < std::abs(n[2]) ? 1 : 2);
  Vec3d axis{};
  axis[away] = 1;
  t.t1 = vec::cross(axis, n);
  t.t1 = vec::mul(t.t1, 1 / vec::norm(t.t1));
  t.t2 = vec::cross(n, t.t1);
  const double spacing = points.apart[point], unit = 1 / (contact_weight_unit * spacing);
  for (std::size_t k = 0; k < 2; ++k) {
    t.units[k] = whole(gradient, k == 0 ? t.t1 : t.t2, unit);
    for (std::size_t a = 0; a < 8; ++a) (k == 0 ? t.first : t.second)[a] = t.units[k][a] * unit;
  }
  return t;
}

std::vector<double> contact_patch(const ContactPoints& points, std::size_t point, const std::vector<Vec3d>& rest, bool joined) {
  const ContactTangents t = contact_tangents(points, point, rest);
  std::vector<double> out;
  for (const PatchSide& side : points.sides[point]) {
    const double p = vec::dot(side.normal, t.t1), q = vec::dot(side.normal, t.t2), size = std::hypot(p, q);
    // A side parallel to the surface bounds nothing.
    const bool bounds = size > kAlongSurface;
    out.insert(out.end(), {bounds ? p / size : 0, bounds ? q / size : 0, bounds ? side.distance / size : kNoSide,
                           (side.goes_on ? kBeyond : kAtBorder) * points.apart[point]});
  }
  std::array<Vec3d, 8> x{};
  for (std::size_t a = 0; a < 8; ++a) x[a] = rest[static_cast<std::size_t>(points.nodes[point][a])];
  Gradients gradient{};
  if (!cube_gradients(x, points.weights[point], gradient)) {
    out.resize(PLIANT_PATCH, 0.0);
    if (joined) out.back() = -2;
    return out;
  }
  const double d = x[1][0] - x[0][0];
  for (std::size_t c = 0; c < 3; ++c) out.push_back((points.rest[point][c] - x[0][c]) / d);
  for (const Vec3d& along : {t.t1, t.t2}) out.insert(out.end(), {along[0] / d, along[1] / d, along[2] / d});
  out.push_back(joined ? 2 : 1);
  return out;
}

std::vector<char> joined_points(const ContactPoints& points) {
  std::map<std::int32_t, std::vector<std::size_t>> around;  // the points of which a node has the largest weight
  const auto first = [&](std::size_t i) {
    const auto& w = points.weights[i];
    return points.nodes[i][static_cast<std::size_t>(std::max_element(w.begin(), w.end()) - w.begin())];
  };
  for (std::size_t i = 0; i < points.size(); ++i) around[first(i)].push_back(i);
  const auto faces = [&](std::size_t i, std::size_t k) {
    const Vec3d way = vec::sub(points.rest[k], points.rest[i]);
    return vec::dot(points.normal[i], points.normal[k]) < kOpposite && vec::norm(way) < kAlongCut * points.spacing &&
           std::abs(vec::dot(way, points.normal[i])) < kAcrossCut * points.spacing;
  };
  std::vector<char> joined(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const std::int32_t node : points.nodes[i]) {
      const auto found = around.find(node);
      if (found == around.end() || joined[i] != 0) continue;
      joined[i] = static_cast<char>(std::any_of(found->second.begin(), found->second.end(), [&](std::size_t k) {
        return faces(i, k) && common_weight(points, i, k) > kCommon;
      }));
    }
  }
  return joined;
}

}  // namespace pliant
