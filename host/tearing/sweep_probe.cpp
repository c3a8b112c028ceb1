#include "tearing/sweep_probe.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cutting/topology/cut_cell.h"
#include "pliant/error.h"

namespace pliant {
namespace {

vec::Box grown(vec::Box box, double by) {
  for (int a = 0; a < 3; ++a) {
    box.lower[a] -= by;
    box.upper[a] += by;
  }
  return box;
}

/// The point of a triangle that is nearest to x: inside, or on the nearest of its edges.
Vec3d nearest_on(const SweepTriangle& t, const Vec3d& x) {
  const Vec3d u = vec::sub(t[1], t[0]), v = vec::sub(t[2], t[0]), n = vec::cross(u, v), w = vec::sub(x, t[0]);
  const double area = vec::dot(n, n);
  if (area > 0) {
    const double b = vec::dot(vec::cross(w, v), n) / area, c = vec::dot(vec::cross(u, w), n) / area;
    if (b >= 0 && c >= 0 && b + c <= 1) return vec::add(t[0], vec::add(vec::mul(u, b), vec::mul(v, c)));
  }
  Vec3d best{};
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Vec3d edge = vec::sub(t[(k + 1) % 3], t[k]);
    const double s = std::clamp(vec::dot(vec::sub(x, t[k]), edge) / vec::dot(edge, edge), 0.0, 1.0);
    const Vec3d p = vec::add(t[k], vec::mul(edge, s)), d = vec::sub(x, p);
    if (vec::dot(d, d) < least) {
      least = vec::dot(d, d);
      best = p;
    }
  }
  return best;
}

}  // namespace

SweepProbe::SweepProbe(vec::Box box, double edge, std::span<const SweepTriangle> sweep)
    : hash_(edge > 0 ? edge : 1), sweep_(sweep.begin(), sweep.end()) {
  for (const SweepTriangle& t : sweep_) {
    for (const Vec3d& p : t) {
      if (!vec::finite(p)) {
        throw Error(ErrorCode::bad_input,
                    fmt::format("a corner of a blade's sweep is [{}] m; allowed are finite numbers", fmt::join(p, ", ")));
      }
      box.extend(p);
    }
  }
  frame_ = ExactFrame(box);
  std::map<Vec3d, std::int64_t> number;  // triangles that meet at a point agree about it
  for (std::size_t t = 0; t < sweep_.size(); ++t) {
    std::array<ExactPoint, 3> corner;
    vec::Box reach;
    for (int k = 0; k < 3; ++k) {
      const std::int64_t next = std::int64_t{1} << 61 | static_cast<std::int64_t>(number.size());
      corner[k] = frame_.snap(sweep_[t][k], number.emplace(sweep_[t][k], next).first->second);
      reach.extend(sweep_[t][k]);
    }
    corner_.push_back(corner);
    hash_.insert(grown(reach, 4 * frame_.step()), static_cast<std::int32_t>(t));
  }
}

std::vector<std::int32_t> SweepProbe::hits(const vec::Box& box) {
  std::vector<std::int32_t> found;
  hash_.query(box, [&](std::int32_t t) { found.push_back(t); });
  std::sort(found.begin(), found.end());
  return found;
}

bool SweepProbe::between(const ExactPoint& a, const Vec3d& xa, const ExactPoint& b, const Vec3d& xb, double* at) {
  vec::Box box;
  box.extend(xa);
  box.extend(xb);
  bool any = false;
  for (const std::int32_t t : hits(box)) {
    const auto& c = corner_[t];
    if (crosses(a, b, c[0], c[1], c[2]) == 0) continue;
    if (at == nullptr) return true;
    const SweepTriangle& s = sweep_[t];
    const Vec3d normal = vec::cross(vec::sub(s[1], s[0]), vec::sub(s[2], s[0]));
    const double from = vec::dot(normal, vec::sub(xa, s[0])), to = vec::dot(normal, vec::sub(xb, s[0]));
    const double here = from / (from - to);
    const double place = std::isfinite(here) ? here : 0.5;
    *at = any ? std::min(*at, place) : place;
    any = true;
  }
  return any;
}

bool SweepProbe::touches(const std::array<ExactPoint, 4>& tet, const std::array<Vec3d, 4>& x) {
  vec::Box box;
  for (const Vec3d& p : x) box.extend(p);
  for (const std::int32_t t : hits(box)) {
    const auto& c = corner_[t];
    for (const auto& [i, j] : kTetEdges) {
      if (crosses(tet[i], tet[j], c[0], c[1], c[2]) != 0) return true;
    }
    bool inside = true;
    for (const auto& f : kTetFaces) {
      for (int k = 0; k < 3; ++k) {
        if (crosses(c[k], c[(k + 1) % 3], tet[f[0]], tet[f[1]], tet[f[2]]) != 0) return true;
      }
      inside = inside && orient(tet[f[0]], tet[f[1]], tet[f[2]], c[0]) < 0;
    }
    if (inside) return true;
  }
  return false;
}

bool SweepProbe::nearest(const Vec3d& x, double reach, Vec3d& out) {
  vec::Box box;
  box.extend(x);
  double least = reach * reach;
  bool any = false;
  for (const std::int32_t t : hits(grown(box, reach))) {
    const Vec3d p = nearest_on(sweep_[t], x), d = vec::sub(x, p);
    if (vec::dot(d, d) > least) continue;
    least = vec::dot(d, d);
    out = p;
    any = true;
  }
  return any;
}

}  // namespace pliant
