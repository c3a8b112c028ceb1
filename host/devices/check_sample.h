// The check of every sample that comes from outside, for all devices.
#pragma once
#include <array>
#include <limits>

#include "pliant/haptic_device.h"

namespace pliant::devices {

/// Why a message gave no sample: a text that is never freed. Null: it gave one.
using Refusal = const char*;

/// Greatest distance of a tip from the origin of its device, along an axis [m]: beyond it a message is garbage.
constexpr double kFarthest = 1000;
/// How far the length of a quaternion, or of the axes of a rotation, may be from 1.
constexpr double kTurnTolerance = 1e-3;

/// Time of a sample whose format has none: the device puts in when it came.
constexpr double kNoTime = std::numeric_limits<double>::lowest();

/// Checks that position and time are finite and the quaternion has unit length within kTurnTolerance; makes it exactly so.
Refusal check_sample(DeviceSample& sample);

/// A rotation given by its axes in columns, rotation[row][column], as a unit quaternion x, y, z, w. Axes that are not of unit
/// length, orthogonal and right-handed within kTurnTolerance are refused.
Refusal turn_of_rotation(const std::array<std::array<double, 3>, 3>& rotation, std::array<double, 4>& turn);

}  // namespace pliant::devices
