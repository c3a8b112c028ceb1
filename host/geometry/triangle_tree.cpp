#include "geometry/triangle_tree.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <numeric>

#include "pliant/error.h"

namespace pliant {
namespace {

using vec::add;
using vec::cross;
using vec::dot;
using vec::mul;
using vec::sub;

constexpr int kLeaf = 4;
constexpr int kDepth = 128;  // the tree is balanced by count, so its depth stays below 2 log2(triangles)
// Clusters farther than this many radii are expanded. 2.3 keeps the error of the two-term expansion near 1e-3
// on fine meshes and below 2e-2 on coarse ones; a side needs 0.5.
constexpr double kReach = 2.3;

// BodyMesh angle of a triangle seen from the origin: tan(omega / 2) = a . (b x c) / (abc + (a.b) c + (b.c) a + (c.a) b).
double solid_angle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const double la = vec::norm(a), lb = vec::norm(b), lc = vec::norm(c);
  const double y = dot(a, cross(b, c));
  const double x = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return 2 * std::atan2(y, x);
}

bool segment_meets(const Vec3d& p, const Vec3d& d, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d e1 = sub(b, a), e2 = sub(c, a), h = cross(d, e2);
  const double det = dot(e1, h);
  if (det == 0) return false;
  const Vec3d s = sub(p, a);
  const double u = dot(s, h) / det;
  if (u < 0 || u > 1) return false;
  const Vec3d q = cross(s, e1);
  const double v = dot(d, q) / det;
  if (v < 0 || u + v > 1) return false;
  const double t = dot(e2, q) / det;
  return t > 0 && t < 1;
}

bool segment_meets(const Vec3d& p, const Vec3d& d, const vec::Box& box) {
  double near = 0, far = 1;
  for (int a = 0; a < 3; ++a) {
    if (d[a] == 0) {
      if (p[a] < box.lower[a] || p[a] > box.upper[a]) return false;
      continue;
    }
    double t0 = (box.lower[a] - p[a]) / d[a], t1 = (box.upper[a] - p[a]) / d[a];
    if (t0 > t1) std::swap(t0, t1);
    near = std::max(near, t0 - 1e-12);
    far = std::min(far, t1 + 1e-12);
    if (near > far) return false;
  }
  return true;
}

}  // namespace

Vec3d closest_on_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d ab = sub(b, a), ac = sub(c, a), ap = sub(p, a);
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3d bp = sub(p, b);
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return add(a, mul(ab, d1 / (d1 - d3)));
  const Vec3d cp = sub(p, c);
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return add(a, mul(ac, d2 / (d2 - d6)));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return add(b, mul(sub(c, b), (d4 - d3) / ((d4 - d3) + (d5 - d6))));
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return a;  // a triangle without area whose edges rounding left undecided
  return add(a, add(mul(ab, vb / sum), mul(ac, vc / sum)));
}

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  const auto count = static_cast<std::int32_t>(mesh.triangles.size());
  if (count == 0) throw Error(ErrorCode::bad_input, "the surface has no triangles; at least one is needed");
  triangles_.reserve(mesh.triangles.size());
  std::vector<Vec3d> centroids;
  for (const auto& t : mesh.triangles) {
    const Triangle tri{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    triangles_.push_back(tri);
    centroids.push_back(mul(add(add(tri.a, tri.b), tri.c), 1.0 / 3));
  }
  order_.resize(mesh.triangles.size());
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(mesh.triangles.size());
  build(centroids, 0, count);
  std::vector<Triangle> sorted;
  sorted.reserve(triangles_.size());
  for (const std::int32_t t : order_) sorted.push_back(triangles_[t]);
  triangles_.swap(sorted);
}

std::int32_t TriangleTree::build(std::vector<Vec3d>& centroids, std::int32_t first, std::int32_t count) {
  const auto id = static_cast<std::int32_t>(nodes_.size());
  nodes_.emplace_back();
  vec::Box box, centres;
  for (std::int32_t i = first; i < first + count; ++i) {
    const Triangle& t = triangles_[order_[i]];
    box.extend(t.a);
    box.extend(t.b);
    box.extend(t.c);
    centres.extend(centroids[order_[i]]);
  }
  nodes_[id].box = box;
  far_.push_back(far_field(first, count, box));
  if (count <= kLeaf) {
    nodes_[id].first = first;
    nodes_[id].count = count;
    return id;
  }
  const Vec3d extent = sub(centres.upper, centres.lower);
  const int axis = extent[0] >= extent[1] && extent[0] >= extent[2] ? 0 : extent[1] >= extent[2] ? 1 : 2;
  const std::int32_t half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](std::int32_t a, std::int32_t b) {
    return centroids[a][axis] != centroids[b][axis] ? centroids[a][axis] < centroids[b][axis] : a < b;
  });
  build(centroids, first, half);
  const std::int32_t right = build(centroids, first + half, count - half);
  nodes_[id].right = right;
  return id;
}

TriangleTree::Far TriangleTree::far_field(std::int32_t first, std::int32_t count, const vec::Box& box) const {
  Far far;
  double total = 0;
  for (std::int32_t i = first; i < first + count; ++i) {
    const Triangle& t = triangles_[order_[i]];
    const Vec3d n = mul(cross(sub(t.b, t.a), sub(t.c, t.a)), 0.5);
    const double weight = vec::norm(n);
    far.area = add(far.area, n);
    far.centre = add(far.centre, mul(add(add(t.a, t.b), t.c), weight / 3));
    total += weight;
  }
  far.centre = total > 0 ? mul(far.centre, 1 / total) : mul(add(box.lower, box.upper), 0.5);
  double radius2 = 0;
  for (std::int32_t i = first; i < first + count; ++i) {
    const Triangle& t = triangles_[order_[i]];
    const Vec3d n = mul(cross(sub(t.b, t.a), sub(t.c, t.a)), 0.5);
    const Vec3d offset = sub(mul(add(add(t.a, t.b), t.c), 1.0 / 3), far.centre);
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) far.moment[3 * r + c] += offset[r] * n[c];
    }
    for (const Vec3d* v : {&t.a, &t.b, &t.c}) {
      const Vec3d d = sub(*v, far.centre);
      radius2 = std::max(radius2, dot(d, d));
    }
  }
  far.reach2 = kReach * kReach * radius2;
  return far;
}

/// By so much, relatively, a box may seem to be further away than what is in it.
constexpr double kRounding = 1e-12;

ClosestPoint TriangleTree::closest(const Vec3d& p, double within) const {
  ClosestPoint best;
  best.distance = within;
  double best2 = within * within;
  std::array<std::pair<double, std::int32_t>, kDepth> stack;
  int top = 0;
  stack[top++] = {nodes_[0].box.distance2(p), 0};
  while (top > 0) {
    const auto [bound, id] = stack[--top];
    if (bound > best2 * (1 + kRounding)) continue;
    const Node& node = nodes_[id];
    if (node.count == 0) {
      std::pair<double, std::int32_t> left{nodes_[id + 1].box.distance2(p), id + 1};
      std::pair<double, std::int32_t> right{nodes_[node.right].box.distance2(p), node.right};
      if (left.first < right.first) std::swap(left, right);
      stack[top++] = left;
      stack[top++] = right;
      continue;
    }
    for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
      const Vec3d q = closest_on_triangle(p, triangles_[i].a, triangles_[i].b, triangles_[i].c);
      const Vec3d d = sub(q, p);
      const double d2 = dot(d, d), distance = std::sqrt(d2);  // ties are those of the distance, as with Embree
      if (distance < best.distance || (distance == best.distance && order_[i] < best.triangle)) {
        best2 = d2;
        best = {distance, order_[i], q};
      }
    }
  }
  return best;
}

template <class Open, class Visit>
bool TriangleTree::descend(Open&& open, Visit&& visit) const {
  std::array<std::int32_t, kDepth> stack;
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::int32_t id = stack[--top];
    if (!open(id)) continue;
    const Node& node = nodes_[id];
    if (node.count == 0) {
      stack[top++] = id + 1;
      stack[top++] = node.right;
      continue;
    }
    for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
      if (visit(i)) return true;
    }
  }
  return false;
}

double TriangleTree::winding(const Vec3d& p) const {
  double sum = 0;
  const auto add_far = [&](std::int32_t id) {
    const Far& far = far_[id];
    const Vec3d r = sub(far.centre, p);
    const double r2 = dot(r, r);
    if (!(r2 > far.reach2)) return true;
    // Sum over triangles of n . g(c), g(x) = x / |x|^3, expanded about the centre: N . g + M : grad g.
    const double inv3 = 1 / (r2 * std::sqrt(r2));
    const auto& m = far.moment;
    const double trace = m[0] + m[4] + m[8];
    const double quad = r[0] * (m[0] * r[0] + m[1] * r[1] + m[2] * r[2]) + r[1] * (m[3] * r[0] + m[4] * r[1] + m[5] * r[2]) +
                        r[2] * (m[6] * r[0] + m[7] * r[1] + m[8] * r[2]);
    sum += inv3 * (dot(far.area, r) + trace - 3 * quad / r2);
    return false;
  };
  descend(add_far, [&](std::int32_t i) {
    sum += solid_angle(sub(triangles_[i].a, p), sub(triangles_[i].b, p), sub(triangles_[i].c, p));
    return false;
  });
  return sum / (4 * std::numbers::pi);
}

void TriangleTree::overlapping(const vec::Box& box, std::vector<std::int32_t>& out) const {
  out.clear();
  descend([&](std::int32_t id) { return nodes_[id].box.overlaps(box); },
          [&](std::int32_t i) {
            vec::Box tri;
            tri.extend(triangles_[i].a);
            tri.extend(triangles_[i].b);
            tri.extend(triangles_[i].c);
            if (tri.overlaps(box)) out.push_back(order_[i]);
            return false;
          });
  std::sort(out.begin(), out.end());
}

bool TriangleTree::blocked(const Vec3d& p, const Vec3d& q) const {
  const Vec3d d = sub(q, p);
  return descend([&](std::int32_t id) { return segment_meets(p, d, nodes_[id].box); },
                 [&](std::int32_t i) { return segment_meets(p, d, triangles_[i].a, triangles_[i].b, triangles_[i].c); });
}

}  // namespace pliant
