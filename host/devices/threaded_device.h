// What devices with a thread of their own share: the thread waits for the network, the haptic thread never does.
#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <thread>

#include "devices/counter.h"
#include "devices/file_handle.h"
#include "devices/mailbox.h"
#include "pliant/haptic_device.h"

namespace pliant::devices {

/// read() takes from a mailbox, write() fills another, and the thread reads it at its own times: to wake a thread would
/// let it run before the caller on a machine without a free core. A derived class calls start() at the end of its constructor
/// and stop() at the beginning of its destructor.
class ThreadedDevice : public HapticDevice {
 public:
  ~ThreadedDevice() override;
  DeviceSample read() noexcept override;
  void write(const DeviceWrench& wrench) noexcept override;
  [[nodiscard]] DeviceCounts counts() const final { return counter_.counts(); }

 protected:
  ThreadedDevice();
  void start();
  void stop() noexcept;

  // For the thread.

  /// Runs in the thread until stopping(). An exception ends the thread and counts as a rejected sample.
  virtual void serve() = 0;
  /// Called by stop(), in its thread, if serve() waits for something else than stop_handle().
  virtual void wake() noexcept;
  [[nodiscard]] bool stopping() const { return stopping_.load(std::memory_order_acquire); }
  /// Readable once stopping(); wait for it with poll().
  [[nodiscard]] int stop_handle() const { return stop_.get(); }
  /// Gives a sample its number, and for kNoTime, elapsed().
  void count(DeviceSample& sample);
  /// Counts a sample and publishes it. Returns its number.
  std::uint64_t publish(DeviceSample sample);
  void refuse(Refusal why) { counter_.refuse(why); }
  /// The newest wrench if there is one that was not taken yet and that answers a sample.
  std::optional<DeviceWrench> newest_wrench();
  /// Seconds since the device was opened.
  [[nodiscard]] double elapsed() const;

 private:
  void run() noexcept;

  Mailbox<DeviceSample> samples_;
  Mailbox<DeviceWrench> wrenches_;
  Counter counter_;
  FileHandle stop_;
  std::atomic<bool> stopping_{false};
  std::chrono::steady_clock::time_point opened_ = std::chrono::steady_clock::now();
  std::thread thread_;
};

}  // namespace pliant::devices
