// The worker thread of a World, which steps while the caller draws.
#include <pthread.h>
#include <sched.h>

#include <algorithm>

#include "api/world_impl.h"
#include "backends/choice/kernel_warmer.h"

namespace pliant {
namespace {

constexpr double kLook = 0.002;  ///< interval at which the worker looks at replacement() between frames [s]

/// Lets the thread that wakes the worker continue first: if all cores are busy, the worker would take the caller's core for
/// milliseconds. Optional, so failure is ignored.
void let_the_waker_go_on() {
#ifdef SCHED_BATCH
  const sched_param none{};
  static_cast<void>(pthread_setschedparam(pthread_self(), SCHED_BATCH, &none));
#endif
}

}  // namespace

World::Impl::~Impl() {
  {
    const std::lock_guard lock(mutex);
    stop = true;
  }
  changed.notify_all();
  if (worker.joinable()) worker.join();
  next = {};
  std::erase_if(files, [](const api::FileRequest& r) { return r.what != api::FileRequest::What::save; });
  try {
    serve_files();
  } catch (...) {  // no memory for the events
  }
  simulation.reset();
  settle_warming();
}

bool World::Impl::start_job(std::function<void()> work) {
  {
    const std::lock_guard lock(mutex);
    if (job) return false;
  }
  throw_failure();
  check_can_step();
  if (!worker.joinable()) worker = std::thread([this] { serve(); });  // may throw, with no job pending
  {
    const std::lock_guard lock(mutex);
    job = std::move(work);
  }
  beside = true;
  changed.notify_all();
  return true;
}

/// Waits until the worker is idle and has done what save(), load() and reset() left to it, and keeps it idle until let_go().
void World::Impl::hold() {
  std::unique_lock lock(mutex);
  held = true;
  changed.wait(lock, [this] { return !job && files.empty(); });
  beside = pace.running();
  show_frames(api::kAtLast);  // what the call tells is about the last
}

void World::Impl::let_go() {
  {
    const std::lock_guard lock(mutex);
    held = false;
    if (!pace.running()) return;
  }
  changed.notify_all();
}

/// Rethrows the worker's error once.
void World::Impl::throw_failure() {
  std::exception_ptr met;
  {
    const std::lock_guard lock(mutex);
    met = std::exchange(failure, nullptr);
  }
  if (met != nullptr) std::rethrow_exception(met);
}

/// Returns with a job, or to stop. A freely running World makes its own.
void World::Impl::wait_for_work(std::unique_lock<std::mutex>& lock) {
  while (!stop && !job) {
    if (may_begin()) {
      job = [this] { live_frame(); };
    } else if (pace.running() && !held && !halted) {
      const double look = next.valid() ? api::wall_time() + kLook : pace.next_start();
      changed.wait_until(lock, api::moment_of(std::min(pace.next_start(), look)));
    } else if (next.valid()) {
      changed.wait_until(lock, api::moment_of(api::wall_time() + kLook));
    } else {
      changed.wait(lock);
    }
  }
}

void World::Impl::serve() {
  let_the_waker_go_on();
  while (true) {
    std::function<void()> work;
    {
      std::unique_lock lock(mutex);
      wait_for_work(lock);
      if (stop) return;
      work = job;
    }
    std::exception_ptr met;
    try {
      work();
      if (trust.given()) read_frame();
    } catch (...) {
      met = std::current_exception();
    }
    if (met != nullptr && is_live()) tell_failure(met);
    {
      const std::lock_guard lock(mutex);
      if (met != nullptr) failure = met;
      job = nullptr;
      halted = report.diverged || !lost.empty();
    }
    changed.notify_all();
  }
}

}  // namespace pliant
