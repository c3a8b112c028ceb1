// The haptic thread of a device: ticks at a fixed rate by an absolute clock.
#pragma once
#include <limits>
#include <memory>
#include <thread>
#include <vector>

#include "devices/sample_queue.h"
#include "haptics/haptic_core.h"
#include "haptics/tick_statistics.h"
#include "pliant/haptics.h"

namespace pliant::api {

class HapticThread {
 public:
  /// Starts the thread.
  HapticThread(std::shared_ptr<haptics::Instrument> instrument, std::shared_ptr<HapticDevice> device,
               const HapticOptions& options, const haptics::CoreOptions& core, const Pose& start);
  ~HapticThread();
  HapticThread(const HapticThread&) = delete;
  HapticThread& operator=(const HapticThread&) = delete;
  void stop() noexcept;

  // For one caller at a time.
  [[nodiscard]] HapticState state();
  std::vector<HapticSample> samples();

 private:
  using Nanoseconds = std::int64_t;
  /// State that the thread publishes in each tick.
  struct Told {
    std::int64_t ticks = 0, late = 0, frames = 0;
    double age = 0;
    haptics::ModelKind model = haptics::ModelKind::buffer;
    std::int32_t rings = 0;
    std::int64_t elements = 0, buffers = 0, resets = 0, contacts = 0;
    int substeps = 0;
    haptics::GuardCounts guard;
    std::uint64_t corrections = 0;
    double energy = 0, least_energy = 0;
    HapticSample last;
  };
  void run() noexcept;
  void tick(Nanoseconds now) noexcept;
  void take_message(Nanoseconds now) noexcept;
  const DeviceSample& newest_sample() noexcept;
  void choose_rings(double work) noexcept;
  void tell(const haptics::CoreTick& tick, Nanoseconds now) noexcept;
  void ask_for_priority() noexcept;

  const std::shared_ptr<haptics::Instrument> instrument_;
  const std::shared_ptr<HapticDevice> device_;
  const double period_;  ///< [s]
  const bool automatic_, wants_priority_;
  const double share_;
  haptics::HapticCore core_;

  // Of the thread.
  Nanoseconds began_ = 0, last_message_ = 0, last_tick_ = 0;
  Told told_;
  DeviceSample sample_;
  std::int64_t elements_ = 0;  ///< of all bodies
  std::int32_t rings_;         ///< as requested; -1: all
  double work_ = 0;            ///< of a tick, smoothed [s]
  std::int64_t since_change_ = 0;
  std::uint64_t measured_ = 0;                                        ///< generation of the buffer that work_ belongs to
  std::int64_t too_many_ = std::numeric_limits<std::int64_t>::max();  ///< elements that did not fit into a tick

  // Between the threads.
  devices::Mailbox<Told> mailbox_;
  devices::SampleQueue<HapticSample> queue_{65536};
  haptics::TimeHistogram work_times_, delays_;
  std::atomic<bool> stop_{false}, running_{false}, realtime_{false};

  std::thread thread_;
};

}  // namespace pliant::api
