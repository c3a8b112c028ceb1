// A device at the other end of UDP datagrams, in one of several formats.
#pragma once
#include <netinet/in.h>

#include <array>
#include <cstdint>
#include <string>

#include "devices/listen.h"
#include "devices/packet.h"
#include "devices/threaded_device.h"

namespace pliant::devices {

/// A format of datagrams. `read` fills the sample or says why not; `sample.number` is how the sender counts it, 0 if it does
/// not. `write` fills at most 512 bytes and returns how many.
struct DatagramFormat {
  Refusal (*read)(Bytes bytes, DeviceSample& sample);
  std::size_t (*write)(const DeviceWrench& wrench, std::span<std::uint8_t> bytes);
};

/// The packets of include/pliant/c/haptic_packet.h.
extern const DatagramFormat kPackets;

/// Takes samples from whoever sends any, and sends each wrench to whoever sent the newest.
class DatagramDevice final : public ThreadedDevice {
 public:
  /// `place` as in listen_at; `text` is the whole text of the device, for messages.
  DatagramDevice(const DatagramFormat& format, const std::string& place, const std::string& text);
  ~DatagramDevice() override { stop(); }
  [[nodiscard]] int port() const noexcept override { return listening_.port; }

 private:
  void serve() override;
  void receive();
  void send();

  const DatagramFormat& format_;
  Listening listening_;
  sockaddr_in sender_{};      ///< of the newest sample; port 0: none came yet
  std::uint64_t newest_ = 0;  ///< number of its newest sample
  std::array<std::uint8_t, 2048> bytes_{};
};

}  // namespace pliant::devices
