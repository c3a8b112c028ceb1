// Run states that came with a checkpoint: whatever is changed in their bytes, a simulation takes them up and goes on, or Error
// says why not and nothing has changed.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "pliant/error.h"
#include "solver/rich_state.h"

namespace {

using namespace pliant;

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", what);
  std::abort();
}

struct Target {
  Scene scene = rich_scene();
  Snapshot good = rich_simulation(scene)->snapshot();
  std::string bytes = write_state(good.state);
  Simulation simulation{scene, open_backend("cpu")};
};

/// The good state with changes: where (24 bits), what, and with which byte. Random bytes alone would never be a state.
std::string damaged(std::string bytes, const std::uint8_t* data, std::size_t size) {
  for (; size >= 5 && bytes.size() > 1; data += 5, size -= 5) {
    const std::size_t at = (data[0] | data[1] << 8 | data[2] << 16) % bytes.size();
    const auto value = static_cast<char>(data[4]);
    switch (data[3] % 5) {
      case 0:
        bytes[at] = value;
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << data[4] % 8));
        break;
      case 2:
        bytes.erase(at, 1 + data[4] % 32);
        break;
      case 3:
        bytes.insert(at, 1 + data[4] % 32, value);
        break;
      default:
        for (std::size_t b = at; b < std::min(bytes.size(), at + 8); ++b) bytes[b] = value;
    }
  }
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Target target;
  Simulation& s = target.simulation;
  const std::uint64_t before = s.deep_hash();
  Snapshot snapshot = target.good;
  try {
    snapshot.state = read_state(damaged(target.bytes, data, size));
    s.restore(snapshot);
  } catch (const Error& error) {
    require(error.code() != ErrorCode::internal, error.what());
    require(s.deep_hash() == before, "a refused state changes nothing");
    return 0;
  }
  try {
    s.advance(8);
  } catch (const Error& error) {
    require(error.code() != ErrorCode::internal, error.what());
  }
  s.restore(target.good);
  return 0;
}
