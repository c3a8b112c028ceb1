// Separation along existing faces (Mendoza and Laugier) of a mesh at rest: which faces a blade opens, and the local remeshing
// that moves the nodes of the cut onto it. Running bodies are parted by tearing/swept_faces.h.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "cutting/topology/cut_cell.h"
#include "geometry/vec.h"
#include "pliant/error.h"
#include "tearing/method.h"
#include "tearing/sweep_probe.h"

namespace pliant {
namespace {

/// Outward normals at a node of the boundary that are this close (cosine) are one surface: the node may slide along it.
constexpr double kSameSurface = 0.95;
constexpr int kHalvings = 5;

class Separator {
 public:
  Separator(const ElementMesh& mesh, std::span<const SweepTriangle> sweep, const SeparationOptions& options)
      : options_(options), neighbors_(element_neighbors(mesh.tets)), cut_(mesh.tets.size(), 0) {
    out_.mesh = mesh;
    vec::Box box;
    for (const Vec3d& x : mesh.nodes) box.extend(x);
    edge_ = mean_edge(mesh);
    probe_ = std::make_unique<SweepProbe>(box, edge_, sweep);
  }

  MethodResult run() {
    choose_faces();
    for (std::size_t t = 0; t < cut_.size(); ++t) {
      for (int f = 0; f < 4 && cut_[t] != 0; ++f) {
        if (!(cut_[t] >> f & 1)) continue;
        for (const int k : kTetFaces[f]) on_cut_.insert(out_.mesh.tets[t][k]);
      }
    }
    out_.distance_before = out_.distance = distance();
    if (options_.remesh && !on_cut_.empty()) {
      find_surroundings();
      for (const std::int32_t n : on_cut_) move(n);
      out_.distance = distance();
    }
    out_.node_from = part_at_faces(out_.mesh.tets, out_.mesh.nodes.size(), cut_);
    for (std::size_t n = out_.mesh.nodes.size(); n < out_.node_from.size(); ++n)
      out_.mesh.nodes.push_back(out_.mesh.nodes[out_.node_from[n]]);
    for (std::size_t t = 0; t < cut_.size(); ++t) out_.element_from.push_back(static_cast<std::int32_t>(t));
    return std::move(out_);
  }

 private:
  [[nodiscard]] std::array<Vec3d, 4> corners(std::size_t t) const {
    std::array<Vec3d, 4> x;
    for (std::size_t a = 0; a < 4; ++a) x[a] = out_.mesh.nodes[out_.mesh.tets[t][a]];
    return x;
  }

  [[nodiscard]] Vec3d centroid(std::size_t t) const {
    Vec3d sum{};
    for (const Vec3d& x : corners(t)) sum = vec::add(sum, vec::mul(x, 0.25));
    return sum;
  }

  void choose_faces() {
    const auto number = [&](std::size_t t) { return static_cast<std::int64_t>(out_.mesh.nodes.size() + t); };
    for (std::size_t t = 0; t < cut_.size(); ++t) {
      for (int f = 0; f < 4; ++f) {
        const TetFace other = neighbors_[t][f];
        if (other.tet <= static_cast<std::int32_t>(t)) continue;
        const auto o = static_cast<std::size_t>(other.tet);
        const Vec3d here = centroid(t), there = centroid(o);
        if (!probe_->between(probe_->point(here, number(t)), here, probe_->point(there, number(o)), there)) continue;
        if (options_.law != nullptr && !gives_way(t) && !gives_way(o)) continue;
        ++out_.crossed;
        cut_[t] |= static_cast<std::uint8_t>(1 << f);
        cut_[o] |= static_cast<std::uint8_t>(1 << other.face);
      }
    }
  }

  [[nodiscard]] bool gives_way(std::size_t t) const {
    std::array<Vec3d, 4> now = corners(t);
    for (std::size_t a = 0; a < 4; ++a) now[a] = vec::add(now[a], options_.displacement[out_.mesh.tets[t][a]]);
    const auto stress = tet_stress(corners(t), now, *options_.material);
    return stress && breaks(*stress, *options_.law);
  }

  /// Mean distance of the nodes of the cut from the sweep.
  double distance() {
    double sum = 0;
    for (const std::int32_t n : on_cut_) {
      Vec3d at{};
      if (probe_->nearest(out_.mesh.nodes[n], 4 * edge_, at)) sum += vec::norm(vec::sub(out_.mesh.nodes[n], at));
    }
    return on_cut_.empty() ? 0 : sum / static_cast<double>(on_cut_.size());
  }

  void find_surroundings() {
    around_.resize(out_.mesh.nodes.size());
    normals_.resize(out_.mesh.nodes.size());
    for (std::size_t t = 0; t < out_.mesh.tets.size(); ++t) {
      const auto& tet = out_.mesh.tets[t];
      const auto x = corners(t);
      for (const std::int32_t n : tet) around_[n].push_back(static_cast<std::int32_t>(t));
      for (std::size_t f = 0; f < 4; ++f) {
        if (neighbors_[t][f].tet >= 0) continue;
        const auto& c = kTetFaces[f];
        Vec3d normal = vec::cross(vec::sub(x[c[1]], x[c[0]]), vec::sub(x[c[2]], x[c[0]]));
        normal = vec::mul(normal, 1 / vec::norm(normal));
        for (const int k : c) add_normal(tet[k], normal);
      }
    }
  }

  void add_normal(std::int32_t n, const Vec3d& normal) {
    for (const Vec3d& known : normals_[n]) {
      if (vec::dot(known, normal) > kSameSurface) return;
    }
    normals_[n].push_back(normal);
  }

  /// What of a motion leaves the outside of the body as it is: all of it inside, the part along a face, or along a ridge.
  [[nodiscard]] Vec3d allowed(std::int32_t n, const Vec3d& motion) const {
    const auto& normals = normals_[n];
    if (normals.empty()) return motion;
    if (normals.size() == 1) return vec::sub(motion, vec::mul(normals[0], vec::dot(normals[0], motion)));
    if (normals.size() > 2) return {};
    Vec3d ridge = vec::cross(normals[0], normals[1]);
    const double length = vec::norm(ridge);
    if (length < 0.1) return {};
    ridge = vec::mul(ridge, 1 / length);
    return vec::mul(ridge, vec::dot(ridge, motion));
  }

  void move(std::int32_t n) {
    Vec3d target{};
    if (!probe_->nearest(out_.mesh.nodes[n], edge_, target)) return;
    const Vec3d from = out_.mesh.nodes[n];
    Vec3d motion = allowed(n, vec::sub(target, from));
    std::vector<double> before;
    for (const std::int32_t t : around_[n]) before.push_back(tet_quality(corners(t)));
    for (int k = 0; k < kHalvings; ++k, motion = vec::mul(motion, 0.5)) {
      out_.mesh.nodes[n] = vec::add(from, motion);
      bool good = true;
      for (std::size_t i = 0; i < before.size() && good; ++i) {
        const double quality = tet_quality(corners(around_[n][i]));
        good = quality >= options_.least_quality || quality >= before[i];
      }
      if (good) return;
    }
    out_.mesh.nodes[n] = from;
  }

  const SeparationOptions& options_;
  MethodResult out_;
  std::vector<std::array<TetFace, 4>> neighbors_;
  std::vector<std::uint8_t> cut_;
  std::unique_ptr<SweepProbe> probe_;
  double edge_ = 0;
  std::set<std::int32_t> on_cut_;
  std::vector<std::vector<std::int32_t>> around_;
  std::vector<std::vector<Vec3d>> normals_;
};

}  // namespace

MethodResult separate_crossed(const ElementMesh& mesh, std::span<const SweepTriangle> sweep, const SeparationOptions& options) {
  const ElementMesh parts = kuhn_tetrahedra(mesh);
  if (options.law != nullptr && (options.material == nullptr || options.displacement.size() != parts.nodes.size())) {
    throw Error(ErrorCode::bad_input,
                fmt::format("a breaking law needs a material and a displacement of each of {} nodes, got {}",
                            parts.nodes.size(), options.displacement.size()));
  }
  return Separator(parts, sweep, options).run();
}

}  // namespace pliant
