// Ticks in wall time, beside a World that runs and is cut.
#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <time.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "bench/common/shipped_scenes.h"
#include "bench/haptics/parts.h"
#include "haptics/tick_statistics.h"
#include "pliant/haptics.h"

namespace pliant::bench::haptics {
namespace {

using Clock = std::chrono::steady_clock;
using pliant::haptics::TimeHistogram;

/// Presses and draws circles, without end.
class Circling final : public HapticDevice {
 public:
  explicit Circling(double depth) : depth_(depth) {}
  DeviceSample read() noexcept override {
    const double t = std::chrono::duration<double>(Clock::now() - began_).count(), down = std::min(1.0, t / 0.5);
    DeviceSample sample;
    sample.position = {0.008 * std::sin(3 * t), -depth_ * down * down * (3 - 2 * down), 0.008 * (1 - std::cos(3 * t))};
    sample.time = t;
    sample.number = ++number_;
    return sample;
  }
  void write(const DeviceWrench& wrench) noexcept override { sum_ = sum_ + wrench.force[1]; }

 private:
  double depth_;
  Clock::time_point began_ = Clock::now();
  std::uint64_t number_ = 0;
  double sum_ = 0;
};

/// A thread that only wakes up, as cyclictest's does: what the machine itself can keep.
class Sleeper {
 public:
  Sleeper(double rate, bool realtime) : thread_([this, rate, realtime] { run(rate, realtime); }) {}
  ~Sleeper() {
    stop_ = true;
    thread_.join();
  }
  Sleeper(const Sleeper&) = delete;
  Sleeper& operator=(const Sleeper&) = delete;
  [[nodiscard]] const TimeHistogram& delays() const { return delays_; }

 private:
  void run(double rate, bool realtime) {
    if (realtime) {
      sched_param parameters{};
      parameters.sched_priority = sched_get_priority_min(SCHED_FIFO) + 41;
      pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
    }
    auto next = Clock::now();
    const auto period = std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 / rate));
    while (!stop_) {
      next += period;
      std::this_thread::sleep_until(next);
      delays_.add(std::chrono::duration<double>(Clock::now() - next).count());
    }
  }
  TimeHistogram delays_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

void session(PartRun& run, const std::string& file, double rate, const std::string& model, double share_done) {
  const std::filesystem::path folder = find_shipped_scenes(run.options.scenes, file);
  WorldOptions options;
  options.cutting = true;
  World world = World::open((folder / file).string(), options);
  ToolSpec ball;
  ball.name = "ball";
  ball.radius = 0.012;
  ball.path = {{0, -0.02, 0.092, 0, 0, 0, 0, 1}};
  ball.friction = 0.2;
  world.add_tool(ball);
  const std::string name = fmt::format("{}, {} Hz, {}", file, rate, model == "auto" ? "auto" : "2 rings");
  run.show(share_done, name);
  HapticOptions haptic;
  haptic.rate = rate;
  haptic.model = model;
  haptic.rings = 2;
  HapticLoop loop(world, "ball", std::make_shared<Circling>(0.012), haptic);
  const Sleeper bare(rate, loop.state().realtime);
  world.run_live();
  const auto began = Clock::now();
  double cut_at = 1;
  std::int64_t cuts = 0;
  for (double t = 0; t < run.options.seconds; t = std::chrono::duration<double>(Clock::now() - began).count()) {
    world.frame();
    if (t > cut_at) {  // another slice from the free end, every half second
      cut_at += 0.5;
      const double x = 0.06 - 0.004 * static_cast<double>(cuts++ % 10), y = 0.02;
      world.cut({{Vec3d{x, y, -0.1}, {x, 0.2, -0.1}, {x, 0.2, 0.1}}, {Vec3d{x, y, -0.1}, {x, 0.2, 0.1}, {x, y, 0.1}}});
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
  }
  const HapticState state = loop.state();
  const LiveState live = world.live_state();
  constexpr double kMicro = 1e6;
  if (model == "auto") {
    run.told("mean work of a tick [us]", name, kMicro * state.work_mean);
  } else {
    run.at_most("mean work of a tick [us]", name, kMicro * state.work_mean, 10);
  }
  run.told("99.9 % of the ticks work at most [us]", name, kMicro * state.work_p999);
  run.told("longest work of a tick [us]", name, kMicro * state.work_most);
  run.told("99.9 % of the ticks begin at most so late [us]", name, kMicro * state.delay_p999);
  run.told("the same of a thread that only wakes up [us]", name, kMicro * bare.delays().quantile(0.999));
  run.told("latest tick [us]", name, kMicro * state.delay_most);
  run.told("latest of a thread that only wakes up [us]", name, kMicro * bare.delays().most());
  run.told("ticks left out, over all", name,
           static_cast<double>(state.late) / static_cast<double>(std::max<std::int64_t>(1, state.ticks)));
  run.told("real-time priority", name, state.realtime ? 1 : 0);
  run.told("elements of the buffer", name, static_cast<double>(state.elements));
  run.told("rings of the buffer", name, state.rings);
  run.told("cuts", name, static_cast<double>(cuts));
  run.told("simulated over real time", name, live.real_time);
  run.at_most("buffers that blew up", name, static_cast<double>(state.resets), 0);
  run.at_most("energy taken beyond the allowance of 1e-3 J [J]", name, std::max(0.0, -state.least_energy), 1e-9);
}

}  // namespace

void measure_times(PartRun& run) {
  session(run, "liver.json", 1000, "buffer", 0);
  if (run.options.quick) return;
  session(run, "liver.json", 10000, "buffer", 0.25);
  session(run, "liver.json", 1000, "auto", 0.5);
  session(run, "liver.json", 10000, "auto", 0.75);
}

}  // namespace pliant::bench::haptics
