// What must hold for every sample that a reader of host/devices accepts.
#pragma once
#include <cmath>
#include <cstdlib>

#include "devices/check_sample.h"

/// Aborts unless position and time are finite, the position is near and the quaternion is a unit one.
inline void expect_sound(const pliant::DeviceSample& sample) {
  double square = 0;
  for (const double q : sample.turn) square += q * q;
  bool sound = std::isfinite(sample.time) && std::abs(square - 1) < 1e-11;
  for (const double x : sample.position) sound = sound && std::abs(x) <= pliant::devices::kFarthest;
  if (!sound) std::abort();
}
