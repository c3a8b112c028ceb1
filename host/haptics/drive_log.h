// The log of a run by hand: every drive of a tool that reached the simulation, for a run without any device (docs/haptics.md).
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/contact_tool.h"

namespace pliant::haptics {

/// First line of a log. Then, separated by commas: "begin", step and time [s] of the run's begin; for each drive "drive", step,
/// time, seconds on the way, position x, y, z [m], turn as unit quaternion x, y, z, w, and the rest of the line is the tool's
/// name; where a tool is told to grip or to let go, "grip", step, time, 1 or 0, and its name; "confirm", step and time where
/// the run looked ahead (Simulation::confirm) and steps were taken back; "end", step and time where the run ended.
inline constexpr std::string_view kDriveLogHead = "pliant-drives/1";

/// A place in a run.
struct LoggedMoment {
  std::int64_t step = 0;
  double time = 0;  ///< on the scene's clock [s]
  int line = 0;     ///< of the file that it was read from
};

struct LoggedDrive {
  LoggedMoment at;
  double seconds = 0;  ///< on the way [s]
  Pose target;
  std::string tool;
  std::optional<bool> grips;  ///< of a row "grip", which has no target
  bool confirms = false;      ///< a row "confirm", which has neither target nor tool
  std::int64_t again = 0;     ///< the number of the last row "again" before it
};

struct DriveLog {
  LoggedMoment begin;
  std::vector<LoggedDrive> drives;
  std::optional<LoggedMoment> end;
  std::int64_t again = 0;  ///< at the end
  std::string file;        ///< that it was read from
};

/// Reads the text of a file. Lines that are empty or begin with # are skipped. Throws Error `bad_input` "<file>:<line>: ..."
/// with the given and the allowed value: for another first line, no begin, a row of another form or behind the end, steps
/// or times that fall, numbers that are not finite, a turn that is no unit quaternion, seconds that are not above 0.
DriveLog parse_drive_log(std::string_view text, const std::string& file);

/// The text of a file, 17 digits per number: parse_drive_log gives the same bits.
std::string drive_log_text(const DriveLog& log);

/// Throws Error `io` if the file cannot be read or is larger than 1 GiB.
DriveLog read_drive_log(const std::filesystem::path& file);

}  // namespace pliant::haptics
