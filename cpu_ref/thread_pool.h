// A few persistent threads that work through a batch together. Which thread does what depends on the counts only.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

namespace pliant::ref {

/// Every thread must arrive before any goes on. Spins briefly, then sleeps.
class Barrier {
 public:
  explicit Barrier(int threads) : threads_(threads) {}
  void arrive_and_wait();

 private:
  const int threads_;
  std::atomic<int> arrived_{0};
  std::atomic<std::uint32_t> phase_{0};
};

class ThreadPool {
 public:
  /// The calling thread is one of them; 0 means as many as the process may use.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  [[nodiscard]] int threads() const { return threads_; }
  /// work(thread) on every thread, with the default floating-point environment; returns when all are done.
  /// `work` must not throw. Threads may meet at barrier().
  void run(const std::function<void(int)>& work);
  Barrier& barrier() { return barrier_; }

 private:
  void serve(int thread);
  const int threads_;
  Barrier barrier_, finished_;
  std::atomic<std::uint32_t> job_{0};
  std::atomic<bool> stop_{false};
  const std::function<void(int)>* work_ = nullptr;
  std::vector<std::thread> workers_;
};

}  // namespace pliant::ref
