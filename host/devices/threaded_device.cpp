#include "devices/threaded_device.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include "pliant/error.h"

namespace pliant::devices {

ThreadedDevice::ThreadedDevice(bool woken_by_write)
    : wake_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)), woken_by_write_(woken_by_write) {
  if (!wake_) throw Error(ErrorCode::bad_input, "haptic device: the system has no more file handles");
}

ThreadedDevice::~ThreadedDevice() { stop(); }

void ThreadedDevice::start() { thread_ = std::thread(&ThreadedDevice::run, this); }

void ThreadedDevice::stop() noexcept {
  if (!thread_.joinable()) return;
  stopping_.store(true, std::memory_order_release);
  wake();
  thread_.join();
}

void ThreadedDevice::run() noexcept {
  try {
    serve();
  } catch (...) {
    refuse("the thread of the device has ended");
  }
}

DeviceSample ThreadedDevice::read() noexcept {
  samples_.take();
  return samples_.newest();
}

void ThreadedDevice::write(const DeviceWrench& wrench) noexcept {
  wrenches_.publish(wrench);
  if (woken_by_write_ && !woken_.exchange(true, std::memory_order_acq_rel)) wake();
}

void ThreadedDevice::wake() noexcept {
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(wake_.get(), &one, sizeof one);  // fails only if it is readable already
}

void ThreadedDevice::awake() {
  std::uint64_t count = 0;
  [[maybe_unused]] const auto got = ::read(wake_.get(), &count, sizeof count);
  woken_.exchange(false, std::memory_order_acq_rel);
}

void ThreadedDevice::count(DeviceSample& sample) {
  if (sample.time == 0) sample.time = elapsed();
  sample.number = counter_.receive();
}

void ThreadedDevice::publish(DeviceSample sample) {
  count(sample);
  samples_.publish(sample);
}

std::optional<DeviceWrench> ThreadedDevice::newest_wrench() {
  if (!wrenches_.take()) return std::nullopt;
  if (wrenches_.newest().number == 0) return std::nullopt;
  return wrenches_.newest();
}

double ThreadedDevice::elapsed() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - opened_).count();
}

}  // namespace pliant::devices
