// The device that a program moves: mailboxes from its threads to the loop and back.
#include <fmt/format.h>

#include <chrono>
#include <mutex>

#include "devices/counter.h"
#include "devices/limits.h"
#include "devices/mailbox.h"
#include "pliant/error.h"
#include "pliant/haptic_device.h"

namespace pliant {

struct ManualDevice::Impl {
  DeviceLimits limits;
  devices::Counter counter;
  devices::Mailbox<DeviceSample> samples;
  devices::Mailbox<DeviceWrench> wrenches;
  std::mutex mutex;  ///< of the program's threads: each mailbox has one writer and one reader at a time
  std::chrono::steady_clock::time_point made = std::chrono::steady_clock::now();
};

ManualDevice::ManualDevice(const DeviceLimits& limits) : impl_(std::make_unique<Impl>()) {
  devices::check_limits(limits);
  impl_->limits = limits;
}

ManualDevice::~ManualDevice() = default;

void ManualDevice::set_pose(const Vec3d& position, const std::array<double, 4>& turn, std::uint32_t buttons) {
  const std::lock_guard lock(impl_->mutex);
  const double time = std::chrono::duration<double>(std::chrono::steady_clock::now() - impl_->made).count();
  DeviceSample sample{position, turn, time, buttons, 0};
  if (const devices::Refusal why = devices::check_sample(sample); why != nullptr) {
    impl_->counter.refuse(why);
    throw Error(ErrorCode::usage, fmt::format("set_pose: got {}", why));
  }
  sample.number = impl_->counter.receive();
  impl_->samples.publish(sample);
}

DeviceWrench ManualDevice::wrench() const {
  const std::lock_guard lock(impl_->mutex);
  impl_->wrenches.take();
  return impl_->wrenches.newest();
}

DeviceSample ManualDevice::read() noexcept {
  impl_->samples.take();
  return impl_->samples.newest();
}

void ManualDevice::write(const DeviceWrench& wrench) noexcept { impl_->wrenches.publish(wrench); }

DeviceLimits ManualDevice::limits() const noexcept { return impl_->limits; }

DeviceCounts ManualDevice::counts() const { return impl_->counter.counts(); }

}  // namespace pliant
