// Any text may come from a WebSocket as a state, and as the address of one.
#include <string>

#include "devices/haply.h"
#include "pliant/error.h"
#include "sound_sample.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pliant::devices;
  for (const char* id : {"", "04AF"}) {
    HaplyState state;
    if (read_haply_state({data, size}, id, state) == nullptr) {
      expect_sound(state.sample);
      haply_force(HaplyForce::vector, state.device_id, state.sample.position);
    }
  }
  try {
    parse_haply_address(std::string(reinterpret_cast<const char*>(data), size), "websocket");
  } catch (const pliant::Error&) {
  }
  return 0;
}
