#include "haptics/drive_log.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <utility>

#include "pliant/error.h"

namespace pliant::haptics {
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 30;
constexpr std::int64_t kMostSteps = 1'000'000'000'000'000;

/// The text up to `end`, without it; takes both from the front.
std::string_view take(std::string_view& text, char end) {
  const std::size_t at = std::min(text.find(end), text.size());
  const std::string_view part = text.substr(0, at);
  text.remove_prefix(std::min(at + 1, text.size()));
  return part;
}

class Parser {
 public:
  explicit Parser(const std::string& file) : file_(file) { log_.file = file; }

  void line(std::string_view line) {
    ++number_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.empty() || line.front() == '#') return;
    if (!headed_) {
      if (line != kDriveLogHead) fail("the first line", line, fmt::format("\"{}\"", kDriveLogHead));
      headed_ = true;
      return;
    }
    row(line);
  }

  DriveLog end() {
    if (!headed_) fail("the file", "empty", fmt::format("a line \"{}\" and rows after it", kDriveLogHead));
    if (!begun_) fail("the file", "without a begin", "a row begin,STEP,TIME");
    return std::move(log_);
  }

 private:
  [[noreturn]] void fail(const std::string& what, std::string_view given, const std::string& allowed) const {
    constexpr std::size_t kMost = 80;
    throw Error(ErrorCode::bad_input, fmt::format("{}:{}: {} is \"{}\"{}; expected {}", file_, number_, what,
                                                  given.substr(0, kMost), given.size() > kMost ? "..." : "", allowed));
  }

  void row(std::string_view rest) {
    const std::string_view whole = rest, kind = take(rest, ',');
    if (kind != (begun_ ? "drive" : "begin") &&
        !(begun_ && (kind == "end" || kind == "grip" || kind == "confirm" || kind == "again")))
      fail("the row", whole, begun_ ? "drive,..., grip,..., confirm,..., again,... or end,..." : "begin,STEP,TIME");
    if (log_.end) fail("the row", whole, "nothing behind the end");
    const LoggedMoment at = moment(rest, kind == "again");
    if (!begun_) {
      log_.begin = at;
      begun_ = true;
    } else if (kind == "end") {
      log_.end = at;
    } else if (kind == "confirm") {
      log_.drives.push_back({at, 0, {}, {}, {}, true, log_.again});
    } else if (kind == "again") {
      again(rest);
    } else {
      return kind == "grip" ? grip(rest, at) : drive(rest, at);
    }
    if (!rest.empty()) fail("behind the time", rest, "nothing");
  }

  /// `back`: steps were taken back before, and times begin again, in shorter steps.
  LoggedMoment moment(std::string_view& rest, bool back) {
    const std::string_view text = take(rest, ',');
    LoggedMoment at;
    at.line = number_;
    const auto [after, error] = std::from_chars(text.data(), text.data() + text.size(), at.step);
    if (error != std::errc() || after != text.data() + text.size() || at.step < last_.step || at.step > kMostSteps) {
      fail("the step", text, fmt::format("a whole number from {} to {}: steps do not fall", last_.step, kMostSteps));
    }
    const std::string_view time = rest.substr(0, rest.find(','));
    at.time = number(rest, "the time");
    const bool falls = at.time < last_.time || (begun_ && at.step == last_.step && at.time != last_.time);
    if (at.time < log_.begin.time || (falls && !back))
      fail("the time", time, fmt::format("{:.17g} at step {}, and more after it", last_.time, last_.step));
    last_ = at;
    return at;
  }

  double number(std::string_view& rest, const char* what) const {
    const std::string_view text = take(rest, ',');
    double value = 0;
    const auto [after, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || after != text.data() + text.size() || !std::isfinite(value))
      fail(what, text, "a finite number");
    return value;
  }

  void drive(std::string_view rest, const LoggedMoment& at) {
    LoggedDrive drive;
    drive.at = at;
    drive.again = log_.again;
    const std::string_view seconds = rest.substr(0, rest.find(','));
    drive.seconds = number(rest, "the seconds on the way");
    if (!(drive.seconds > 0 && drive.seconds < 1e30)) fail("the seconds on the way", seconds, "more than 0 and less than 1e30");
    for (double& x : drive.target.position) x = number(rest, "the position");
    for (double& q : drive.target.turn) q = number(rest, "the turn");
    if (!good_pose(drive.target)) {
      fail("the turn", fmt::format("{}", fmt::join(drive.target.turn, ",")), "a unit quaternion x, y, z, w");
    }
    drive.tool = name(rest);
    log_.drives.push_back(std::move(drive));
  }

  void grip(std::string_view rest, const LoggedMoment& at) {
    const std::string_view on = take(rest, ',');
    if (on != "0" && on != "1") fail("the grip", on, "1 to grip or 0 to let go");
    LoggedDrive drive;
    drive.at = at;
    drive.again = log_.again;
    drive.grips = on == "1";
    drive.tool = name(rest);
    log_.drives.push_back(std::move(drive));
  }

  void again(std::string_view& rest) {
    const std::string_view text = take(rest, ',');
    const std::int64_t least = log_.again + 1;
    const auto [after, error] = std::from_chars(text.data(), text.data() + text.size(), log_.again);
    if (error != std::errc() || after != text.data() + text.size() || log_.again < least || log_.again > kMostSteps)
      fail("the number of times", text, fmt::format("a whole number from {} to {}", least, kMostSteps));
  }

  std::string name(std::string_view rest) const {
    if (rest.empty() || rest.find('\r') != std::string_view::npos) fail("the tool", rest, "its name, without a line break");
    return std::string(rest);
  }

  const std::string& file_;
  DriveLog log_;
  LoggedMoment last_;
  int number_ = 0;
  bool headed_ = false, begun_ = false;
};

}  // namespace

DriveLog parse_drive_log(std::string_view text, const std::string& file) {
  Parser parser(file);
  while (!text.empty()) parser.line(take(text, '\n'));
  return parser.end();
}

std::string drive_log_text(const DriveLog& log) {
  const auto moment = [](const LoggedMoment& at) { return fmt::format("{},{:.17g}", at.step, at.time); };
  std::string text = fmt::format("{}\nbegin,{}\n", kDriveLogHead, moment(log.begin));
  std::int64_t again = 0;
  const auto count = [&](const LoggedMoment& at, std::int64_t next) {
    if (next != std::exchange(again, next)) text += fmt::format("again,{},{}\n", moment(at), next);
  };
  for (const LoggedDrive& d : log.drives) {
    count(d.at, d.again);
    if (d.confirms) {
      text += fmt::format("confirm,{}\n", moment(d.at));
    } else if (d.grips) {
      text += fmt::format("grip,{},{},{}\n", moment(d.at), *d.grips ? 1 : 0, d.tool);
    } else {
      fmt::format_to(std::back_inserter(text), "drive,{},{:.17g},{:.17g},{:.17g},{}\n", moment(d.at), d.seconds,
                     fmt::join(d.target.position, ","), fmt::join(d.target.turn, ","), d.tool);
    }
  }
  if (log.end) {
    count(*log.end, log.again);
    text += fmt::format("end,{}\n", moment(*log.end));
  }
  return text;
}

DriveLog read_drive_log(const std::filesystem::path& file) {
  const auto fail = [&](const std::string& why) { throw Error(ErrorCode::io, fmt::format("{}: {}", file.string(), why)); };
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) fail(fmt::format("cannot be read: {}", error.message()));
  if (size > kLargestFile) fail(fmt::format("has {} bytes, at most 1 GiB is read", size));
  std::string text(size, '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(text.data(), static_cast<std::streamsize>(size))) fail("cannot be read");
  return parse_drive_log(text, file.string());
}

}  // namespace pliant::haptics
