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

/// read() takes from a mailbox; write() fills another and, if the thread sleeps and has asked for that, wakes it by one system
/// call that never waits. On a machine without a free core, this call lets the thread run first: where that matters, the thread
/// looks into the mailbox by itself. A derived class calls start() at the end of its constructor and stop() at the beginning of
/// its destructor.
class ThreadedDevice : public HapticDevice {
 public:
  ~ThreadedDevice() override;
  DeviceSample read() noexcept override;
  void write(const DeviceWrench& wrench) noexcept override;
  [[nodiscard]] DeviceCounts counts() const final { return counter_.counts(); }

 protected:
  explicit ThreadedDevice(bool woken_by_write = true);
  void start();
  void stop() noexcept;

  // For the thread.

  /// Runs in the thread until stopping(). What it throws ends the thread and counts as a refusal.
  virtual void serve() = 0;
  /// Called in the calling thread by stop() and write(), if the thread waits for something else than wake_handle().
  virtual void wake() noexcept;
  [[nodiscard]] bool stopping() const { return stopping_.load(std::memory_order_acquire); }
  /// Readable after a write() or a stop(); wait for it with poll().
  [[nodiscard]] int wake_handle() const { return wake_.get(); }
  /// Makes wake_handle() wait again. Call it before newest_wrench().
  void awake();
  /// Gives a sample its number, and for a time of 0, elapsed().
  void count(DeviceSample& sample);
  /// Counts a sample and publishes it.
  void publish(DeviceSample sample);
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
  FileHandle wake_;
  const bool woken_by_write_;
  std::atomic<bool> woken_{false}, stopping_{false};
  std::chrono::steady_clock::time_point opened_ = std::chrono::steady_clock::now();
  std::thread thread_;
};

}  // namespace pliant::devices
