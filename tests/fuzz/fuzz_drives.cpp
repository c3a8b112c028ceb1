// Any bytes may stand in a log of drives. One that is read holds what a replay relies on, and comes back with the same bits.
#include <cmath>
#include <cstdlib>

#include "haptics/drive_log.h"
#include "pliant/error.h"

namespace {

void expect(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pliant::haptics;
  DriveLog log;
  try {
    log = parse_drive_log({reinterpret_cast<const char*>(data), size}, "drives.log");
  } catch (const pliant::Error&) {
    return 0;
  }
  LoggedMoment last = log.begin;
  expect(last.step >= 0 && std::isfinite(last.time));
  std::int64_t backs = 0;
  for (const LoggedDrive& drive : log.drives) {
    expect(drive.at.step >= last.step && drive.again >= backs && (drive.again > backs || drive.at.time >= last.time));
    backs = drive.again;
    expect(drive.confirms || ((drive.grips || (drive.seconds > 0 && std::isfinite(drive.seconds))) && !drive.tool.empty()));
    expect(pliant::good_pose(drive.target));
    last = drive.at;
  }
  if (log.end) expect(log.end->step >= last.step && (log.again > backs || log.end->time >= last.time));
  const std::string written = drive_log_text(log);
  const DriveLog again = parse_drive_log(written, "drives.log");
  expect(again.drives.size() == log.drives.size() && again.end.has_value() == log.end.has_value());
  for (std::size_t i = 0; i < log.drives.size(); ++i) {
    const LoggedDrive &a = log.drives[i], &b = again.drives[i];
    expect(a.at.step == b.at.step && a.at.time == b.at.time && a.seconds == b.seconds && a.target == b.target &&
           a.tool == b.tool && a.grips == b.grips && a.confirms == b.confirms && a.again == b.again);
  }
  expect(drive_log_text(again) == written);
  return 0;
}
