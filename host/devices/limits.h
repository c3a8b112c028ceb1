// Limits of devices that a program describes.
#pragma once
#include "pliant/haptic_device.h"

namespace pliant::devices {

/// Throws Error (usage) unless both are 0 or more; they may be infinite.
void check_limits(const DeviceLimits& limits);

}  // namespace pliant::devices
