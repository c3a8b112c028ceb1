// A run by hand once more, from its log.
#pragma once
#include <cstddef>

#include "haptics/drive_log.h"
#include "haptics/run_guide.h"

namespace pliant::haptics {

/// Applies each drive at its step. A simulation that goes on behind the log's begin gets the drives from its own step on.
class Replay final : public RunGuide {
 public:
  /// `to_end`: the run ends where the log does. Throws Error (bad_input), with file and line, for a log that begins behind
  /// `simulation`, and for a tool that is not there.
  Replay(DriveLog log, const Simulation& simulation, bool to_end);
  [[nodiscard]] std::int64_t steps_left(const Simulation& simulation) const override;
  /// Throws Error (bad_input) if a step of the log is not at its time, or if the simulation refuses a drive.
  bool next(Simulation& simulation) override;
  [[nodiscard]] const DriveLog& log() const { return log_; }
  [[nodiscard]] std::size_t applied() const { return applied_; }

 private:
  [[noreturn]] void refuse(const LoggedMoment& at, const std::string& why) const;
  void check_time(const LoggedMoment& at, const Simulation& simulation) const;

  DriveLog log_;
  bool to_end_;
  std::size_t next_ = 0, applied_ = 0;
};

}  // namespace pliant::haptics
