// A persistent worker thread. Starting a thread for each piece of work, with a fresh allocator arena, takes longer than small
// pieces of work do.
#pragma once
#include <chrono>
#include <condition_variable>
#include <functional>
#include <future>
#include <mutex>
#include <queue>
#include <thread>
#include <utility>

namespace pliant {

class HelperThread {
 public:
  HelperThread() : thread_([this] { work(); }) {}
  HelperThread(const HelperThread&) = delete;
  HelperThread& operator=(const HelperThread&) = delete;
  /// Completes all submitted work.
  ~HelperThread() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }

  /// Submits a job. The future's get() rethrows what `job` threw. Jobs run in order; the caller must wait for the future
  /// before anything that the job uses goes out of scope.
  [[nodiscard]] std::future<void> run(std::function<void()> job) {
    std::packaged_task<void()> task(std::move(job));
    std::future<void> done = task.get_future();
    {
      const std::lock_guard lock(mutex_);
      tasks_.push(std::move(task));
    }
    wake_.notify_one();
    return done;
  }

 private:
  void work() {
    std::unique_lock lock(mutex_);
    while (true) {
      wake_.wait(lock, [this] { return stop_ || !tasks_.empty(); });
      if (tasks_.empty()) return;
      std::packaged_task<void()> task = std::move(tasks_.front());
      tasks_.pop();
      lock.unlock();
      task();
      lock.lock();
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_;
  std::queue<std::packaged_task<void()>> tasks_;
  bool stop_ = false;
  std::thread thread_;
};

/// future.get() for work that is nearly done: waits actively, because waking a sleeping thread takes up to 0.1 ms on a
/// virtual machine.
inline void get_soon(std::future<void>& future) {
  constexpr std::chrono::milliseconds kLongest{2};
  const auto end = std::chrono::steady_clock::now() + kLongest;
  while (future.wait_for(std::chrono::seconds(0)) != std::future_status::ready && std::chrono::steady_clock::now() < end) {
    std::this_thread::yield();
  }
  future.get();
}

/// Waits for a future on destruction.
class WaitFor {
 public:
  explicit WaitFor(std::future<void>& future) : future_(future) {}
  WaitFor(const WaitFor&) = delete;
  WaitFor& operator=(const WaitFor&) = delete;
  ~WaitFor() {
    if (future_.valid()) future_.wait();
  }

 private:
  std::future<void>& future_;
};

}  // namespace pliant
