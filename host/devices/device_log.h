// The samples of a device, for a file that the device file:STROKE.csv plays again.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "pliant/haptic_device.h"

namespace pliant::devices {

/// Memory for a fixed number of samples, which one thread appends to, in constant time and without allocating, while any
/// thread reads the samples so far. When it is full, further samples are left out and counted.
class DeviceLog {
 public:
  /// 80 bytes a sample: 600,000 are ten minutes of a device at 1000 Hz. Throws Error `usage` unless `most` is 1 to 100 million.
  explicit DeviceLog(std::size_t most = 600000);
  void append(const DeviceSample& sample) noexcept;
  /// The samples so far. They stay valid and unchanged while the log lives.
  [[nodiscard]] std::span<const DeviceSample> samples() const noexcept;
  [[nodiscard]] std::uint64_t left_out() const noexcept { return left_out_.load(std::memory_order_relaxed); }
  /// Writes the samples so far as a stroke (write_stroke). A sample whose time is not after that of the one before it is
  /// left out: clocks of devices may jump, a stroke cannot.
  void write_csv(const std::filesystem::path& file) const;

 private:
  std::vector<DeviceSample> samples_;
  std::atomic<std::size_t> count_{0};
  std::atomic<std::uint64_t> left_out_{0};
};

/// A device whose every sample goes into a log when read() returns it for the first time: what its user has seen.
class RecordedDevice final : public HapticDevice {
 public:
  RecordedDevice(std::shared_ptr<HapticDevice> device, std::shared_ptr<DeviceLog> log);
  DeviceSample read() noexcept override;
  void write(const DeviceWrench& wrench) noexcept override { device_->write(wrench); }
  [[nodiscard]] DeviceLimits limits() const noexcept override { return device_->limits(); }
  [[nodiscard]] DeviceCounts counts() const override { return device_->counts(); }
  [[nodiscard]] int port() const noexcept override { return device_->port(); }

 private:
  std::shared_ptr<HapticDevice> device_;
  std::shared_ptr<DeviceLog> log_;
  std::uint64_t newest_ = 0;
};

}  // namespace pliant::devices
