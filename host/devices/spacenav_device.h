// A 3D mouse, through libspnav and its daemon spacenavd.
#pragma once
#include <memory>
#include <string>

#include "pliant/haptic_device.h"

namespace pliant::devices {

/// A pose that begins at the origin and moves while the cap of the mouse is held (move_pose, with parse_speeds(rest, text)),
/// 500 samples a second. It exerts no force. libspnav has one connection for the whole program, so that there is one such
/// device at a time. Throws Error `bad_input` if libspnav is not installed or was not there when this was built, if spacenavd
/// cannot be reached, and if such a device is open.
std::shared_ptr<HapticDevice> open_spacenav(const std::string& rest, const std::string& text);

}  // namespace pliant::devices
