// A lock-free queue from one thread to another, of fixed size: when it is full, new values are left out and counted.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pliant::devices {

template <class T>
class SampleQueue {
 public:
  explicit SampleQueue(std::size_t size) : slots_(size) {}
  /// Returns false if there is no room.
  bool push(const T& value) noexcept {
    const std::uint64_t end = end_.load(std::memory_order_relaxed);
    if (end - begin_.load(std::memory_order_acquire) == slots_.size()) return false;
    slots_[end % slots_.size()] = value;
    end_.store(end + 1, std::memory_order_release);
    return true;
  }
  bool pop(T& value) noexcept {
    const std::uint64_t begin = begin_.load(std::memory_order_relaxed);
    if (begin == end_.load(std::memory_order_acquire)) return false;
    value = slots_[begin % slots_.size()];
    begin_.store(begin + 1, std::memory_order_release);
    return true;
  }

 private:
  std::vector<T> slots_;
  alignas(64) std::atomic<std::uint64_t> begin_{0};
  alignas(64) std::atomic<std::uint64_t> end_{0};
};

}  // namespace pliant::devices
