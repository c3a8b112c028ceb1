// A device behind shared memory (include/pliant/c/haptic_packet.h).
#pragma once
#include <cstdint>
#include <string>

#include "devices/counter.h"
#include "pliant/c/haptic_packet.h"
#include "pliant/haptic_device.h"

namespace pliant::devices {

/// Shared memory of POSIX under a name. Reading and writing it takes no system call, and therefore no thread.
class SharedDevice final : public HapticDevice {
 public:
  /// Opens /dev/shm/NAME, or creates it. `text` is the whole text of the device, for messages. Throws Error: `usage` for a name
  /// that is not of 1 to 200 letters, digits, '.', '_' and '-'; `bad_input` if the system refuses, or something else lies
  /// there.
  SharedDevice(const std::string& name, const std::string& text);
  ~SharedDevice() override;
  DeviceSample read() noexcept override;
  void write(const DeviceWrench& wrench) noexcept override;
  [[nodiscard]] DeviceCounts counts() const override { return counter_.counts(); }

 private:
  std::string path_;
  bool created_ = false;  ///< by this device, which then removes the name
  pliant_haptic_shared* shared_ = nullptr;
  Counter counter_;
  DeviceSample newest_;
  std::uint64_t sequence_ = 0;        ///< of the pose read last
  std::uint64_t senders_number_ = 0;  ///< of newest_
};

}  // namespace pliant::devices
