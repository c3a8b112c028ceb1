#include "elements/membrane.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"
#include "pliant/error.h"

namespace pliant {

Membrane::Record Membrane::record(const Corners& x, const std::string& what) const {
  const Vec3d first = vec::sub(x[1], x[0]), second = vec::sub(x[2], x[0]);
  const double longest = std::max({vec::norm(first), vec::norm(second), vec::norm(vec::sub(x[2], x[1]))});
  const double l = vec::norm(first), area = vec::norm(vec::cross(first, second)) / 2;
  if (!(2 * area > 1e-6 * longest * longest)) {
    throw Error(ErrorCode::bad_input, fmt::format("{}: got a triangle of {:.3g} m^2 with an edge of {:.3g} m; a membrane needs "
                                                  "triangles higher than 1e-6 of their longest edge",
                                                  what, area, longest));
  }
  Vec3d t1{}, t2{};
  for (int c = 0; c < 3; ++c) t1[c] = first[c] / l;
  const double along = vec::dot(second, t1);
  for (int c = 0; c < 3; ++c) t2[c] = second[c] - along * t1[c];
  const double height = vec::norm(t2);
  for (double& c : t2) c /= height;
  return {t1[0], t1[1], t1[2], t2[0], t2[1], t2[2], 1 / l, -along / (l * height), 1 / height, area * thickness};
}

double Membrane::tangent_bound(const Record& r, const Corners& u) const {
  const Vec3d v1 = vec::sub(u[1], u[0]), v2 = vec::sub(u[2], u[0]);
  Vec3d f1{}, f2{};
  for (int c = 0; c < 3; ++c) {
    f1[c] = r[c] + v1[c] * r[6];
    f2[c] = r[3 + c] + v1[c] * r[7] + v2[c] * r[8];
  }
  const auto larger = [](double xx, double yy, double xy) { return (xx + yy) / 2 + std::hypot((xx - yy) / 2, xy); };
  const double c11 = vec::dot(f1, f1), c22 = vec::dot(f2, f2), c12 = vec::dot(f1, f2);
  const double e11 = (c11 - 1) / 2, e22 = (c22 - 1) / 2, c = stiffness();
  const double stress = larger(c * (e11 + poisson * e22), c * (e22 + poisson * e11), c * (1 - poisson) * c12 / 2);
  return young / (1 - poisson) * std::max(1.0, larger(c11, c22, c12)) + std::max(0.0, stress);
}

double Membrane::energy(const Record& r, const Corners& u) const {
  const Vec3d v1 = vec::sub(u[1], u[0]), v2 = vec::sub(u[2], u[0]);
  const Vec3d t1{r[0], r[1], r[2]}, t2{r[3], r[4], r[5]};
  Vec3d g1{}, g2{};
  for (int c = 0; c < 3; ++c) {
    g1[c] = v1[c] * r[6];
    g2[c] = v1[c] * r[7] + v2[c] * r[8];
  }
  const double e11 = vec::dot(t1, g1) + vec::dot(g1, g1) / 2, e22 = vec::dot(t2, g2) + vec::dot(g2, g2) / 2;
  const double e12 = (vec::dot(t1, g2) + vec::dot(t2, g1) + vec::dot(g1, g2)) / 2;
  return r[9] * stiffness() / 2 * (e11 * e11 + e22 * e22 + 2 * poisson * e11 * e22 + 2 * (1 - poisson) * e12 * e12);
}

double Membrane::stiffness_bound(const Record& r) const {
  // A = B^T B with the rows grad N_0, grad N_1 and grad N_2.
  const std::array<std::array<double, 2>, 3> b{{{-r[6], -(r[7] + r[8])}, {r[6], r[7]}, {0, r[8]}}};
  double xx = 0, yy = 0, xy = 0;
  for (const auto& [x, y] : b) {
    xx += x * x;
    yy += y * y;
    xy += x * y;
  }
  const double largest = (xx + yy) / 2 + std::hypot((xx - yy) / 2, xy);
  return r[9] * young / (1 - poisson) * largest;
}

}  // namespace pliant
