// Any bytes may come from an OpenIGTLink client, in pieces of any length. Checksums are made right, so that bodies are read.
#include <algorithm>
#include <cstring>
#include <vector>

#include "devices/igtl.h"
#include "sound_sample.h"

using namespace pliant::devices;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  IgtlStream stream;
  const std::size_t piece = size == 0 ? 1 : 1 + data[size - 1];
  for (std::size_t from = 0; from < size; from += piece) {
    Bytes rest(data + from, std::min(piece, size - from));
    while (!rest.empty() && !stream.lost()) {
      Bytes message;
      Refusal why = nullptr;
      const std::size_t taken = stream.take(rest, message, why);
      if (taken == 0 || taken > rest.size()) std::abort();
      rest = rest.subspan(taken);
      if (message.empty()) continue;
      pliant::DeviceSample sample;
      if (read_igtl_pose(message, sample) == nullptr) expect_sound(sample);
      std::vector<std::uint8_t> right(message.begin(), message.end());
      const std::uint64_t crc = igtl_crc(Bytes(right).subspan(kIgtlHeadSize));
      for (std::size_t i = 0; i < 8; ++i) right[50 + i] = static_cast<std::uint8_t>(crc >> (56 - 8 * i));
      if (read_igtl_pose(right, sample) == nullptr) expect_sound(sample);
    }
  }
  return 0;
}
