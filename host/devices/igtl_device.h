// A device at the other end of OpenIGTLink, for which this is the server.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "devices/igtl.h"
#include "devices/listen.h"
#include "devices/threaded_device.h"

namespace pliant::devices {

/// Serves one client at a time: a new one takes the place of the one before.
class IgtlDevice final : public ThreadedDevice {
 public:
  /// `place` as in listen_at; `text` is the whole text of the device, for messages.
  IgtlDevice(const std::string& place, const std::string& text);
  ~IgtlDevice() override { stop(); }
  [[nodiscard]] int port() const noexcept override { return listening_.port; }

 private:
  void serve() override;
  void welcome();
  void receive();
  void send();

  Listening listening_;
  FileHandle client_;
  IgtlStream stream_;
  std::array<std::uint8_t, 65536> bytes_{};
  std::array<std::uint8_t, kIgtlWrenchSize> sending_{};
  std::size_t sent_ = kIgtlWrenchSize;  ///< bytes of sending_ that are on their way
};

}  // namespace pliant::devices
