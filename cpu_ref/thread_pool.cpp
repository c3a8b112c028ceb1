#include "thread_pool.h"

#include <algorithm>
#if defined(__x86_64__)
#include <immintrin.h>
#endif
#ifdef __linux__
#include <sched.h>
#endif

#include "backend/float_environment.h"

namespace pliant::ref {
namespace {

void relax() {
#if defined(__x86_64__)
  _mm_pause();
#else
  std::this_thread::yield();
#endif
}

/// Waits until `value` is no longer `old`: some 20 us of spinning, about the price of being woken, then sleep.
void wait_change(const std::atomic<std::uint32_t>& value, std::uint32_t old) {
  for (int i = 0; i < 500; ++i) {
    if (value.load(std::memory_order_acquire) != old) return;
    relax();
  }
  while (value.load(std::memory_order_acquire) == old) value.wait(old, std::memory_order_acquire);
}

int available_threads() {
#ifdef __linux__
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
#endif
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace

void Barrier::arrive_and_wait() {
  const std::uint32_t phase = phase_.load(std::memory_order_acquire);
  if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == threads_) {
    arrived_.store(0, std::memory_order_relaxed);
    phase_.store(phase + 1, std::memory_order_release);
    phase_.notify_all();
  } else {
    wait_change(phase_, phase);
  }
}

ThreadPool::ThreadPool(int threads)
    : threads_(threads > 0 ? threads : available_threads()), barrier_(threads_), finished_(threads_) {
  for (int t = 1; t < threads_; ++t) workers_.emplace_back([this, t] { serve(t); });
}

ThreadPool::~ThreadPool() {
  stop_.store(true, std::memory_order_relaxed);
  job_.fetch_add(1, std::memory_order_release);
  job_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::run(const std::function<void(int)>& work) {
  const DefaultFloatEnvironment environment;
  if (threads_ == 1) {
    work(0);
    return;
  }
  work_ = &work;
  job_.fetch_add(1, std::memory_order_release);
  job_.notify_all();
  work(0);
  finished_.arrive_and_wait();
}

void ThreadPool::serve(int thread) {
  const DefaultFloatEnvironment environment;
  std::uint32_t seen = 0;
  while (true) {
    wait_change(job_, seen);
    ++seen;
    if (stop_.load(std::memory_order_relaxed)) return;
    (*work_)(thread);
    finished_.arrive_and_wait();
  }
}

}  // namespace pliant::ref
