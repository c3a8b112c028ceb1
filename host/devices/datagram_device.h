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

/// Takes samples from whoever sends any, in a thread. write() sends the wrench to whoever sent the newest sample that was read,
/// by one system call that never waits: no other thread has to run first.
class DatagramDevice final : public ThreadedDevice {
 public:
  /// `place` as in listen_at; `text` is the whole text of the device, for messages.
  DatagramDevice(const DatagramFormat& format, const std::string& place, const std::string& text);
  ~DatagramDevice() override { stop(); }
  DeviceSample read() noexcept override;
  void write(const DeviceWrench& wrench) noexcept override;
  [[nodiscard]] int port() const noexcept override { return listening_.port; }

 private:
  /// A sample with its sender, and how the sender counts it.
  struct Arrived {
    DeviceSample sample;
    std::uint64_t senders_number = 0;
    sockaddr_in sender{};
  };
  void serve() override;
  void receive();

  const DatagramFormat& format_;
  Listening listening_;
  Mailbox<Arrived> arrived_;
  // Of the thread.
  sockaddr_in sender_{};      ///< of the newest sample
  std::uint64_t newest_ = 0;  ///< number of its newest sample
  std::array<std::uint8_t, 2048> bytes_{};
  // Of whoever calls read() and write().
  struct Numbers {
    std::uint64_t ours = 0, senders = 0;
  };
  std::array<Numbers, 64> read_{};  ///< of the samples that were read last, by our number
};

}  // namespace pliant::devices
