// The thread of a World that steps while its caller draws.
#include "api/world_impl.h"

namespace pliant {

World::Impl::~Impl() {
  {
    const std::lock_guard lock(mutex);
    stop = true;
  }
  changed.notify_all();
  if (worker.joinable()) worker.join();
}

bool World::Impl::start_job(std::int64_t steps) {
  {
    const std::lock_guard lock(mutex);
    if (job >= 0) return false;
  }
  throw_failure();
  check_can_step();
  if (!worker.joinable()) worker = std::thread([this] { serve(); });  // may fail: no job is pending then
  {
    const std::lock_guard lock(mutex);
    job = steps;
  }
  changed.notify_all();
  return true;
}

void World::Impl::wait_until_idle() {
  std::unique_lock lock(mutex);
  changed.wait(lock, [this] { return job < 0; });
}

/// What the worker met is told once.
void World::Impl::throw_failure() {
  std::exception_ptr met;
  {
    const std::lock_guard lock(mutex);
    met = std::exchange(failure, nullptr);
  }
  if (met != nullptr) std::rethrow_exception(met);
}

void World::Impl::serve() {
  while (true) {
    std::int64_t steps = 0;
    {
      std::unique_lock lock(mutex);
      changed.wait(lock, [this] { return stop || job >= 0; });
      if (stop) return;
      steps = job;
    }
    std::exception_ptr met;
    try {
      run(steps);
      read_frame();
    } catch (...) {
      met = std::current_exception();
    }
    {
      const std::lock_guard lock(mutex);
      failure = met;
      job = -1;
    }
    changed.notify_all();
  }
}

}  // namespace pliant
