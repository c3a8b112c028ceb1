#include "devices/stroke_device.h"

#include <algorithm>

namespace pliant::devices {

const DeviceSample& StrokeDevice::after(double seconds) const noexcept {
  const double time = samples_.front().time + seconds;
  const auto later = [](double t, const DeviceSample& sample) { return t < sample.time; };
  const auto next = std::upper_bound(samples_.begin() + 1, samples_.end(), time, later);
  return *(next - 1);
}

DeviceSample StrokeDevice::read() noexcept {
  if (by_answers_) return samples_[std::min(answered_, samples_.size() - 1)];
  const auto now = std::chrono::steady_clock::now();
  if (!began_) began_ = now;
  return after(std::chrono::duration<double>(now - *began_).count());
}

void StrokeDevice::write(const DeviceWrench& wrench) noexcept {
  if (by_answers_ && !ended() && wrench.number == samples_[answered_].number) ++answered_;
}

}  // namespace pliant::devices
