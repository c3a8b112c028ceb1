#include "devices/igtl.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include "devices/big_endian.h"

namespace pliant::devices {
namespace {

constexpr std::uint64_t kPolynomial = 0x42F0E1EBA9EA3693;  ///< ECMA-182
constexpr double kMillimetre = 1e-3;

constexpr std::array<std::uint64_t, 256> crc_table() {
  std::array<std::uint64_t, 256> table{};
  for (std::uint64_t i = 0; i < 256; ++i) {
    std::uint64_t crc = i << 56;
    for (int bit = 0; bit < 8; ++bit) crc = crc << 1 ^ ((crc >> 63) != 0 ? kPolynomial : 0);
    table[i] = crc;
  }
  return table;
}
constexpr std::array<std::uint64_t, 256> kCrcTable = crc_table();

std::uint64_t number_at(Bytes bytes, std::size_t at) { return BigEndianReader(bytes.subspan(at)).number<std::uint64_t>(); }

/// 32 bits of seconds and 32 of their fractions.
double seconds_of(std::uint64_t stamp) { return static_cast<double>(stamp) * 0x1p-32; }
std::uint64_t stamp_of(double seconds) {
  return seconds >= 0 && seconds < 0x1p32 ? static_cast<std::uint64_t>(seconds * 0x1p32) : 0;
}

/// 12 numbers: the three axes of the rotation, then the translation.
Refusal read_transform(Bytes content, DeviceSample& sample) {
  if (content.size() != 48) return "a TRANSFORM that is not of 48 bytes";
  BigEndianReader reader(content);
  std::array<std::array<double, 3>, 3> rotation{};
  for (int column = 0; column < 3; ++column) {
    for (auto& row : rotation) row[column] = reader.float32();
  }
  for (double& x : sample.position) x = reader.float32() * kMillimetre;
  return turn_of_rotation(rotation, sample.turn);
}

Refusal read_position(Bytes content, DeviceSample& sample) {
  if (content.size() != 12 && content.size() != 24 && content.size() != 28)
    return "a POSITION that is not of 12, 24 or 28 bytes";
  BigEndianReader reader(content);
  for (double& x : sample.position) x = reader.float32() * kMillimetre;
  sample.turn = {0, 0, 0, 1};
  if (content.size() == 12) return nullptr;
  double square = 0;
  for (int a = 0; a < 3; ++a) {
    sample.turn[a] = reader.float32();
    square += sample.turn[a] * sample.turn[a];
  }
  sample.turn[3] = content.size() == 28 ? reader.float32() : std::sqrt(std::max(0.0, 1 - square));
  return nullptr;
}

/// Version 2 wraps the content: an extended header before it, meta data behind it.
Refusal unwrap(Bytes& content) {
  BigEndianReader reader(content);
  const std::size_t head = reader.number<std::uint16_t>(), meta_head = reader.number<std::uint16_t>();
  const std::size_t meta = reader.number<std::uint32_t>();
  if (!reader.good() || head < 12 || head + meta_head + meta > content.size())
    return "an extended header that does not fit its body";
  content = content.subspan(head, content.size() - head - meta_head - meta);
  return nullptr;
}

}  // namespace

std::uint64_t igtl_crc(Bytes bytes) {
  std::uint64_t crc = 0;
  for (const std::uint8_t b : bytes) crc = kCrcTable[(crc >> 56 ^ b) & 0xFF] ^ crc << 8;
  return crc;
}

Refusal read_igtl_pose(Bytes message, DeviceSample& sample) {
  if (message.size() < kIgtlHeadSize) return "a message of less than 58 bytes";
  const auto version = BigEndianReader(message).number<std::uint16_t>();
  if (version != 1 && version != 2) return "an OpenIGTLink header of another version than 1 and 2";
  const char* name = reinterpret_cast<const char*>(message.data() + 2);
  const std::string_view type(name, strnlen(name, 12));
  Bytes content = message.subspan(kIgtlHeadSize);
  if (number_at(message, 42) != content.size()) return "a body that is not as long as its header says";
  const bool transform = type == "TRANSFORM";
  if (!transform && type != "POSITION" && type != "QTRANS") return "a message that is no TRANSFORM, POSITION or QTRANS";
  if (number_at(message, 50) != igtl_crc(content)) return "a body whose CRC is wrong";
  if (version == 2) {
    if (const Refusal why = unwrap(content); why != nullptr) return why;
  }
  if (const Refusal why = transform ? read_transform(content, sample) : read_position(content, sample); why != nullptr)
    return why;
  const std::uint64_t stamp = number_at(message, 34);
  sample.time = stamp == 0 ? kNoTime : seconds_of(stamp);
  sample.buttons = 0;
  sample.number = 0;
  return check_sample(sample);
}

std::size_t write_igtl_wrench(const DeviceWrench& wrench, std::span<std::uint8_t> bytes) {
  BigEndianWriter body(bytes.data() + kIgtlHeadSize);
  body.number(6, 1);  // numbers
  body.number(0, 1);  // reserved
  body.number(0, 8);  // unit
  for (const double x : wrench.force) body.float64(x);
  for (const double x : wrench.torque) body.float64(x);
  BigEndianWriter head(bytes.data());
  head.number(1, 2);
  head.text("SENSOR", 12);
  head.text("PliantWrench", 20);
  head.number(stamp_of(wrench.time), 8);
  head.number(body.size(), 8);
  head.number(igtl_crc(Bytes(bytes).subspan(kIgtlHeadSize, body.size())), 8);
  return head.size() + body.size();
}

std::size_t IgtlStream::take(Bytes bytes, Bytes& message, Refusal& why) {
  message = {};
  why = nullptr;
  if (skip_ > 0) {
    const std::size_t skipped = std::min<std::uint64_t>(skip_, bytes.size());
    skip_ -= skipped;
    return skipped;
  }
  const std::size_t taken = std::min(wanted_ - size_, bytes.size());
  std::copy_n(bytes.begin(), taken, message_.begin() + size_);
  size_ += taken;
  if (size_ < wanted_) return taken;
  if (wanted_ == kIgtlHeadSize) {
    const std::uint64_t body = number_at(Bytes(message_), 42);
    if (body > kIgtlLargestBody) {
      why = "a body of more than 4096 bytes";
      skip_ = body;
      size_ = 0;
      return taken;
    }
    wanted_ += body;
    if (size_ < wanted_) return taken;
  }
  message = Bytes(message_).first(size_);
  size_ = 0;
  wanted_ = kIgtlHeadSize;
  return taken;
}

}  // namespace pliant::devices
