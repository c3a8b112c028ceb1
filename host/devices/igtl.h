// Poses and wrenches as messages of OpenIGTLink (openigtlink.org/developers/spec), header versions 1 and 2.
//
// Written here: the four message types that are needed take little, and libopenigtlink would add a C++ library to everything
// that links libpliant. It is the other side in the tests.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "devices/packet.h"

namespace pliant::devices {

inline constexpr std::size_t kIgtlHeadSize = 58;
inline constexpr std::size_t kIgtlLargestBody = 4096;  ///< larger ones are skipped
inline constexpr std::size_t kIgtlWrenchSize = 116;

/// CRC-64 of ECMA-182, not reflected, starting from 0, as OpenIGTLink has it.
std::uint64_t igtl_crc(Bytes bytes);

/// A message, head and body in one. TRANSFORM gives a pose by a matrix, POSITION and its older name QTRANS by a position and a
/// quaternion of 4, 3 or 0 numbers; lengths come in mm and become m. The time is that of the head [s since 1970], kNoTime
/// if that is 0. Refused: other versions and types, a wrong CRC or length, an extended header that does not fit, what
/// check_sample refuses.
Refusal read_igtl_pose(Bytes message, DeviceSample& sample);

/// A SENSOR message of six numbers, force [N] and torque [N m], from the device name PliantWrench, with the time of the sample
/// that it answers: kIgtlWrenchSize bytes, the return value. Its unit is 0, none, because it knows a single one.
std::size_t write_igtl_wrench(const DeviceWrench& wrench, std::span<std::uint8_t> bytes);

/// Cuts a stream of bytes into messages.
class IgtlStream {
 public:
  /// Takes bytes up to the end of a message. Returns how many; `message` is the message that has become complete, empty if none
  /// has, and valid until the next call. `why` describes a message that is skipped because its body is too large.
  std::size_t take(Bytes bytes, Bytes& message, Refusal& why);
  /// Whether a body of more than a GiB was announced: the stream is not OpenIGTLink.
  [[nodiscard]] bool lost() const { return skip_ > std::uint64_t{1} << 30; }

 private:
  std::array<std::uint8_t, kIgtlHeadSize + kIgtlLargestBody> message_{};
  std::size_t size_ = 0;  ///< bytes of the message that are here
  std::size_t wanted_ = kIgtlHeadSize;
  std::uint64_t skip_ = 0;  ///< bytes of a body that is too large
};

}  // namespace pliant::devices
