// Free running, events and force traces of the C API.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "api/c_call.h"
#include "api/event_log.h"
#include "geometry/wrench.h"

namespace {

using namespace pliant::api;

pliant_force_sample sample_of(const pliant::ForceSample& given) {
  pliant_force_sample sample{};
  sample.step = given.step;
  sample.time = given.time;
  copy_wrench(given, sample);
  return sample;
}

void give_trace(const std::vector<pliant::ForceSample>& trace, pliant_force_sample* out, std::size_t count,
                std::size_t* needed) {
  if (needed != nullptr) *needed = trace.size();
  for (std::size_t i = 0; i < std::min(count, trace.size()); ++i) give_struct(sample_of(trace[i]), element(out, i));
}

}  // namespace

pliant_status pliant_world_run_live(pliant_world world, const pliant_live_options* options) {
  return on(world, [&](CWorld& w) {
    pliant_live_options live = PLIANT_LIVE_OPTIONS_INIT;
    if (options != nullptr) live = take_struct<pliant_live_options>(*options, live);
    if (live.reserved != 0)
      throw pliant::Error(pliant::ErrorCode::usage,
                          fmt::format("pliant_live_options::reserved is {}; 0 is allowed", live.reserved));
    w.world.run_live({live.rate, live.speed, live.ahead});
  });
}

pliant_status pliant_world_stop_live(pliant_world world, pliant_report* out) {
  return on(world, [&](CWorld& w) {
    check_struct(out);
    give_report(w.world.stop_live(), out);
  });
}

pliant_status pliant_world_live_state(pliant_world world, pliant_live_state* out) {
  return on(world, [&](CWorld& w) {
    need(out, "out");
    check_struct(out);
    const pliant::LiveState s = w.world.live_state();
    give_struct<pliant_live_state>({0, s.running ? 1 : 0, 0, s.frames, s.late, s.dropped, s.real_time, s.load, s.lost}, out);
  });
}

pliant_status pliant_world_events(pliant_world world, pliant_event* out, size_t count, size_t* given) {
  return on(world, [&](CWorld& w) {
    need(given, "given");
    check_array(out, count, "pliant_event");
    std::vector<pliant::Event> fresh = w.world.events();
    const std::lock_guard lock(w.mutex);
    std::move(fresh.begin(), fresh.end(), std::back_inserter(w.waiting_events));
    while (w.waiting_events.size() > EventLog::kMost) w.waiting_events.pop_front();
    const auto end = w.waiting_events.begin() + static_cast<std::ptrdiff_t>(std::min(count, w.waiting_events.size()));
    w.events.assign(std::make_move_iterator(w.waiting_events.begin()), std::make_move_iterator(end));
    w.waiting_events.erase(w.waiting_events.begin(), end);
    *given = w.events.size();
    for (std::size_t i = 0; i < w.events.size(); ++i) {
      const pliant::Event& e = w.events[i];
      pliant_event event{};
      event.kind = e.kind.c_str();
      event.subject = e.subject.c_str();
      event.text = e.text.c_str();
      event.step = e.step;
      event.time = e.time;
      std::copy(e.position.begin(), e.position.end(), event.position);
      event.amount = e.amount;
      event.placed = e.placed ? 1 : 0;
      give_struct(event, element(out, i));
    }
  });
}

pliant_status pliant_world_cut_attempts(pliant_world world, pliant_cut_attempt* out, size_t count, size_t* given) {
  return on(world, [&](CWorld& w) {
    need(given, "given");
    check_array(out, count, "pliant_cut_attempt");
    const std::vector<pliant::CutAttempt> fresh = w.world.cut_attempts();
    const std::lock_guard lock(w.mutex);
    w.waiting_attempts.insert(w.waiting_attempts.end(), fresh.begin(), fresh.end());
    while (w.waiting_attempts.size() > EventLog::kMost) w.waiting_attempts.pop_front();
    *given = std::min(count, w.waiting_attempts.size());
    for (std::size_t i = 0; i < *given; ++i) {
      const pliant::CutAttempt& a = w.waiting_attempts.front();
      pliant_cut_attempt attempt{};
      attempt.blade = w.names.insert(a.blade).first->c_str();
      attempt.body = w.names.insert(a.body).first->c_str();
      attempt.stroke = a.stroke;
      attempt.time = a.time;
      std::copy(a.position.begin(), a.position.end(), attempt.position);
      std::copy(a.rest.begin(), a.rest.end(), attempt.rest);
      attempt.from = a.from;
      attempt.to = a.to;
      attempt.gave_way = a.gave_way ? 1 : 0;
      give_struct(attempt, element(out, i));
      w.waiting_attempts.pop_front();
    }
  });
}

pliant_status pliant_world_force_trace(pliant_world world, const char* tool, int64_t after, pliant_force_sample* out,
                                       size_t count, size_t* needed) {
  return on(world, [&](CWorld& w) {
    need(tool, "tool");
    check_array(out, count, "pliant_force_sample");
    give_trace(w.world.force_trace(std::string(tool), after), out, count, needed);
  });
}

pliant_status pliant_world_grab_trace(pliant_world world, uint64_t grab, int64_t after, pliant_force_sample* out, size_t count,
                                      size_t* needed) {
  return on(world, [&](CWorld& w) {
    check_array(out, count, "pliant_force_sample");
    give_trace(w.world.force_trace(grab, after), out, count, needed);
  });
}

pliant_status pliant_world_recover(pliant_world world) {
  return on(world, [&](CWorld& w) { w.world.recover(); });
}
