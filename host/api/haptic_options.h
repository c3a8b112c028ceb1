// The options of a HapticLoop, checked and as HapticCore takes them.
#pragma once
#include "haptics/haptic_core.h"
#include "pliant/haptics.h"

namespace pliant::api {

/// Throws Error (usage).
void check_options(const HapticOptions& options);
/// `limits`: of the device.
haptics::CoreOptions core_options(const HapticOptions& options, const DeviceLimits& limits);

}  // namespace pliant::api
