// Counts of the samples that a device has received and rejected, updated by one thread and read by any.
#pragma once
#include <atomic>
#include <cstdint>

#include "devices/check_sample.h"
#include "pliant/haptic_device.h"

namespace pliant::devices {

class Counter {
 public:
  /// Counts a sample and returns how many there are now.
  std::uint64_t receive() { return received_.fetch_add(1, std::memory_order_relaxed) + 1; }
  void refuse(Refusal why) {
    last_.store(why, std::memory_order_relaxed);
    refused_.fetch_add(1, std::memory_order_release);
  }
  [[nodiscard]] DeviceCounts counts() const {
    DeviceCounts counts;
    counts.refused = refused_.load(std::memory_order_acquire);
    counts.received = received_.load(std::memory_order_relaxed);
    if (const Refusal last = last_.load(std::memory_order_relaxed); last != nullptr) counts.last_refusal = last;
    return counts;
  }

 private:
  std::atomic<std::uint64_t> received_{0}, refused_{0};
  std::atomic<Refusal> last_{nullptr};
};

}  // namespace pliant::devices
