// A recorded stroke as a device: it moves by itself.
#pragma once
#include <chrono>
#include <filesystem>
#include <optional>
#include <vector>

#include "pliant/haptic_device.h"

namespace pliant::devices {

/// Plays in wall time from the first read() on: each read() returns the last sample whose time has come, with the bits of the
/// file; after the end, the last one. After step_by_answers() time does not count: each sample is there until write() has
/// answered it. Wrenches are not felt by anybody. Needs no thread: the stroke lies in memory.
class StrokeDevice final : public HapticDevice {
 public:
  /// At least one sample, times increasing.
  explicit StrokeDevice(std::vector<DeviceSample> samples) : samples_(std::move(samples)) {}
  DeviceSample read() noexcept override;
  void write(const DeviceWrench& wrench) noexcept override;
  [[nodiscard]] DeviceCounts counts() const override { return {samples_.size(), 0, ""}; }
  /// The sample after `seconds` of playing.
  [[nodiscard]] const DeviceSample& after(double seconds) const noexcept;
  /// Call before the first read().
  void step_by_answers() noexcept { by_answers_ = true; }
  /// Whether all samples are answered, which they only are after step_by_answers().
  [[nodiscard]] bool ended() const noexcept { return answered_ == samples_.size(); }

 private:
  std::vector<DeviceSample> samples_;
  bool by_answers_ = false;
  std::size_t answered_ = 0;  ///< samples
  std::optional<std::chrono::steady_clock::time_point> began_;
};

}  // namespace pliant::devices
