// The worker thread of a World, which steps while the caller draws.
#include <pthread.h>
#include <sched.h>

#include "api/world_impl.h"

namespace pliant {
namespace {

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

void World::Impl::wait_until_idle() {
  std::unique_lock lock(mutex);
  changed.wait(lock, [this] { return !job; });
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

void World::Impl::serve() {
  let_the_waker_go_on();
  while (true) {
    std::function<void()> work;
    {
      std::unique_lock lock(mutex);
      changed.wait(lock, [this] { return stop || job; });
      if (stop) return;
      work = job;
    }
    std::exception_ptr met;
    try {
      work();
      read_frame();
    } catch (...) {
      met = std::current_exception();
    }
    {
      const std::lock_guard lock(mutex);
      failure = met;
      job = nullptr;
    }
    changed.notify_all();
  }
}

}  // namespace pliant
