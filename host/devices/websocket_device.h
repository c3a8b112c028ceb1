// Haply's devices, through the WebSocket of their service.
#pragma once
#include <memory>
#include <string>

#include "pliant/haptic_device.h"

namespace pliant::devices {

/// A client of the service at parse_haply_address(rest, text). It connects whenever the service is there, and answers each
/// state by one force: that for this state, or after 2 ms without one the force before. Torques are not exerted. Throws Error
/// `bad_input` if libwebsockets is not installed, or was not there when this was built.
std::shared_ptr<HapticDevice> open_websocket(const std::string& rest, const std::string& text);

}  // namespace pliant::devices
