// The packets of include/pliant/c/haptic_packet.h, from and to bytes.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "devices/check_sample.h"
#include "pliant/c/haptic_packet.h"

namespace pliant::devices {

using Bytes = std::span<const std::uint8_t>;

/// A pliant_haptic_pose. `sample.number` is that of the packet. Refused: another length, magic, version or size; number 0; what
/// check_sample refuses.
Refusal read_pose(Bytes bytes, DeviceSample& sample);

/// The wrench as a pliant_haptic_wrench.
pliant_haptic_wrench wrench_packet(const DeviceWrench& wrench);

}  // namespace pliant::devices
