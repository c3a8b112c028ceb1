// A World that runs freely, paced by the wall clock.
#include <fmt/format.h>

#include <chrono>

#include "api/world_call.h"

namespace pliant {
namespace {

constexpr double kAsks = 0.02;  ///< longest wait for a call [s]

/// A call that has waited for a load or reset asks for something of the first step: lets it end before there is one.
void let_the_caller_ask(const World::Impl& world) {
  const double end = api::wall_time() + kAsks;
  while (world.in_use && api::wall_time() < end) {
    {
      const std::lock_guard lock(world.mutex);
      if (world.held) return;  // it waits for the worker
    }
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
}

}  // namespace

bool World::Impl::is_live() const {
  const std::lock_guard lock(mutex);
  return pace.running();
}

void World::Impl::check_not_live(const char* call) const {
  if (is_live()) throw Error(ErrorCode::state, fmt::format("{}: the World runs freely; stop_live() ends that", call));
}

bool World::Impl::may_begin() const {
  if (!pace.running()) return false;
  const bool frame = !held && !halted && api::wall_time() >= pace.next_start();
  const bool waits = next.valid() && !held && next.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
  return frame || (!files.empty() && !waits);
}

void World::Impl::run_live(const LiveOptions& live) {
  api::check_live(live);
  {
    const std::lock_guard lock(mutex);
    if (pace.running()) {
      pace.change(live, api::wall_time());
      show_frames(api::kAtLast);
      changed.notify_all();
      return;
    }
    if (job) throw Error(ErrorCode::state, "run_live: the worker is busy with steps; wait() waits for them");
  }
  throw_failure();
  check_can_step();
  if (!worker.joinable()) worker = std::thread([this] { serve(); });
  beside = true;
  seconds_left = 0;
  {
    const std::lock_guard lock(mutex);
    halted = false;
    pace.start(live, api::wall_time());
  }
  changed.notify_all();
}

void World::Impl::stop_live() {
  {
    const std::lock_guard lock(mutex);
    pace.stop();
    show_frames(api::kAtLast);
    trust.tell_all();
  }
  beside = false;
}

void World::Impl::look_for_events() {
  events.look(*simulation);
  for (const api::SurfaceHandles::Limit& limit : handles->limits()) {
    const std::string grab = std::to_string(limit.grab);
    const std::string text =
        fmt::format("grab {} has reached its greatest force, {:.3g} N, and may not arrive", grab, limit.force);
    events.add(*simulation, api::event_of("limited", grab, limit.force, text, limit.position));
  }
}

void World::Impl::make_changes(bool wait) {
  const double start = api::wall_time();
  const bool live = is_live();
  const auto attempt = [&](auto&& make) {
    try {
      make();
    } catch (const api::Refused& refused) {
      if (!live) throw;
      events.add(*simulation, api::event_of("refused", refused.subject, 0, refused.what()));
    }
  };
  simulation->edits().build_beside(live && !wait);
  attempt([this, wait, live] { take_up_edit(wait || !live); });
  attempt([this] { cut_pending(); });
  attempt([this] { change_pending(); });
  attempt([this] { change_tools_now(); });
  editing += api::wall_time() - start;
}

void World::Impl::note_batch() {
  trust.look(*simulation, is_live());
  if (!trust.given()) return;
  rigid_tools.note(*simulation);
  force_blades.note(*simulation);
  look_for_events();
}

void World::Impl::tell_failure(const std::exception_ptr& met) {
  try {
    std::rethrow_exception(met);
  } catch (const std::exception& error) {
    events.add(*simulation, api::event_of("failed", {}, 0, error.what()));
  }
}

void World::Impl::live_frame() {
  const std::shared_ptr<Simulation> before_files = simulation;
  serve_files();
  if (simulation != before_files) let_the_caller_ask(*this);
  double covers = 0;
  {
    const std::lock_guard lock(mutex);
    if (held || halted || !pace.running() || api::wall_time() < pace.next_start()) return;
    covers = pace.begin(api::wall_time());
  }
  const double before = simulation->time();
  editing = 0;
  advance_frame(covers);
  const double stepped = api::wall_time();
  if (trust.given()) read_frame();
  const double now = api::wall_time();
  const std::lock_guard lock(mutex);
  pace.end(now, simulation->time() - before, editing, now - stepped);
}

void World::run_live(const LiveOptions& options) {
  const api::Call call(impl_, false);
  impl_->run_live(options);
}

StepReport World::stop_live() {
  const api::Call call(impl_);
  impl_->stop_live();
  if (impl_->lost.empty()) impl_->end_edit();
  impl_->throw_failure();
  const std::lock_guard lock(impl_->mutex);
  return impl_->report;
}

LiveState World::live_state() const {
  const api::Call call(impl_, false);
  const std::lock_guard lock(impl_->mutex);
  return impl_->pace.state();
}

std::vector<Event> World::events() {
  const api::Call call(impl_, false);
  return impl_->events.take();
}

std::vector<ForceSample> World::force_trace(const std::string& tool, std::int64_t after) const {
  const api::Call call(impl_, false);
  return impl_->trust.told(impl_->rigid_tools.trace(tool, after));
}

std::vector<ForceSample> World::force_trace(GrabId grab, std::int64_t after) const {
  const api::Call call(impl_, false);
  return impl_->trust.told(impl_->handles->trace(grab, after));
}

}  // namespace pliant
