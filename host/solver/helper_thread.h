// A thread that waits for work: starting one for each piece of work, with a memory allocator that knows nothing yet, takes
// longer than small pieces do.
#pragma once
#include <condition_variable>
#include <functional>
#include <future>
#include <mutex>
#include <thread>
#include <utility>

namespace pliant {

class HelperThread {
 public:
  HelperThread() : thread_([this] { work(); }) {}
  HelperThread(const HelperThread&) = delete;
  HelperThread& operator=(const HelperThread&) = delete;
  /// Finishes what it was given.
  ~HelperThread() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }

  /// What the future's get() throws is what `job` threw. One job at a time; whoever gives it waits for it before it goes out of
  /// scope.
  [[nodiscard]] std::future<void> run(std::function<void()> job) {
    std::packaged_task<void()> task(std::move(job));
    std::future<void> done = task.get_future();
    {
      const std::lock_guard lock(mutex_);
      task_ = std::move(task);
    }
    wake_.notify_one();
    return done;
  }

 private:
  void work() {
    std::unique_lock lock(mutex_);
    while (true) {
      wake_.wait(lock, [this] { return stop_ || task_.valid(); });
      if (!task_.valid()) return;
      std::packaged_task<void()> task = std::exchange(task_, {});
      lock.unlock();
      task();
      lock.lock();
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_;
  std::packaged_task<void()> task_;
  bool stop_ = false;
  std::thread thread_;
};

/// Waits, whatever happens.
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
