#include "devices/limits.h"

#include <fmt/format.h>

#include "pliant/error.h"

namespace pliant::devices {

void check_limits(const DeviceLimits& limits) {
  if (limits.force >= 0 && limits.torque >= 0) return;
  throw Error(ErrorCode::usage,
              fmt::format("haptic device: its limits are {} N and {} N m, expected 0 or more", limits.force, limits.torque));
}

}  // namespace pliant::devices
