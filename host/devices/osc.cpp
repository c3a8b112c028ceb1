#include "devices/osc.h"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "devices/big_endian.h"

namespace pliant::devices {
namespace {

/// The text at the beginning, which ends with one to four zeros so that a multiple of 4 bytes is taken from `bytes`. Returns
/// whether there is one.
bool take_text(Bytes& bytes, std::string_view& text) {
  const auto end = std::find(bytes.begin(), bytes.end(), std::uint8_t{0});
  const auto length = static_cast<std::size_t>(end - bytes.begin());
  const std::size_t taken = length / 4 * 4 + 4;
  if (taken > bytes.size()) return false;
  text = {reinterpret_cast<const char*>(bytes.data()), length};
  bytes = bytes.subspan(taken);
  return true;
}

Refusal read_message(Bytes bytes, DeviceSample& sample) {
  std::string_view address, types;
  if (!take_text(bytes, address) || address.empty() || address.front() != '/') return "a datagram that is no OSC message";
  if (address != "/pliant/pose") return "an OSC message that is not /pliant/pose";
  const bool typed = take_text(bytes, types);
  if (!typed || (types.size() != 8 && types.size() != 9) || types.front() != ',' || (types.size() == 9 && types[8] != 'i')) {
    return "/pliant/pose without seven numbers and perhaps an integer";
  }
  BigEndianReader reader(bytes);
  for (std::size_t i = 0; i < 7; ++i) {
    const char type = types[i + 1];
    if (type != 'f' && type != 'd') return "/pliant/pose without seven numbers and perhaps an integer";
    (i < 3 ? sample.position[i] : sample.turn[i - 3]) = type == 'f' ? reader.float32() : reader.float64();
  }
  sample.buttons = types.size() == 9 ? reader.number<std::uint32_t>() : 0;
  if (!reader.at_end()) return "/pliant/pose whose length is not that of its types";
  sample.time = kNoTime;
  sample.number = 0;
  return check_sample(sample);
}

}  // namespace

Refusal read_osc_pose(Bytes bytes, DeviceSample& sample) {
  std::string_view first;
  Bytes rest = bytes;
  if (!take_text(rest, first) || first != "#bundle") return read_message(bytes, sample);
  if (rest.size() < 8) return "an OSC bundle that ends within its time";
  rest = rest.subspan(8);
  Refusal why = "an OSC bundle without /pliant/pose";
  while (!rest.empty()) {
    const auto size = BigEndianReader(rest).number<std::uint32_t>();
    if (rest.size() < 4 || size > rest.size() - 4) return "an OSC bundle that ends within a message";
    DeviceSample found;
    const Refusal refused = read_message(rest.subspan(4, size), found);
    rest = rest.subspan(4 + std::size_t{size});
    if (refused == nullptr) sample = found;
    if (refused == nullptr || why != nullptr) why = refused;
  }
  return why;
}

std::size_t write_osc_wrench(const DeviceWrench& wrench, std::span<std::uint8_t> bytes) {
  BigEndianWriter writer(bytes.data());
  writer.text("/pliant/wrench", 16);
  writer.text(",ffffff", 8);
  for (const double x : wrench.force) writer.float32(x);
  for (const double x : wrench.torque) writer.float32(x);
  return writer.size();
}

}  // namespace pliant::devices
