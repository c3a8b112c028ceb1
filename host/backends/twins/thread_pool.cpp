#include "backends/twins/thread_pool.h"

#include <algorithm>
#if defined(__x86_64__)
#include <immintrin.h>
#endif
#ifdef __linux__
#include <sched.h>
#endif

#include "backends/interface/float_environment.h"

namespace pliant::ref {
namespace {

using namespace std::chrono_literals;

/// Shorter waits are noise, and so are waits shorter than the caller's own work in the same pass.
constexpr auto kLateAtLeast = 200us;
/// After a late piece, the caller works alone for this many times the wait; the time doubles if it soon happens again.
constexpr int kAloneTimes = 8;
constexpr auto kAloneAtMost = 2s;

void relax() {
#if defined(__x86_64__)
  _mm_pause();
#else
  std::this_thread::yield();
#endif
}

/// Waits until ready(value): spins for about 20 us, the cost of a wake-up, then sleeps.
template <class T, class Ready>
void wait_until(const std::atomic<T>& value, const Ready& ready) {
  for (int i = 0; i < 500; ++i) {
    if (ready(value.load(std::memory_order_acquire))) return;
    relax();
  }
  for (T seen = value.load(std::memory_order_acquire); !ready(seen); seen = value.load(std::memory_order_acquire)) {
    value.wait(seen, std::memory_order_acquire);
  }
}

int available_threads() {
#ifdef __linux__
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
#endif
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace

ThreadPool::ThreadPool(int threads)
    : threads_(threads > 0 ? threads : available_threads()),
      tickets_(std::make_unique<Ticket[]>(static_cast<std::size_t>(threads_))) {
  for (int t = 1; t < threads_; ++t) workers_.emplace_back([this, t] { serve(t); });
}

ThreadPool::~ThreadPool() {
  stop_.store(true, std::memory_order_relaxed);
  pass_.fetch_add(1, std::memory_order_release);
  pass_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::share(Call call, const void* work) {
  const auto start = Clock::now();
  call_ = call;
  work_ = work;
  done_.store(0, std::memory_order_relaxed);
  const std::uint32_t pass = pass_.fetch_add(1, std::memory_order_release) + 1;
  pass_.notify_all();
  work_through(pass, 0);
  const auto all = [this](int done) { return done == threads_; };
  if (all(done_.load(std::memory_order_acquire))) return;
  const auto ready = Clock::now();
  wait_until(done_, all);
  note_wait(ready - start, Clock::now() - ready);
}

void ThreadPool::work_through(std::uint32_t pass, int first) {
  for (int k = 0; k < threads_; ++k) {
    const int i = (first + k) % threads_;
    // A thread that arrives after the end of a pass finds every ticket taken by that pass or a later one.
    std::uint32_t before = pass - 1;
    if (!tickets_[static_cast<std::size_t>(i)].pass.compare_exchange_strong(before, pass, std::memory_order_acq_rel)) continue;
    call_(work_, i);
    if (done_.fetch_add(1, std::memory_order_acq_rel) + 1 == threads_) done_.notify_all();
  }
}

void ThreadPool::serve(int thread) {
  const DefaultFloatEnvironment environment;
  std::uint32_t seen = 0;
  while (true) {
    wait_until(pass_, [seen](std::uint32_t pass) { return pass != seen; });
    // Load the pass first: a thread that sees the pass counted by the destructor also sees stop, and takes no piece.
    seen = pass_.load(std::memory_order_acquire);
    if (stop_.load(std::memory_order_relaxed)) return;
    work_through(seen, thread);
  }
}

void ThreadPool::note_wait(Clock::duration own, Clock::duration waited) {
  if (waited < std::max<Clock::duration>(kLateAtLeast, own)) return;
  const auto now = Clock::now();
  const bool again = now - alone_until_ < 2 * alone_;
  alone_ = std::min<Clock::duration>(again ? 2 * alone_ : kAloneTimes * waited, kAloneAtMost);
  alone_until_ = now + alone_;
}

}  // namespace pliant::ref
