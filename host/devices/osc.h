// Poses and wrenches as messages of Open Sound Control 1.0 (opensoundcontrol.stanford.edu/spec-1_0.html).
//
// What these two messages need of the protocol is small, and bytes from the network are read here without allocating; liblo is
// the other side in the tests.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "devices/datagram_device.h"

namespace pliant::devices {

/// "/pliant/pose" with x, y, z [m] and the quaternion x, y, z, w as seven floats or doubles (types f and d), and the buttons as
/// an optional integer (i). Of a bundle, the last pose counts; a bundle in a bundle is refused, and so is every other message.
Refusal read_osc_pose(Bytes bytes, DeviceSample& sample);

/// "/pliant/wrench" with force [N] and torque [N m] as six floats: 48 bytes, the return value.
std::size_t write_osc_wrench(const DeviceWrench& wrench, std::span<std::uint8_t> bytes);

/// The format of the device osc:PORT.
inline constexpr DatagramFormat kOsc{read_osc_pose, write_osc_wrench};

}  // namespace pliant::devices
