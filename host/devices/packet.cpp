#include "devices/packet.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "geometry/wrench.h"

namespace pliant::devices {

// The packets are copied as they lie in memory.
static_assert(std::endian::native == std::endian::little, "host/devices needs a little-endian machine");

Refusal read_pose(Bytes bytes, DeviceSample& sample) {
  pliant_haptic_pose pose;
  if (bytes.size() != sizeof pose) return "a packet that is not of 88 bytes";
  std::memcpy(&pose, bytes.data(), sizeof pose);
  if (pose.magic != PLIANT_HAPTIC_POSE_MAGIC) return "a packet that does not begin with PLHP";
  if (pose.version != PLIANT_HAPTIC_VERSION) return "a packet of another version than 1";
  if (pose.size != sizeof pose) return "a packet whose size is not 88";
  if (pose.number == 0) return "a packet with the number 0";
  std::copy_n(pose.position, 3, sample.position.begin());
  std::copy_n(pose.turn, 4, sample.turn.begin());
  sample.time = pose.stamp;
  sample.buttons = pose.buttons;
  sample.number = pose.number;
  return check_sample(sample);
}

pliant_haptic_wrench wrench_packet(const DeviceWrench& wrench) {
  pliant_haptic_wrench packet{};
  packet.magic = PLIANT_HAPTIC_WRENCH_MAGIC;
  packet.version = PLIANT_HAPTIC_VERSION;
  packet.size = sizeof packet;
  packet.number = wrench.number;
  packet.stamp = wrench.time;
  copy_wrench(wrench, packet);
  return packet;
}

}  // namespace pliant::devices
