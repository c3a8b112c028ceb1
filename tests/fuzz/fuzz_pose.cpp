// Any bytes may come as a datagram or lie in shared memory: they are a pose, or there is a reason why not.
#include <cstring>

#include "devices/packet.h"
#include "sound_sample.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  pliant::DeviceSample sample;
  if (pliant::devices::read_pose({data, size}, sample) == nullptr) expect_sound(sample);
  // What comes is rarely of the right length and magic: once more with both.
  pliant_haptic_pose pose{};
  std::memcpy(&pose, data, size < sizeof pose ? size : sizeof pose);
  pose.magic = PLIANT_HAPTIC_POSE_MAGIC;
  pose.version = PLIANT_HAPTIC_VERSION;
  pose.size = sizeof pose;
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&pose);
  if (pliant::devices::read_pose({bytes, sizeof pose}, sample) == nullptr) expect_sound(sample);
  return 0;
}
