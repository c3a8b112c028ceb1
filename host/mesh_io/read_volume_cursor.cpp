#include "mesh_io/read_volume_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <system_error>

#include "pliant/error.h"

namespace pliant::volume_file {
namespace {

bool blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

}  // namespace

std::string load(const std::filesystem::path& file) {
  std::error_code code;
  const std::filesystem::file_status status = std::filesystem::status(file, code);
  if (!std::filesystem::exists(status))
    throw Error(ErrorCode::bad_input, fmt::format("cannot read mesh '{}': no such file", file.string()));
  if (!std::filesystem::is_regular_file(status))
    throw Error(ErrorCode::bad_input, fmt::format("cannot read mesh '{}': it is not a file", file.string()));
  const std::uintmax_t size = std::filesystem::file_size(file, code);
  std::ifstream in(file, std::ios::binary);
  if (code || !in) throw Error(ErrorCode::bad_input, fmt::format("cannot read mesh '{}': it cannot be opened", file.string()));
  std::string data(static_cast<std::size_t>(size), '\0');
  in.read(data.data(), static_cast<std::streamsize>(data.size()));
  if (static_cast<std::uintmax_t>(in.gcount()) != size) {
    throw Error(ErrorCode::bad_input,
                fmt::format("cannot read mesh '{}': {} of {} bytes could be read", file.string(), in.gcount(), size));
  }
  if (data.empty()) throw Error(ErrorCode::bad_input, fmt::format("cannot read mesh '{}': it is empty", file.string()));
  return data;
}

std::string shown(std::string_view word, std::size_t most) {
  std::string out;
  for (const char c : word.substr(0, most)) out += c >= ' ' && c <= '~' ? c : '?';
  return word.size() > most ? out + "..." : out;
}

std::optional<std::int64_t> parse_integer(std::string_view word) {
  std::int64_t value = 0;
  const char* from = word.data() + (word.starts_with('+') ? 1 : 0);
  const auto [end, code] = std::from_chars(from, word.data() + word.size(), value);
  if (code != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

bool Cursor::at_end() {
  while (at_ < data_.size()) {
    if (comment_ != 0 && data_[at_] == comment_) {
      line();
    } else if (blank(data_[at_])) {
      ++at_;
    } else {
      return false;
    }
  }
  return true;
}

std::string_view Cursor::token(const char* what) {
  if (at_end()) {
    last_ = at_;
    fail(fmt::format("the file ends where {} is expected", what));
  }
  last_ = at_;
  while (at_ < data_.size() && !blank(data_[at_])) ++at_;
  return data_.substr(last_, at_ - last_);
}

std::string_view Cursor::line() {
  const std::size_t start = at_;
  const std::size_t end = std::min(data_.find('\n', at_), data_.size());
  at_ = std::min(end + 1, data_.size());
  std::string_view text = data_.substr(start, end - start);
  if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
  return text;
}

std::int64_t Cursor::integer(const char* what) {
  const std::string_view word = token(what);
  const auto value = parse_integer(word);
  if (!value) fail(fmt::format("expected {}, found '{}'", what, shown(word)));
  return *value;
}

double Cursor::real(const char* what) {
  const std::string_view word = token(what);
  double value = 0;
  const char* from = word.data() + (word.front() == '+' ? 1 : 0);
  const auto [end, code] = std::from_chars(from, word.data() + word.size(), value);
  // A magnitude outside the range of double reads as zero or infinity would in any other reader; neither belongs in a mesh.
  if (code != std::errc{} || end != word.data() + word.size()) {
    fail(fmt::format("expected {}, found '{}'{}", what, shown(word),
                     code == std::errc::result_out_of_range ? " (out of range)" : ""));
  }
  return value;
}

std::int64_t Cursor::check_count(std::int64_t n, const char* what, std::size_t bytes) {
  if (n < 0) fail(fmt::format("{} is {}; it cannot be negative", what, n));
  if (static_cast<std::uint64_t>(n) > remaining() / bytes) {
    fail(fmt::format("{} is {}, which cannot fit in the {} bytes that follow", what, n, remaining()));
  }
  return n;
}

void Cursor::need(std::size_t bytes, const char* what) {
  last_ = at_;
  if (remaining() < bytes) fail(fmt::format("the file ends where {} is expected", what));
}

void Cursor::fail(const std::string& what) const {
  if (where_ == Where::section) throw Error(ErrorCode::bad_input, fmt::format("{}, {}: {}", file_.string(), section_, what));
  if (where_ == Where::byte)
    throw Error(ErrorCode::bad_input, fmt::format("{}, {}, byte {}: {}", file_.string(), section_, last_, what));
  const auto line = 1 + std::count(data_.begin(), data_.begin() + static_cast<std::ptrdiff_t>(last_), '\n');
  throw Error(ErrorCode::bad_input, fmt::format("{}:{}: {}", file_.string(), line, what));
}

}  // namespace pliant::volume_file
