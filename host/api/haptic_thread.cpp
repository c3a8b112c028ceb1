#include "api/haptic_thread.h"

#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>
#include <time.h>

#include <algorithm>

#include "backends/interface/float_environment.h"
#include "devices/check_sample.h"

namespace pliant::api {
namespace {

constexpr double kNano = 1e-9;

std::int64_t now_ns() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return std::int64_t{1'000'000'000} * t.tv_sec + t.tv_nsec;
}

void sleep_until(std::int64_t at) {
  const timespec t{at / 1'000'000'000, at % 1'000'000'000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr);
}

const char* word_of(haptics::ModelKind kind, bool whole) {
  switch (kind) {
    case haptics::ModelKind::buffer:
      return whole ? "whole" : "buffer";
    case haptics::ModelKind::held:
      return "held";
    case haptics::ModelKind::extrapolated:
      return "extrapolated";
  }
  return "";
}

}  // namespace

HapticThread::HapticThread(std::shared_ptr<haptics::Instrument> instrument, std::shared_ptr<HapticDevice> device,
                           const HapticOptions& options, const haptics::CoreOptions& core, const Pose& start)
    : instrument_(std::move(instrument)),
      device_(std::move(device)),
      period_(1 / options.rate),
      automatic_(options.model == "auto"),
      wants_priority_(options.realtime),
      share_(options.share),
      core_(core, start),
      rings_(options.model == "whole" ? -1 : options.rings) {
  running_ = true;
  thread_ = std::thread([this] { run(); });
}

HapticThread::~HapticThread() { stop(); }

void HapticThread::stop() noexcept {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
  instrument_->closed = true;
  running_ = false;
}

void HapticThread::ask_for_priority() noexcept {
  prctl(PR_SET_TIMERSLACK, 1UL);
  if (!wants_priority_) return;
  sched_param parameters{};
  parameters.sched_priority = sched_get_priority_min(SCHED_FIFO) + 40;
  realtime_ = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

void HapticThread::run() noexcept {
  ask_for_priority();
  const DefaultFloatEnvironment environment;
  const auto period = static_cast<Nanoseconds>(period_ / kNano);
  began_ = last_message_ = now_ns();
  last_tick_ = 0;
  Nanoseconds next = began_ + period;
  while (!stop_.load(std::memory_order_relaxed)) {
    sleep_until(next);
    const Nanoseconds now = now_ns();
    delays_.add(static_cast<double>(now - next) * kNano);
    tick(now);
    const Nanoseconds end = now_ns();
    const double work = static_cast<double>(end - now) * kNano;
    work_times_.add(work);
    if (automatic_) choose_rings(work);
    next += period;
    if (end > next) {  // the missed ticks are left out, and the thread sleeps in any case
      const Nanoseconds missed = (end - next) / period + 1;
      told_.late += missed;
      next += missed * period;
    }
  }
  if (sample_.number > 0) {  // a device knows an answer by the number of its sample
    device_->write({{}, {}, sample_.time, sample_.number});
  }
}

void HapticThread::take_message(Nanoseconds now) noexcept {
  if (!instrument_->tissue.take()) return;
  const haptics::BufferMessage& message = instrument_->tissue.newest();
  constexpr double kLeast = 1e-3, kMost = 0.2;  // [s]; frames of a World that is not paced may come at any time
  const double interval = std::clamp(static_cast<double>(now - last_message_) * kNano, kLeast, kMost);
  last_message_ = now;
  core_.receive(message, interval);
  instrument_->in_use.store(core_.buffer().in_use(), std::memory_order_release);
  ++told_.frames;
  told_.buffers = static_cast<std::int64_t>(message.generation);
  elements_ = message.elements;
}

/// The newest sample that is a pose: a device that says something else holds still.
const DeviceSample& HapticThread::newest_sample() noexcept {
  DeviceSample sample = device_->read();
  if (devices::check_sample(sample) == nullptr) sample_ = sample;
  return sample_;
}

void HapticThread::tick(Nanoseconds now) noexcept {
  take_message(now);
  const DeviceSample& sample = newest_sample();
  const double age = told_.frames > 0 ? static_cast<double>(now - last_message_) * kNano : 1e9;
  constexpr double kMostPeriods = 4;
  const double since = last_tick_ > 0 ? static_cast<double>(now - last_tick_) * kNano : period_;
  last_tick_ = now;
  const haptics::CoreTick& done = core_.tick(sample, age, std::clamp(since, 0.5 * period_, kMostPeriods * period_), since);
  device_->write(done.exerted);
  instrument_->hand.publish(core_.pose());
  told_.age = age;
  tell(done, now);
}

/// The whole body, or buffers of as many rings as fit into the share of a tick: more is tried where it would probably fit.
void HapticThread::choose_rings(double work) noexcept {
  constexpr double kSmooth = 0.02, kReserve = 1.3;
  constexpr std::int32_t kMostRings = 8;
  constexpr std::int64_t kWait = 400;  // ticks
  const haptics::BufferModel* buffer = core_.buffer().buffer();
  if (buffer == nullptr) return;
  if (std::exchange(measured_, core_.buffer().in_use()) != core_.buffer().in_use()) {
    work_ = work;
    since_change_ = 0;
  }
  work_ += kSmooth * (work - work_);
  if (++since_change_ < kWait) return;
  const double room = share_ * period_, each = work_ / static_cast<double>(std::max<std::int64_t>(buffer->part().elements, 1));
  const auto growth = static_cast<double>(rings_ + 1) / static_cast<double>(std::max(rings_, 1));
  std::int32_t next = rings_;
  if (work_ > room) {
    next = rings_ < 0 ? kMostRings : std::max(rings_ - 1, 1);
    too_many_ = buffer->part().elements;
  } else if (rings_ > 0 && elements_ < too_many_ && kReserve * each * static_cast<double>(elements_) < room) {
    next = -1;
  } else if (rings_ > 0 && rings_ < kMostRings && kReserve * work_ * growth * growth < room) {
    next = rings_ + 1;
  }
  if (next == rings_) return;
  rings_ = next;
  since_change_ = 0;
  instrument_->wanted_rings = rings_;
}

void HapticThread::tell(const haptics::CoreTick& tick, Nanoseconds now) noexcept {
  Told& t = told_;
  ++t.ticks;
  t.model = core_.in_use();
  const haptics::BufferModel* buffer = core_.buffer().buffer();
  t.rings = buffer == nullptr ? 0 : buffer->part().rings;
  t.elements = buffer != nullptr ? buffer->part().elements : 0;
  t.substeps = buffer != nullptr ? buffer->substeps() : 0;
  t.contacts = buffer != nullptr ? buffer->contacts() : 0;
  t.resets = static_cast<std::int64_t>(core_.buffer().resets());
  t.guard = core_.guard().counts();
  const haptics::PassivityController &move = core_.gate().translation(), &turn = core_.gate().rotation();
  t.corrections = move.corrections() + turn.corrections();
  t.energy = std::min(move.observer().energy(), turn.observer().energy());
  t.least_energy = std::min(move.observer().least(), turn.observer().least());
  t.last = {
      t.ticks,        static_cast<double>(now - began_) * kNano, tick.device.position, tick.tool.position, tick.tissue.force,
      tick.hand.force};
  mailbox_.publish(t);
  queue_.push(t.last);
}

HapticState HapticThread::state() {
  mailbox_.take();
  const Told& t = mailbox_.newest();
  HapticState s;
  s.running = running_;
  s.realtime = realtime_;
  s.model = word_of(t.model, t.rings < 0);
  s.ticks = t.ticks;
  s.late = t.late;
  s.work_mean = work_times_.mean();
  s.work_p999 = work_times_.quantile(0.999);
  s.work_most = work_times_.most();
  s.delay_p999 = delays_.quantile(0.999);
  s.delay_most = delays_.most();
  s.frames = t.frames;
  s.age = t.age;
  s.rings = t.rings;
  s.elements = t.elements;
  s.substeps = t.substeps;
  s.buffers = t.buffers;
  s.resets = t.resets;
  s.contacts = t.contacts;
  s.stale = static_cast<std::int64_t>(t.guard.stale);
  s.limited = static_cast<std::int64_t>(t.guard.limited);
  s.not_finite = static_cast<std::int64_t>(t.guard.not_finite);
  s.corrections = static_cast<std::int64_t>(t.corrections);
  s.energy = t.energy;
  s.least_energy = t.least_energy;
  s.refused = instrument_->refused.load();
  s.last = t.last;
  return s;
}

std::vector<HapticSample> HapticThread::samples() {
  HapticSample sample;
  std::vector<HapticSample> out;
  while (queue_.pop(sample)) out.push_back(sample);
  return out;
}

}  // namespace pliant::api
