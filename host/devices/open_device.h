// Devices by text.
#pragma once
#include <memory>
#include <string>

#include "pliant/haptic_device.h"

namespace pliant::devices {

/// As pliant::open_haptic_device.
std::shared_ptr<HapticDevice> open_device(const std::string& text);

}  // namespace pliant::devices
