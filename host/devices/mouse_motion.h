// How the cap of a 3D mouse moves a pose.
#pragma once
#include <array>
#include <string>

#include "pliant/haptic_device.h"

namespace pliant::devices {

/// Deflection of the cap: x right, y up, z away from the hand, then the turns about them; 0 at rest, about +-350 at most.
using CapAxes = std::array<int, 6>;

constexpr double kFullDeflection = 350;

/// Speeds at full deflection.
struct MouseSpeeds {
  double linear = 0.1;  ///< [m/s]
  double turn = 1.5;    ///< [rad/s]
};

/// Moves and turns a pose by the deflection of the cap during `dt` seconds, at most 0.1. The pose has x right, y up and z
/// towards the hand, so that z and the turn about it change their signs; it turns about these axes, not its own.
void move_pose(DeviceSample& pose, const CapAxes& cap, double dt, const MouseSpeeds& speeds);

/// Button `number` went down or up: bit `number`, of 0 to 31.
void press_button(DeviceSample& pose, int number, bool down);

/// "" or "linear=NUMBER", "turn=NUMBER" or both, separated by a comma: [m/s] in 0.001 to 10, [rad/s] in 0.01 to 100. Throws
/// Error `usage` for anything else; `text` is the whole text of the device.
MouseSpeeds parse_speeds(const std::string& rest, const std::string& text);

}  // namespace pliant::devices
