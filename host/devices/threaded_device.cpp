#include "devices/threaded_device.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include "pliant/error.h"

namespace pliant::devices {

ThreadedDevice::ThreadedDevice() : stop_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (!stop_) throw Error(ErrorCode::bad_input, "haptic device: the system has no more file handles");
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

void ThreadedDevice::write(const DeviceWrench& wrench) noexcept { wrenches_.publish(wrench); }

void ThreadedDevice::wake() noexcept {
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(stop_.get(), &one, sizeof one);  // fails only if it is readable already
}

void ThreadedDevice::count(DeviceSample& sample) {
  if (sample.time == kNoTime) {
    sample.time = elapsed();
    sample.dated = false;
  }
  sample.number = counter_.receive();
}

std::uint64_t ThreadedDevice::publish(DeviceSample sample) {
  count(sample);
  samples_.publish(sample);
  return sample.number;
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
