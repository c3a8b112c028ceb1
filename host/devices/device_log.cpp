#include "devices/device_log.h"

#include <fmt/format.h>

#include "devices/check_sample.h"
#include "devices/stroke.h"
#include "pliant/error.h"

namespace pliant::devices {

DeviceLog::DeviceLog(std::size_t most) {
  if (most < 1 || most > 100000000) {
    throw Error(ErrorCode::usage, fmt::format("DeviceLog: the number of samples is {}, expected 1 to 100000000", most));
  }
  samples_.resize(most);
}

void DeviceLog::append(const DeviceSample& sample) noexcept {
  const std::size_t count = count_.load(std::memory_order_relaxed);
  if (count == samples_.size()) {
    left_out_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  samples_[count] = sample;
  count_.store(count + 1, std::memory_order_release);
}

std::span<const DeviceSample> DeviceLog::samples() const noexcept {
  return {samples_.data(), count_.load(std::memory_order_acquire)};
}

void DeviceLog::write_csv(const std::filesystem::path& file) const {
  std::vector<DeviceSample> stroke;
  for (const DeviceSample& sample : samples()) {
    if (stroke.empty() || sample.time > stroke.back().time) stroke.push_back(sample);
  }
  write_stroke(file, stroke);
}

RecordedDevice::RecordedDevice(std::shared_ptr<HapticDevice> device, std::shared_ptr<DeviceLog> log)
    : device_(std::move(device)), log_(std::move(log)) {
  if (!device_ || !log_) throw Error(ErrorCode::usage, "RecordedDevice: got a null pointer, expected a device and a log");
}

DeviceSample RecordedDevice::read() noexcept {
  const DeviceSample sample = device_->read();
  DeviceSample checked = sample;  // a stroke has no place for what is no pose
  if (sample.number != newest_ && check_sample(checked) == nullptr) log_->append(sample);
  newest_ = sample.number;
  return sample;
}

}  // namespace pliant::devices
