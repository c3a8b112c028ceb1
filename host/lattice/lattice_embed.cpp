// Which part of which cell a surface vertex is embedded in.
#include <algorithm>
#include <bit>
#include <cmath>

#include "geometry/parallel.h"
#include "lattice/lattice_parts.h"

namespace pliant {
namespace {

using Index = std::array<std::int32_t, 3>;

// The probe lies this share of the spacing below the surface, in the material that the vertex bounds.
constexpr double kDepth = 1e-3;
constexpr std::size_t kTries = 12;  // nearest samples that are tested for sight

struct Candidate {
  double distance2;
  std::int32_t part;
  Vec3d point;
};

class Embedder {
 public:
  Embedder(const SurfaceDistance& surface, const Grid& grid, const Parts& parts)
      : surface_(surface), grid_(grid), parts_(parts) {
    inward_.resize(surface.mesh().vertices.size());
    const auto& v = surface.mesh().vertices;
    for (const auto& t : surface.mesh().triangles) {
      const Vec3d n = vec::cross(vec::sub(v[t[1]], v[t[0]]), vec::sub(v[t[2]], v[t[0]]));
      for (const std::int32_t c : t) inward_[c] = vec::sub(inward_[c], n);
    }
  }

  [[nodiscard]] Embedding embed(std::int64_t vertex) const {
    const Vec3d& v = surface_.mesh().vertices[vertex];
    const double length = vec::norm(inward_[vertex]);
    const Vec3d probe = length > 0 ? vec::add(v, vec::mul(inward_[vertex], kDepth * grid_.spacing / length)) : v;
    Embedding out;
    out.cell = choose(probe);
    for (int a = 0; a < 3; ++a) {
      out.local[a] = (v[a] - grid_.origin[a]) / grid_.spacing - parts_.list[out.cell].index[a];
    }
    return out;
  }

 private:
  [[nodiscard]] std::int32_t choose(const Vec3d& probe) const {
    Index cell{};
    for (int a = 0; a < 3; ++a) {
      const double x = std::floor((probe[a] - grid_.origin[a]) / grid_.spacing);
      cell[a] = static_cast<std::int32_t>(std::clamp(x, 0.0, grid_.size[a] - 1.0));
    }
    const auto [first, last] = parts_.of(cell);
    if (last == first + 1 && parts_.list[first].mask == kAllSamples) return first;
    std::vector<Candidate> own, around;
    gather(cell, probe, own);
    if (const std::int32_t seen = visible(probe, own); seen >= 0) return seen;
    for (std::int32_t p = first; p < last; ++p) {
      if (parts_.list[p].thin)
        return own.front().part;  // its samples are not inside the material, so visibility is meaningless
    }
    for (int k = -1; k <= 1; ++k) {
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
          if (i != 0 || j != 0 || k != 0) gather({cell[0] + i, cell[1] + j, cell[2] + k}, probe, around);
        }
      }
    }
    if (const std::int32_t seen = visible(probe, around); seen >= 0) return seen;
    if (!own.empty()) return own.front().part;
    if (!around.empty()) return around.front().part;
    return nearest_part(probe);
  }

  void gather(const Index& cell, const Vec3d& probe, std::vector<Candidate>& out) const {
    const auto [first, last] = parts_.of(cell);
    const Vec3d low = vec::add(grid_.origin, vec::mul({1.0 * cell[0], 1.0 * cell[1], 1.0 * cell[2]}, grid_.spacing));
    for (std::int32_t p = first; p < last; ++p) {
      for (std::uint64_t rest = parts_.list[p].mask; rest != 0; rest &= rest - 1) {
        const Vec3d point = vec::add(low, vec::mul(sample_point(std::countr_zero(rest)), grid_.spacing));
        const Vec3d d = vec::sub(point, probe);
        out.push_back({vec::dot(d, d), p, point});
      }
    }
  }

  [[nodiscard]] std::int32_t visible(const Vec3d& probe, std::vector<Candidate>& candidates) const {
    const std::size_t tries = std::min(kTries, candidates.size());
    std::partial_sort(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(tries), candidates.end(),
                      [](const Candidate& x, const Candidate& y) {
                        return x.distance2 != y.distance2 ? x.distance2 < y.distance2 : x.part < y.part;
                      });
    for (std::size_t c = 0; c < tries; ++c) {
      if (!surface_.tree().blocked(probe, candidates[c].point)) return candidates[c].part;
    }
    return -1;
  }

  [[nodiscard]] std::int32_t nearest_part(const Vec3d& probe) const {
    double best2 = HUGE_VAL;
    std::int32_t best = 0;
    const double d = grid_.spacing;
    for (std::size_t p = 0; p < parts_.list.size(); ++p) {
      const Index& c = parts_.list[p].index;
      vec::Box box;
      box.extend(vec::add(grid_.origin, vec::mul({1.0 * c[0], 1.0 * c[1], 1.0 * c[2]}, d)));
      box.extend(vec::add(box.lower, {d, d, d}));
      const double distance2 = box.distance2(probe);
      if (distance2 < best2) {
        best2 = distance2;
        best = static_cast<std::int32_t>(p);
      }
    }
    return best;
  }

  const SurfaceDistance& surface_;
  const Grid& grid_;
  const Parts& parts_;
  std::vector<Vec3d> inward_;
};

}  // namespace

std::vector<Embedding> embed_vertices(const SurfaceDistance& surface, const Grid& grid, const Parts& parts) {
  const Embedder embedder(surface, grid, parts);
  std::vector<Embedding> out(surface.mesh().vertices.size());
  constexpr std::int64_t kChunk = 256;
  const auto count = static_cast<std::int64_t>(out.size());
  parallel_for((count + kChunk - 1) / kChunk, [&](std::int64_t chunk) {
    for (std::int64_t v = chunk * kChunk; v < std::min(count, (chunk + 1) * kChunk); ++v) out[v] = embedder.embed(v);
  });
  return out;
}

}  // namespace pliant
