#include "haptics/lockstep.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>
#include <utility>

#include "devices/stroke_device.h"
#include "geometry/vec.h"
#include "haptics/driven_part.h"
#include "haptics/haptic_core.h"
#include "pliant/error.h"

namespace pliant::haptics {
namespace {

constexpr double kLeastWay = 1e-6;  ///< for a drive whose sample is due already [s]

DrivenPart part_of(const Simulation& simulation, const std::string& name) {
  const std::optional<DrivenPart> own = DrivenPart::find(simulation, name);
  if (!own) throw Error(ErrorCode::usage, fmt::format("there is no tool or blade \"{}\"", name));
  return *own;
}

/// On the tool in the last step.
Wrench felt(const Simulation& simulation, const std::string& name) {
  return part_of(simulation, name).last(simulation).value_or(Wrench{});
}

bool ended(const HapticDevice& device) {
  const auto* stroke = dynamic_cast<const devices::StrokeDevice*>(&device);
  return stroke != nullptr && stroke->ended();
}

}  // namespace

Lockstep::Lockstep(const Simulation& simulation, const std::vector<HeldTool>& tools, LockstepOptions options, DriveLog& log)
    : options_(std::move(options)), log_(log), begin_(simulation.time()), target_(begin_) {
  for (const HeldTool& held : tools) {
    Hand hand;
    hand.held = held;
    hand.guard = ForceGuard(GuardOptions{}, held.device->limits());
    hand.tool_start = part_of(simulation, held.tool).pose(simulation, begin_);
    hand.time = begin_;
    if (auto* stroke = dynamic_cast<devices::StrokeDevice*>(held.device.get()); stroke != nullptr) stroke->step_by_answers();
    hands_.push_back(std::move(hand));
  }
  log_.begin = {simulation.step(), begin_, 0};
}

std::int64_t Lockstep::steps_left(const Simulation& simulation) const { return steps_before(simulation, target_); }

/// All that are due are answered before any is waited for: both hands may belong to one sender.
bool Lockstep::next(Simulation& simulation) {
  std::vector<Hand*> due;
  for (Hand& hand : hands_) {
    if (!hand.over && hand.time <= target_) due.push_back(&hand);
  }
  const bool answers = std::any_of(due.begin(), due.end(), [](const Hand* hand) { return hand->open; });
  if (answers && !accepted(simulation)) return true;
  for (Hand* hand : due) {
    if (hand->open) answer(*hand, simulation);
  }
  for (Hand* hand : due) {
    if (!stopped_) await(*hand, simulation);
  }
  double first = std::numeric_limits<double>::infinity();
  for (const Hand& hand : hands_) {
    if (!hand.over) first = std::min(first, hand.time);
  }
  if (stopped_ || !(first < std::numeric_limits<double>::infinity())) return false;
  target_ = first;
  return true;
}

/// A force that is on its way cannot be taken back. Returns false if this state has been, and the run has to come here again;
/// the look ahead is that of tools at rest.
bool Lockstep::accepted(Simulation& simulation) {
  if (simulation.settled() || simulation.quiet()) return true;
  LoggedDrive row = logged(simulation, {});
  row.confirms = true;
  if (simulation.confirm()) return true;
  log_.drives.push_back(std::move(row));
  return false;
}

void Lockstep::answer(Hand& hand, const Simulation& simulation) {
  const Wrench exerted = hand.guard.tick(felt(simulation, hand.held.tool), 0, hand.period);
  const DeviceSample& sample = *hand.sample;
  hand.answer = {exerted.force, exerted.torque, sample.dated ? sample.time : 0, sample.number};
  hand.counts.largest_force = std::max(hand.counts.largest_force, vec::norm(exerted.force));
  hand.open = false;
  hand.held.device->write(hand.answer);
}

void Lockstep::await(Hand& hand, Simulation& simulation) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::microseconds kPause{50};
  const std::chrono::duration<double> patience(options_.patience);
  Clock::time_point since = Clock::now();
  while (true) {
    const DeviceSample sample = hand.held.device->read();
    if (sample.number != hand.seen && sample.number != 0) {
      if (take(hand, sample, simulation)) return;
      since = Clock::now();
    }
    if (ended(*hand.held.device) || Clock::now() - since > patience) {
      hand.over = true;
      return;
    }
    if (options_.stop && options_.stop()) {
      stopped_ = true;
      return;
    }
    std::this_thread::sleep_for(kPause);
  }
}

/// On the scene's clock. A device whose samples are all undated has a clock that counts them.
double Lockstep::time_of(Hand& hand, const DeviceSample& sample) const {
  hand.dated = hand.dated || sample.dated;
  if (!hand.dated) return begin_ + static_cast<double>(sample.number - hand.first->number) / options_.rate;
  const auto own = [](const DeviceSample& s) { return s.dated ? s.time : 0; };
  return begin_ + (own(sample) - own(*hand.first));
}

/// Returns whether the run goes on to this sample.
bool Lockstep::take(Hand& hand, const DeviceSample& sample, Simulation& simulation) {
  if (hand.seen > 0 && sample.number > hand.seen + 1) {
    if (hand.counts.missed == 0)
      remark(fmt::format("tool '{}': its device sends samples before it has the answer to the last one, and some are missed",
                         hand.held.tool));
    hand.counts.missed += static_cast<std::int64_t>(sample.number - hand.seen - 1);
  }
  hand.seen = sample.number;
  const Pose device{sample.position, sample.turn};
  const bool begins = !hand.first;
  if (begins) {
    hand.first = sample;
    hand.device_start = device;
  }
  const double time = begins ? begin_ : time_of(hand, sample);
  if (begins) {
    hand.dated = sample.dated;
  } else if (!(time > hand.time)) {
    if (hand.counts.falling++ == 0) {
      remark(fmt::format(
          "tool '{}': sample {} of its device is at {:.17g} s of the scene; expected more than {:.17g} s, and it is "
          "refused",
          hand.held.tool, sample.number, time, hand.time));
    }
    hand.answer.time = sample.dated ? sample.time : 0;
    hand.answer.number = sample.number;
    hand.held.device->write(hand.answer);
    return false;
  }
  hand.period = time - hand.time;
  hand.time = time;
  hand.sample = sample;
  hand.open = true;
  ++hand.counts.samples;
  if (begins) return true;
  const Pose target = aligned(device, hand.device_start, hand.tool_start, 1);
  try {
    drive(hand, target, simulation);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::internal || error.code() == ErrorCode::device) throw;
    if (hand.counts.refused++ == 0) remark(error.what());
  }
  return true;
}

void Lockstep::drive(Hand& hand, const Pose& target, Simulation& simulation) {
  const double seconds = std::max(kLeastWay, hand.time - simulation.time());
  LoggedDrive row = logged(simulation, hand.held.tool);
  const DrivenPart part = part_of(simulation, hand.held.tool);
  const HandGrip wanted = hand.button.read(hand.sample->buttons);
  if (grip_as_wanted(simulation, part, wanted)) {
    log_.drives.push_back(row);
    log_.drives.back().grips = wanted == HandGrip::closed;
  }
  const Pose there = part.within_reach(simulation, target, seconds);
  if (there != target && hand.counts.limited++ == 0) {
    remark(
        fmt::format("{} '{}': its device moves it faster through tissue than contact or the cut can follow, first at "
                    "{:.6g} s; it comes after as fast as it may",
                    part.is_blade() ? "blade" : "tool", hand.held.tool, simulation.time()));
  }
  part.drive(simulation, there, seconds);
  row.seconds = seconds;
  row.target = there;
  log_.drives.push_back(std::move(row));
}

void Lockstep::release() noexcept {
  for (Hand& hand : hands_) {
    if (!hand.open) continue;
    hand.open = false;
    hand.held.device->write({{}, {}, hand.sample->dated ? hand.sample->time : 0, hand.sample->number});
  }
}

void Lockstep::remark(const std::string& text) const {
  if (options_.remark) options_.remark(text);
}

}  // namespace pliant::haptics
