// Contact points on the faces of volume meshes.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "geometry/vec.h"
#include "model/contact/contact_samples.h"
#include "model/model.h"

namespace pliant {
namespace {

/// Minimum cosine between the normals of neighbours that count as facing the same way.
constexpr double kLevel = 0.7;

using Triangle = std::array<Vec3d, 3>;

Vec3d normal_of(const Triangle& x) { return vec::cross(vec::sub(x[1], x[0]), vec::sub(x[2], x[0])); }

double longest_of(const Triangle& x) {
  double longest = 0;
  for (std::size_t c = 0; c < 3; ++c) longest = std::max(longest, vec::norm(vec::sub(x[c], x[(c + 1) % 3])));
  return longest;
}

/// Converts weights to integer units with sum one.
std::array<std::int32_t, 8> whole(const std::array<double, 8>& weights) {
  std::array<std::int32_t, 8> out{};
  std::int32_t sum = 0;
  std::size_t largest = 0;
  for (std::size_t a = 0; a < 8; ++a) {
    out[a] = static_cast<std::int32_t>(std::lround(weights[a] * contact_weight_unit));
    sum += out[a];
    if (out[a] > out[largest]) largest = a;
  }
  out[largest] += contact_weight_unit - sum;
  return out;
}

/// `goes_on`: for the sides opposite the corners. Bounds of the part of a triangle in which the corner with the largest
/// weight at `at` has the largest weight.
PatchSides sides_of(const std::array<Vec3d, 3>& x, const Vec3d& at, const std::array<bool, 3>& goes_on) {
  const Vec3d normal = vec::cross(vec::sub(x[1], x[0]), vec::sub(x[2], x[0]));
  std::array<Vec3d, 3> slope;  // of the weights
  for (std::size_t c = 0; c < 3; ++c)
    slope[c] = vec::mul(vec::cross(normal, vec::sub(x[(c + 2) % 3], x[(c + 1) % 3])), 1 / vec::dot(normal, normal));
  PatchSides sides{};
  std::size_t count = 0;
  const auto add = [&](const Vec3d& down, double room, bool on) {  // where a weight of slope -down and value `room` is positive
    const double size = vec::norm(down);
    sides[count++] = {vec::mul(down, 1 / size), room / size, on};
  };
  const auto first = static_cast<std::size_t>(std::max_element(at.begin(), at.end()) - at.begin());
  for (std::size_t c = 0; c < 3; ++c) {
    add(vec::mul(slope[c], -1), at[c], goes_on[c]);
    if (c != first && at[c] < at[first]) add(vec::sub(slope[c], slope[first]), at[first] - at[c], true);
  }
  return sides;
}

/// Nodes and weights of a point on a triangle. Its corners are in one tetrahedron or on nodes, so few nodes have a weight.
struct SampleEmbedding {
  std::array<std::int32_t, 8> nodes{};
  std::array<double, 8> weights{};
};
SampleEmbedding embedding_of(const ModelSurface& s, std::int32_t t, const Vec3d& at) {
  std::map<std::int32_t, double> shares;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::int32_t v = s.triangles[t][c];
    for (std::size_t a = 0; a < 8; ++a) {
      if (s.weights[v][a] != 0) shares[s.nodes[v][a]] += at[c] * s.weights[v][a];
    }
  }
  std::vector<std::pair<double, std::int32_t>> largest;
  largest.reserve(shares.size());
  for (const auto& [node, share] : shares) largest.emplace_back(-share, node);
  std::sort(largest.begin(), largest.end());
  largest.resize(std::min<std::size_t>(largest.size(), 8));
  const double sum = std::accumulate(largest.begin(), largest.end(), 0.0, [](double q, const auto& l) { return q - l.first; });
  SampleEmbedding out;
  out.nodes.fill(largest.front().second);
  for (std::size_t a = 0; a < largest.size(); ++a) {
    out.nodes[a] = largest[a].second;
    out.weights[a] = -largest[a].first / sum;
  }
  return out;
}

/// The surface of a body.
class Faces {
 public:
  Faces(const Model& model, std::int32_t body, bool patches)
      : s_(model.surface), b_(model.bodies[body]), body_(body), patches_(patches) {
    for (std::int32_t t = b_.first_triangle; t < b_.first_triangle + b_.triangles; ++t) {
      mean_ += longest_of(corners(t));
      if (!patches_) continue;
      const Vec3d normal = normal_of(corners(t));
      const double size = vec::norm(normal);
      for (std::size_t c = 0; c < 3 && size > 0; ++c)
        normals_[{s_.triangles[t][c], s_.triangles[t][(c + 1) % 3]}] = vec::mul(normal, 1 / size);
    }
    if (b_.triangles > 0) mean_ /= b_.triangles;
  }

  double sample(ContactPoints& points) const {
    for (std::int32_t t = b_.first_triangle; t < b_.first_triangle + b_.triangles; ++t) sample(t, points);
    return mean_;
  }

 private:
  [[nodiscard]] Triangle corners(std::int32_t t) const {
    Triangle x{};
    for (std::size_t c = 0; c < 3; ++c) x[c] = s_.rest[s_.triangles[t][c]];
    return x;
  }

  /// Of the sides opposite to the corners.
  [[nodiscard]] std::array<bool, 3> goes_on(std::int32_t t, const Vec3d& normal) const {
    std::array<bool, 3> out{};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto found = normals_.find({s_.triangles[t][(c + 2) % 3], s_.triangles[t][(c + 1) % 3]});
      out[c] = found != normals_.end() && vec::dot(found->second, normal) > kLevel * vec::norm(normal);
    }
    return out;
  }

  void sample(std::int32_t t, ContactPoints& points) const {
    const Triangle x = corners(t);
    const Vec3d normal = normal_of(x);
    const double area = vec::norm(normal) / 2;
    if (!(area > 0)) return;
    const int count = longest_of(x) > mean_ / 2 ? 3 : 1;
    for (int k = 0; k < count; ++k) {
      Vec3d at{1.0 / 3, 1.0 / 3, 1.0 / 3};
      if (count == 3) {
        at = {1.0 / 6, 1.0 / 6, 1.0 / 6};
        at[static_cast<std::size_t>(k)] = 2.0 / 3;
      }
      const SampleEmbedding e = embedding_of(s_, t, at);
      add_contact_point(points, between(x, at), e.nodes, e.weights, area / count, body_, normal, std::sqrt(area / count));
      if (patches_) points.sides.push_back(sides_of(x, at, goes_on(t, normal)));
    }
  }

  const ModelSurface& s_;
  const ModelBody& b_;
  std::int32_t body_;
  bool patches_;
  double mean_ = 0;                                                 ///< mean over its triangles of the longest edge [m]
  std::map<std::pair<std::int32_t, std::int32_t>, Vec3d> normals_;  ///< normals of triangles, by their sides
};

}  // namespace

Vec3d between(const std::array<Vec3d, 3>& x, const Vec3d& weight) {
  Vec3d sum{};
  for (std::size_t c = 0; c < 3; ++c) sum = vec::add(sum, vec::mul(x[c], weight[c]));
  return sum;
}

void add_contact_point(ContactPoints& points, const Vec3d& x, const std::array<std::int32_t, 8>& nodes,
                       const std::array<double, 8>& weights, double area, std::int32_t body, const Vec3d& normal,
                       double apart) {
  points.rest.push_back(x);
  points.nodes.push_back(nodes);
  points.weights.push_back(whole(weights));
  points.area.push_back(area);
  points.body.push_back(body);
  points.normal.push_back(vec::mul(normal, 1 / vec::norm(normal)));
  points.apart.push_back(apart);
}

double sample_faces(const Model& model, std::int32_t body, bool patches, ContactPoints& points) {
  return Faces(model, body, patches).sample(points);
}

}  // namespace pliant
