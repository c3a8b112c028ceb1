#include "geometry/predicates.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pliant {
namespace {

__extension__ using Wide = __int128;

constexpr double kRange = 274877906944.0;  // 2^38
// Rounding of the determinant of differences, relative to the product of the largest difference along each axis: 6 products of
// three factors, each with at most 6 roundings of 2^-53.
constexpr double kFilter = 1e-14;

Wide determinant(const std::array<std::int64_t, 3>& a, const std::array<std::int64_t, 3>& b,
                 const std::array<std::int64_t, 3>& c) {
  const Wide x = static_cast<Wide>(b[1]) * c[2] - static_cast<Wide>(b[2]) * c[1];
  const Wide y = static_cast<Wide>(b[2]) * c[0] - static_cast<Wide>(b[0]) * c[2];
  const Wide z = static_cast<Wide>(b[0]) * c[1] - static_cast<Wide>(b[1]) * c[0];
  return a[0] * x + a[1] * y + a[2] * z;
}

int sign(Wide value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

// A monomial of the perturbations: row r is moved along axis[r], or not at all (-1). Perturbation (row, axis) is number 3 row +
// axis, each infinitely smaller than every product of those before it; so the monomials, taken as bit masks, come in the order
// of the masks.
struct Monomial {
  std::array<int, 4> axis{-1, -1, -1, -1};
};

std::vector<Monomial> make_monomials() {
  std::vector<Monomial> out;
  for (unsigned mask = 1; mask < 1U << 12; ++mask) {
    Monomial m;
    bool valid = true;
    int used = 0;
    for (int bit = 0; bit < 12 && valid; ++bit) {
      if ((mask >> bit & 1U) == 0) continue;
      const int row = bit / 3, axis = bit % 3;
      valid = m.axis[row] < 0 && (used >> axis & 1) == 0;
      m.axis[row] = axis;
      used |= 1 << axis;
    }
    if (!valid) continue;
    out.push_back(m);
    if (used == 7) break;  // three rows are moved: its coefficient is 1 or -1
  }
  return out;
}

// Sign of the determinant of the rows (x, y, z, 1), with the unit vector of an axis (and 0) for rows that the monomial moves.
int coefficient(const std::array<const ExactPoint*, 4>& p, const Monomial& m) {
  std::array<std::array<std::int64_t, 4>, 4> row{};
  for (std::size_t r = 0; r < 4; ++r) {
    if (m.axis[r] >= 0) {
      row[r][static_cast<std::size_t>(m.axis[r])] = 1;
    } else {
      row[r] = {p[r]->x[0], p[r]->x[1], p[r]->x[2], 1};
    }
  }
  Wide sum = 0;
  for (std::size_t r = 0; r < 4; ++r) {
    if (row[r][3] == 0) continue;
    std::array<std::array<std::int64_t, 3>, 3> rest{};
    for (std::size_t i = 0, k = 0; i < 4; ++i) {
      if (i != r) rest[k++] = {row[i][0], row[i][1], row[i][2]};
    }
    const Wide minor = determinant(rest[0], rest[1], rest[2]);
    sum += (r + 3) % 2 == 0 ? minor : -minor;
  }
  return sign(sum);
}

int orient_perturbed(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d) {
  static const std::vector<Monomial> monomials = make_monomials();
  std::array<const ExactPoint*, 4> p{&a, &b, &c, &d};
  int parity = -1;  // the volume is minus the determinant with the column of ones last
  for (std::size_t i = 1; i < 4; ++i) {
    for (std::size_t j = i; j > 0 && p[j]->id < p[j - 1]->id; --j) {
      std::swap(p[j], p[j - 1]);
      parity = -parity;
    }
  }
  for (const Monomial& m : monomials) {
    if (const int s = coefficient(p, m); s != 0) return parity * s;
  }
  return 1;  // only for equal ids
}

}  // namespace

ExactFrame::ExactFrame(const vec::Box& box) {
  double half = 0;
  for (int a = 0; a < 3; ++a) {
    middle_[a] = 0.5 * (box.lower[a] + box.upper[a]);
    half = std::max(half, 0.5 * (box.upper[a] - box.lower[a]));
  }
  scale_ = half > 0 ? kRange / half : 1;
}

ExactPoint ExactFrame::snap(const Vec3d& p, std::int64_t id) const {
  ExactPoint out{{}, id};
  for (int a = 0; a < 3; ++a) {
    out.x[a] = static_cast<std::int64_t>(std::nearbyint(std::clamp((p[a] - middle_[a]) * scale_, -kRange, kRange)));
  }
  return out;
}

int orient(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d) {
  std::array<std::int64_t, 3> u{}, v{}, w{};
  double bound = kFilter;
  for (int k = 0; k < 3; ++k) {
    u[k] = b.x[k] - a.x[k];
    v[k] = c.x[k] - a.x[k];
    w[k] = d.x[k] - a.x[k];
    bound *= static_cast<double>(std::max({std::abs(u[k]), std::abs(v[k]), std::abs(w[k])}));
  }
  const Vec3d du{static_cast<double>(u[0]), static_cast<double>(u[1]), static_cast<double>(u[2])};
  const Vec3d dv{static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
  const Vec3d dw{static_cast<double>(w[0]), static_cast<double>(w[1]), static_cast<double>(w[2])};
  const double det = vec::dot(du, vec::cross(dv, dw));
  if (det > bound) return 1;
  if (det < -bound) return -1;
  const int exact = sign(determinant(u, v, w));
  return exact != 0 ? exact : orient_perturbed(a, b, c, d);
}

int crosses(const ExactPoint& u, const ExactPoint& w, const ExactPoint& a, const ExactPoint& b, const ExactPoint& c) {
  const int from = orient(a, b, c, u);
  if (orient(a, b, c, w) == from) return 0;
  return passes(u, w, a, b, c) ? -from : 0;
}

bool passes(const ExactPoint& u, const ExactPoint& w, const ExactPoint& a, const ExactPoint& b, const ExactPoint& c) {
  const int side = orient(u, w, a, b);
  return orient(u, w, b, c) == side && orient(u, w, c, a) == side;
}

}  // namespace pliant
