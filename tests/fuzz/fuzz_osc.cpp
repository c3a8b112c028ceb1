// Any bytes may come as a datagram of Open Sound Control.
#include "devices/osc.h"
#include "sound_sample.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  pliant::DeviceSample sample;
  if (pliant::devices::read_osc_pose({data, size}, sample) == nullptr) expect_sound(sample);
  return 0;
}
