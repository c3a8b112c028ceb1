#include "haptics/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "haptics/driven_part.h"
#include "pliant/error.h"
#include "scene/keys.h"

namespace pliant::haptics {
namespace {

constexpr std::int64_t kNever = 1'000'000'000'000'000;

}  // namespace

Replay::Replay(DriveLog log, const Simulation& simulation, bool to_end) : log_(std::move(log)), to_end_(to_end) {
  std::vector<std::string> names;
  for (const std::string& name : DrivenPart::names(simulation)) names.push_back('"' + name + '"');
  for (const LoggedDrive& drive : log_.drives) {
    if (drive.confirms || std::find(names.begin(), names.end(), '"' + drive.tool + '"') != names.end()) continue;
    refuse(drive.at, fmt::format("the tool is \"{}\"; {}", drive.tool,
                                 names.empty() ? "the scene has none" : "the scene has " + listed(names)));
  }
  if (log_.begin.step > simulation.step()) {
    refuse(log_.begin, fmt::format("the log begins at step {}, the run at step {}; expected the checkpoint that it began with "
                                   "(--resume FILE)",
                                   log_.begin.step, simulation.step()));
  }
  if (log_.begin.step == simulation.step()) check_time(log_.begin, simulation);
  // Rows of steps that were taken back since are done: what they requested is in the state.
  const std::int64_t again = log_.again > 0 ? simulation.report().made_again : 0;
  const auto done = [&](const LoggedDrive& d) { return std::pair(d.again, d.at.step) < std::pair(again, simulation.step()); };
  next_ = static_cast<std::size_t>(std::partition_point(log_.drives.begin(), log_.drives.end(), done) - log_.drives.begin());
}

void Replay::refuse(const LoggedMoment& at, const std::string& why) const {
  throw Error(ErrorCode::bad_input, fmt::format("{}:{}: {}", log_.file, at.line, why));
}

void Replay::check_time(const LoggedMoment& at, const Simulation& simulation) const {
  if (at.time == simulation.time()) return;
  refuse(at, fmt::format("step {} is at {:.17g} s; here it is at {:.17g} s: the log is of another scene, step or begin",
                         at.step, at.time, simulation.time()));
}

std::int64_t Replay::steps_left(const Simulation& simulation) const {
  std::int64_t step = kNever, again = 0;
  if (next_ < log_.drives.size()) {
    step = log_.drives[next_].at.step;
    again = log_.drives[next_].again;
  } else if (log_.end && to_end_) {
    step = log_.end->step;
    again = log_.again;
  }
  if (again > simulation.report().made_again) return kNever;  // it will be taken back before that
  return std::max<std::int64_t>(0, step - simulation.step());
}

bool Replay::next(Simulation& simulation) {
  if (next_ == log_.drives.size()) return false;
  const LoggedDrive& drive = log_.drives[next_++];
  check_time(drive.at, simulation);
  if (drive.confirms) {
    if (simulation.confirm()) refuse(drive.at, "steps were taken back here; now they are not");
    ++applied_;
    return true;
  }
  try {
    const std::optional<DrivenPart> part = DrivenPart::find(simulation, drive.tool);
    if (!part) refuse(drive.at, fmt::format("the blade \"{}\" is nowhere at this time", drive.tool));
    if (drive.grips) {
      simulation.tools().grip(drive.tool, *drive.grips);
    } else {
      part->drive(simulation, drive.target, drive.seconds);
    }
  } catch (const Error& error) {
    if (error.code() == ErrorCode::internal || error.code() == ErrorCode::device) throw;
    refuse(drive.at, error.what());
  }
  ++applied_;
  return true;
}

}  // namespace pliant::haptics
