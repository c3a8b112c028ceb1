#include "devices/stroke.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>

#include "devices/check_sample.h"
#include "pliant/error.h"

namespace pliant::devices {
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 30;

/// The line that begins at `from`, without its end; moves `from` behind it.
std::string_view take_line(std::string_view text, std::size_t& from) {
  const std::size_t end = std::min(text.find('\n', from), text.size());
  std::string_view line = text.substr(from, end - from);
  from = end + 1;
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

/// Exactly nine numbers, separated by commas. Null, or what is wrong.
Refusal parse_line(std::string_view line, DeviceSample& sample) {
  std::array<double, 8> x{};
  const char* at = line.data();
  const char* end = at + line.size();
  for (double& value : x) {
    const auto [after, error] = std::from_chars(at, end, value);
    if (error != std::errc() || after == end || *after != ',') return "expected nine numbers separated by commas";
    at = after + 1;
  }
  const auto [after, error] = std::from_chars(at, end, sample.buttons);
  if (error != std::errc() || after != end) return "expected nine numbers, the last a whole one from 0 to 4294967295";
  sample.time = x[0];
  sample.position = {x[1], x[2], x[3]};
  sample.turn = {x[4], x[5], x[6], x[7]};
  const std::array<double, 4> given = sample.turn;
  if (const Refusal why = check_sample(sample); why != nullptr) return why;
  double change = 0;
  for (int a = 0; a < 4; ++a) change = std::max(change, std::abs(given[a] - sample.turn[a]));
  if (change < 1e-12) sample.turn = given;  // a recorded stroke keeps its bits
  return nullptr;
}

}  // namespace

std::vector<DeviceSample> parse_stroke(std::string_view text, const std::string& file) {
  std::vector<DeviceSample> samples;
  bool headed = false;
  int number = 0;
  const auto fail = [&](std::string_view why) {
    throw Error(ErrorCode::bad_input, fmt::format("{}:{}: {}", file, number, why));
  };
  for (std::size_t from = 0; from < text.size();) {
    const std::string_view line = take_line(text, from);
    ++number;
    if (line.empty() || line.front() == '#') continue;
    if (!headed) {
      if (line != kStrokeHead) fail(fmt::format("expected the first line \"{}\"", kStrokeHead));
      headed = true;
      continue;
    }
    DeviceSample sample;
    if (const Refusal why = parse_line(line, sample); why != nullptr) fail(why);
    if (!samples.empty() && !(sample.time > samples.back().time)) {
      fail(fmt::format("the time {} does not follow {}: times must increase", sample.time, samples.back().time));
    }
    sample.number = samples.size() + 1;
    samples.push_back(sample);
  }
  if (samples.empty()) fail(fmt::format("there is no sample; expected a line \"{}\" and samples after it", kStrokeHead));
  return samples;
}

std::string stroke_text(std::span<const DeviceSample> samples) {
  std::string text = std::string(kStrokeHead) + "\n";
  for (const DeviceSample& s : samples) {
    fmt::format_to(std::back_inserter(text), "{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{}\n", s.time,
                   s.position[0], s.position[1], s.position[2], s.turn[0], s.turn[1], s.turn[2], s.turn[3], s.buttons);
  }
  return text;
}

std::vector<DeviceSample> read_stroke(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) throw Error(ErrorCode::io, fmt::format("{}: cannot be read: {}", file.string(), error.message()));
  if (size > kLargestFile)
    throw Error(ErrorCode::io, fmt::format("{}: has {} bytes, at most 1 GiB is read", file.string(), size));
  std::string text(size, '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(text.data(), static_cast<std::streamsize>(size))) {
    throw Error(ErrorCode::io, fmt::format("{}: cannot be read", file.string()));
  }
  return parse_stroke(text, file.string());
}

void write_stroke(const std::filesystem::path& file, std::span<const DeviceSample> samples) {
  const std::filesystem::path incomplete = file.string() + fmt::format(".{}.tmp", getpid());
  const std::string text = stroke_text(samples);
  std::error_code error;
  bool good = false;
  {
    std::ofstream stream(incomplete, std::ios::binary);
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    stream.close();
    good = !stream.fail();
  }
  if (good) std::filesystem::rename(incomplete, file, error);
  if (good && !error) return;
  std::error_code ignored;
  std::filesystem::remove(incomplete, ignored);
  throw Error(ErrorCode::io,
              fmt::format("{}: cannot be written{}{}", file.string(), error ? ": " : "", error ? error.message() : ""));
}

}  // namespace pliant::devices
