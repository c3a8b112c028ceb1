// Triangles that pass through each other.
#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/defects.h"
#include "geometry/parallel.h"
#include "geometry/triangle_tree.h"

namespace pliant {
namespace {

constexpr double kMargin = 1e-9;       // of the size of the triangles: what is closer touches
constexpr std::int64_t kRound = 8192;  // triangles between two looks at the work done
constexpr std::int64_t kChunk = 256;   // of them by one thread at a time
constexpr std::int64_t kQuery = 20;    // candidates that a query costs as much as

// Where the segment from p to q passes through the inside of the triangle.
std::optional<Vec3d> pierces(const Vec3d& p, const Vec3d& q, const std::array<Vec3d, 3>& t) {
  const Vec3d u = vec::sub(t[1], t[0]), v = vec::sub(t[2], t[0]), n = vec::cross(u, v), s = vec::sub(p, t[0]),
              d = vec::sub(q, p);
  const double from = vec::dot(n, s), to = vec::dot(n, vec::sub(q, t[0]));
  const double slack = kMargin * vec::norm(n) * std::max({vec::norm(u), vec::norm(v), vec::norm(d)});
  if (!((from > slack && to < -slack) || (from < -slack && to > slack))) return std::nullopt;
  const Vec3d x = vec::add(s, vec::mul(d, from / (from - to)));
  const double nn = vec::dot(n, n), b = vec::dot(n, vec::cross(x, v)) / nn, c = vec::dot(n, vec::cross(u, x)) / nn;
  if (!(b > kMargin && c > kMargin && b + c < 1 - kMargin)) return std::nullopt;
  return vec::add(t[0], x);
}

struct Found {
  std::int64_t looked = 0, work = 0, pairs = 0, between = 0;
  std::int32_t first = -1;
  Vec3d place{};
};

class Search {
 public:
  Search(const TriangleMesh& mesh, const std::vector<std::int32_t>& shell) : mesh_(mesh), shell_(shell), tree_(mesh) {}

  void look(std::int32_t t, std::vector<std::int32_t>& near, Found& found) const {
    const std::array<Vec3d, 3> own = corners(t);
    vec::Box box;
    for (const Vec3d& p : own) box.extend(p);
    tree_.overlapping(box, near);
    found.work += kQuery + static_cast<std::int64_t>(near.size());
    for (const std::int32_t other : near) {
      if (other <= t || neighbours(t, other)) continue;
      const std::optional<Vec3d> place = meet(own, corners(other));
      if (!place) continue;
      ++found.pairs;
      if (shell_[t] != shell_[other]) ++found.between;
      if (found.first >= 0 && t >= found.first) continue;
      found.first = t;
      found.place = *place;
    }
    ++found.looked;
  }

 private:
  [[nodiscard]] std::array<Vec3d, 3> corners(std::int32_t t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    return {mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]};
  }
  [[nodiscard]] bool neighbours(std::int32_t t, std::int32_t other) const {
    for (const std::int32_t v : mesh_.triangles[t]) {
      for (const std::int32_t w : mesh_.triangles[other]) {
        if (v == w) return true;
      }
    }
    return false;
  }
  static std::optional<Vec3d> meet(const std::array<Vec3d, 3>& x, const std::array<Vec3d, 3>& y) {
    for (std::size_t e = 0; e < 3; ++e) {
      if (const auto place = pierces(x[e], x[(e + 1) % 3], y)) return place;
      if (const auto place = pierces(y[e], y[(e + 1) % 3], x)) return place;
    }
    return std::nullopt;
  }

  const TriangleMesh& mesh_;
  const std::vector<std::int32_t>& shell_;
  TriangleTree tree_;
};

}  // namespace

Crossings crossings_of(const TriangleMesh& mesh, const std::vector<std::int32_t>& shell, std::int64_t budget) {
  const Search search(mesh, shell);
  const auto count = static_cast<std::int64_t>(mesh.triangles.size());
  const std::int64_t rounds = (count + kRound - 1) / kRound;
  Crossings out;
  std::int64_t work = 0, looked = 0;
  std::int32_t first = -1;
  for (std::int64_t round = 0; round < rounds && work <= budget; ++round) {  // each goes over the whole surface
    const std::int64_t own = (count - round + rounds - 1) / rounds;
    std::vector<Found> found(static_cast<std::size_t>((own + kChunk - 1) / kChunk));
    const std::int64_t most = (budget - work) / (4 * static_cast<std::int64_t>(found.size()));  // by one chunk
    parallel_for(static_cast<std::int64_t>(found.size()), [&](std::int64_t c) {
      std::vector<std::int32_t> near;
      for (std::int64_t i = c * kChunk; i < std::min(own, (c + 1) * kChunk); ++i) {
        if (found[c].work > most) return;  // everything is close to everything here
        search.look(static_cast<std::int32_t>(round + i * rounds), near, found[c]);
      }
    });
    for (const Found& f : found) {
      work += f.work;
      looked += f.looked;
      out.pairs += f.pairs;
      out.between_shells += f.between;
      if (f.first < 0 || (first >= 0 && f.first > first)) continue;
      first = f.first;
      out.place = f.place;
    }
  }
  out.searched = count > 0 ? static_cast<double>(looked) / static_cast<double>(count) : 1;
  return out;
}

}  // namespace pliant
