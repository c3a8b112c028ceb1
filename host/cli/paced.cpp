#include "cli/paced.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "api/haptic_options.h"
#include "geometry/vec.h"
#include "haptics/driven_part.h"
#include "pliant/error.h"

namespace pliant::cli {
namespace {

Pose pose_of(const Simulation& simulation, const std::string& name) {
  const std::optional<haptics::DrivenPart> own = haptics::DrivenPart::find(simulation, name);
  if (!own) throw Error(ErrorCode::usage, "there is no tool or blade \"" + name + "\" at present");
  return own->pose(simulation, simulation.time());
}

}  // namespace

Paced::Paced(const Simulation& simulation, const std::vector<haptics::HeldTool>& tools, double rate, std::function<bool()> stop,
             std::function<void(const std::string&)> remark, haptics::DriveLog& log)
    : stop_(std::move(stop)), remark_(std::move(remark)), log_(log), begin_(simulation.time()), target_(begin_) {
  HapticOptions options;
  options.rate = rate;
  api::check_options(options);
  for (const haptics::HeldTool& held : tools) {
    Hand hand;
    hand.instrument = std::make_shared<haptics::Instrument>(held.tool, options.rings, options.predict);
    hand.thread =
        std::make_unique<api::HapticThread>(hand.instrument, held.device, options,
                                            api::core_options(options, held.device->limits()), pose_of(simulation, held.tool));
    hands_.push_back(std::move(hand));
  }
  log_.begin = {simulation.step(), begin_, 0};
  pace_.start({}, api::wall_time());
}

std::int64_t Paced::steps_left(const Simulation& simulation) const { return haptics::steps_before(simulation, target_); }

bool Paced::next(Simulation& simulation) {
  end_frame(simulation);
  if (!wait()) return false;
  const double covers = pace_.begin(api::wall_time());
  started_ = true;
  begin_ = simulation.time();
  target_ += covers;
  for (Hand& hand : hands_) {
    const std::optional<std::string> refused = hand.instrument->before(simulation, covers);
    if (refused && !std::exchange(hand.refused, true)) remark_(*refused);
    haptics::LoggedDrive row = haptics::logged(simulation, hand.instrument->tool());
    if (const auto& gripped = hand.instrument->gripped()) {
      log_.drives.push_back(row);
      log_.drives.back().grips = gripped;
    }
    if (!hand.instrument->driven()) continue;
    row.seconds = covers;
    row.target = *hand.instrument->driven();
    log_.drives.push_back(std::move(row));
  }
  return true;
}

void Paced::end_frame(const Simulation& simulation) {
  for (Hand& hand : hands_) {
    hand.instrument->after(simulation);
    for (const HapticSample& tick : hand.thread->samples())
      hand.largest_force = std::max(hand.largest_force, vec::norm(tick.force));
  }
  if (started_) pace_.end(api::wall_time(), simulation.time() - begin_, 0, 0);
  started_ = false;
}

/// Until the next frame may start. Returns false if the run is stopped before.
bool Paced::wait() {
  constexpr double kLook = 0.05;  // [s]
  while (!stop_()) {
    const double now = api::wall_time();
    if (now >= pace_.next_start()) return true;
    std::this_thread::sleep_until(api::moment_of(std::min(pace_.next_start(), now + kLook)));
  }
  return false;
}

void Paced::release() noexcept {
  for (Hand& hand : hands_) hand.thread->stop();
}

}  // namespace pliant::cli
