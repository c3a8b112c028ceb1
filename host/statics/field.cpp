// Point location and interpolation.
#include <algorithm>
#include <cmath>

#include "geometry/parallel.h"
#include "statics/shape.h"

namespace pliant::statics {
namespace {

double outside_of(Element element, const Vector3d& l) {
  double out = 0;
  for (int c = 0; c < 3; ++c) out = std::max(out, -l[c]);
  return element == Element::hex8full ? std::max(out, l.maxCoeff() - 1) : std::max(out, l.sum() - 1);
}

vec::Box box_of(const Mesh& mesh, std::int64_t element) {
  vec::Box box;
  for (int a = 0; a < corners_of(mesh.element); ++a) box.extend(mesh.nodes[mesh.nodes_of(element)[a]]);
  return box;
}

}  // namespace

Field::Field(const Mesh& mesh) : mesh_(mesh) {
  double edges = 0;
  for (std::int64_t e = 0; e < mesh.elements(); ++e) {
    const vec::Box box = box_of(mesh, e);
    bounds_.extend(box);
    for (int c = 0; c < 3; ++c) edges += (box.upper[c] - box.lower[c]) / 3;
  }
  cell_ = edges / static_cast<double>(std::max<std::int64_t>(1, mesh.elements()));
  const auto counts = [&] {
    double all = 1;
    for (int c = 0; c < 3; ++c) {
      size_[c] = std::max(1, static_cast<int>(std::ceil(std::min(1e6, (bounds_.upper[c] - bounds_.lower[c]) / cell_))));
      all *= size_[c];
    }
    return all;
  };
  while (counts() > 4e6) cell_ *= 1.26;
  const std::size_t cells = static_cast<std::size_t>(size_[0]) * size_[1] * size_[2];
  // Count, then place: the elements of each cell in ascending order.
  first_.assign(cells + 1, 0);
  const auto range = [&](double x, int c) {
    return std::clamp(static_cast<int>(std::floor((x - bounds_.lower[c]) / cell_)), 0, size_[c] - 1);
  };
  const auto each_cell = [&](std::int64_t e, const auto& work) {
    const vec::Box box = box_of(mesh, e);
    // Curved edges reach a little beyond the box of the nodes.
    const double slack = 0.1 * cell_;
    for (int k = range(box.lower[2] - slack, 2); k <= range(box.upper[2] + slack, 2); ++k) {
      for (int j = range(box.lower[1] - slack, 1); j <= range(box.upper[1] + slack, 1); ++j) {
        for (int i = range(box.lower[0] - slack, 0); i <= range(box.upper[0] + slack, 0); ++i)
          work((static_cast<std::size_t>(k) * size_[1] + j) * size_[0] + i);
      }
    }
  };
  for (std::int64_t e = 0; e < mesh.elements(); ++e) each_cell(e, [&](std::size_t cell) { ++first_[cell + 1]; });
  for (std::size_t c = 0; c < cells; ++c) first_[c + 1] += first_[c];
  held_.resize(first_.back());
  std::vector<std::int64_t> next(first_.begin(), first_.end() - 1);
  for (std::int64_t e = 0; e < mesh.elements(); ++e) each_cell(e, [&](std::size_t cell) { held_[next[cell]++] = e; });
}

Place Field::place_in(std::int64_t element, const Vec3d& rest) const {
  const Gradients x = corners_at(mesh_, element);
  Vector3d local = Vector3d::Constant(mesh_.element == Element::hex8full ? 0.5 : 0.25);
  // Newton's method: one step where the map is affine, a few where it is not. Far outside it may not converge.
  for (int i = 0; i < 12; ++i) {
    const Vector3d miss = eigen(rest) - x * shape_values(mesh_.element, local);
    const Matrix3d jacobian = x * shape_gradients(mesh_.element, local).transpose();
    const Vector3d step = jacobian.partialPivLu().solve(miss);
    local += step;
    if (!(step.cwiseAbs().maxCoeff() > 1e-13)) break;
  }
  const double missed = (eigen(rest) - x * shape_values(mesh_.element, local)).norm();
  const bool found = local.allFinite() && missed <= 1e-9 * cell_;
  return {element, plain(local), found ? outside_of(mesh_.element, local) : HUGE_VAL};
}

Place Field::locate(const Vec3d& rest) const {
  constexpr double kInside = 1e-9;
  Place best;
  best.outside = HUGE_VAL;
  std::array<int, 3> at{};
  for (int c = 0; c < 3; ++c)
    at[c] = static_cast<int>(std::clamp(std::floor((rest[c] - bounds_.lower[c]) / cell_), 0.0, size_[c] - 1.0));
  int rings = std::max({size_[0], size_[1], size_[2]});
  for (int ring = 0; ring <= rings; ++ring) {
    for (int k = std::max(0, at[2] - ring); k <= std::min(size_[2] - 1, at[2] + ring); ++k) {
      for (int j = std::max(0, at[1] - ring); j <= std::min(size_[1] - 1, at[1] + ring); ++j) {
        for (int i = std::max(0, at[0] - ring); i <= std::min(size_[0] - 1, at[0] + ring); ++i) {
          if (std::max({std::abs(i - at[0]), std::abs(j - at[1]), std::abs(k - at[2])}) != ring) continue;
          const std::size_t cell = (static_cast<std::size_t>(k) * size_[1] + j) * size_[0] + i;
          for (std::int64_t h = first_[cell]; h < first_[cell + 1]; ++h) {
            const Place place = place_in(held_[h], rest);
            if (place.outside < best.outside) best = place;
            if (best.outside <= kInside) return best;
          }
        }
      }
    }
    // One ring more than the first that holds an element: the nearest may lie there.
    if (best.element >= 0) rings = std::min(rings, ring + 1);
  }
  return best;
}

std::vector<Place> Field::locate(const std::vector<Vec3d>& rest) const {
  std::vector<Place> out(rest.size());
  constexpr std::int64_t kSlice = 128;
  const auto count = static_cast<std::int64_t>(rest.size());
  parallel_for((count + kSlice - 1) / kSlice, [&](std::int64_t slice) {
    for (std::int64_t i = slice * kSlice; i < std::min(count, (slice + 1) * kSlice); ++i) out[i] = locate(rest[i]);
  });
  return out;
}

Vec3d Field::value(const Place& place, const std::vector<Vec3d>& values) const {
  const ShapeValues n = shape_values(mesh_.element, eigen(place.local));
  Vector3d sum = Vector3d::Zero();
  for (int a = 0; a < n.size(); ++a) sum += n[a] * eigen(values[mesh_.nodes_of(place.element)[a]]);
  return plain(sum);
}

std::array<double, 9> Field::gradient(const Place& place, const std::vector<Vec3d>& values) const {
  const Gradients local = shape_gradients(mesh_.element, eigen(place.local));
  const Matrix3d jacobian = corners_at(mesh_, place.element) * local.transpose();
  const Gradients g = jacobian.inverse().transpose() * local;
  std::array<double, 9> out{};
  for (int a = 0; a < g.cols(); ++a) {
    const Vec3d& value = values[mesh_.nodes_of(place.element)[a]];
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) out[3 * i + j] += value[i] * g(j, a);
    }
  }
  return out;
}

std::vector<Sample> samples(const Mesh& mesh) {
  std::vector<Sample> out;
  for (std::int64_t e = 0; e < mesh.elements(); ++e) {
    const Gradients x = corners_at(mesh, e);
    for (const LocalPoint& p : accurate_quadrature(mesh.element)) {
      const double determinant = (x * shape_gradients(mesh.element, p.at).transpose()).determinant();
      out.push_back({plain(x * shape_values(mesh.element, p.at)),
                     {e, plain(p.at), 0},
                     p.weight * determinant * (mesh.fill.empty() ? 1 : mesh.fill[e])});
    }
  }
  return out;
}

}  // namespace pliant::statics
