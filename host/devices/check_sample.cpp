#include "devices/check_sample.h"

#include <cmath>

namespace pliant::devices {

Refusal check_sample(DeviceSample& sample) {
  for (const double x : sample.position) {
    if (!std::isfinite(x)) return "a position that is not finite";
    if (std::abs(x) > kFarthest) return "a position beyond 1000 m";
  }
  if (!std::isfinite(sample.time)) return "a time that is not finite";
  double square = 0;
  for (const double q : sample.turn) square += q * q;  // garbage may overflow: refused, like what is not finite
  const double length = std::sqrt(square);
  if (!(std::abs(length - 1) <= kTurnTolerance)) return "a quaternion that is not of unit length";
  for (double& q : sample.turn) q /= length;
  return nullptr;
}

/// Shepperd's method: the largest of the four components is found from the diagonal, the others from it.
Refusal turn_of_rotation(const std::array<std::array<double, 3>, 3>& r, std::array<double, 4>& turn) {
  for (int a = 0; a < 3; ++a) {
    for (int b = a; b < 3; ++b) {
      const double product = r[0][a] * r[0][b] + r[1][a] * r[1][b] + r[2][a] * r[2][b];
      if (!(std::abs(product - (a == b ? 1 : 0)) <= 2 * kTurnTolerance)) return "a rotation whose axes are not orthonormal";
    }
  }
  const double determinant = r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1]) -
                             r[0][1] * (r[1][0] * r[2][2] - r[1][2] * r[2][0]) +
                             r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
  if (determinant < 0) return "a rotation that mirrors";
  const double trace = r[0][0] + r[1][1] + r[2][2];
  int largest = 3;
  double most = trace;
  for (int i = 0; i < 3; ++i) {
    if (r[i][i] > most) {
      most = r[i][i];
      largest = i;
    }
  }
  if (largest == 3) {
    turn = {r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1], 1 + trace};
  } else {
    const int i = largest, j = (i + 1) % 3, k = (i + 2) % 3;
    turn[i] = 1 + r[i][i] - r[j][j] - r[k][k];
    turn[j] = r[j][i] + r[i][j];
    turn[k] = r[k][i] + r[i][k];
    turn[3] = r[k][j] - r[j][k];
  }
  double square = 0;
  for (const double q : turn) square += q * q;
  for (double& q : turn) q /= std::sqrt(square);
  return nullptr;
}

}  // namespace pliant::devices
