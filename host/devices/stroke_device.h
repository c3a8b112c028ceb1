// A recorded stroke as a device: it moves by itself.
#pragma once
#include <chrono>
#include <filesystem>
#include <optional>
#include <vector>

#include "pliant/haptic_device.h"

namespace pliant::devices {

/// Plays in wall time from the first read() on: each read() returns the last sample whose time has come, with the bits of the
/// file; after the end, the last one. Wrenches are not felt by anybody. Needs no thread: the stroke lies in memory.
class StrokeDevice final : public HapticDevice {
 public:
  /// At least one sample, times increasing.
  explicit StrokeDevice(std::vector<DeviceSample> samples) : samples_(std::move(samples)) {}
  DeviceSample read() noexcept override;
  void write(const DeviceWrench& /*wrench*/) noexcept override {}
  [[nodiscard]] DeviceCounts counts() const override { return {samples_.size(), 0, ""}; }
  /// The sample after `seconds` of playing.
  [[nodiscard]] const DeviceSample& after(double seconds) const noexcept;

 private:
  std::vector<DeviceSample> samples_;
  std::optional<std::chrono::steady_clock::time_point> began_;
};

}  // namespace pliant::devices
