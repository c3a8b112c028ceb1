#include "model/read_volume_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "pliant/error.h"

namespace pliant::volume_file {
namespace {

bool blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/// What a message may quote of a file that can hold anything.
std::string quoted(std::string_view word) {
  std::string out;
  for (const char c : word.substr(0, 40)) out += c >= ' ' && c <= '~' ? c : '?';
  return word.size() > 40 ? out + "..." : out;
}

}  // namespace

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
  std::int64_t value = 0;
  const char* from = word.data() + (word.front() == '+' ? 1 : 0);
  const auto [end, code] = std::from_chars(from, word.data() + word.size(), value);
  if (code != std::errc{} || end != word.data() + word.size()) fail(fmt::format("expected {}, found '{}'", what, quoted(word)));
  return value;
}

double Cursor::real(const char* what) {
  const std::string_view word = token(what);
  double value = 0;
  const char* from = word.data() + (word.front() == '+' ? 1 : 0);
  const auto [end, code] = std::from_chars(from, word.data() + word.size(), value);
  // A magnitude outside the range of double reads as zero or infinity would in any other reader; neither belongs in a mesh.
  if (code != std::errc{} || end != word.data() + word.size()) {
    fail(fmt::format("expected {}, found '{}'{}", what, quoted(word),
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
  if (where_ == Where::section) throw Error(fmt::format("{}, {}: {}", file_.string(), section_, what));
  if (where_ == Where::byte) throw Error(fmt::format("{}, {}, byte {}: {}", file_.string(), section_, last_, what));
  const auto line = 1 + std::count(data_.begin(), data_.begin() + static_cast<std::ptrdiff_t>(last_), '\n');
  throw Error(fmt::format("{}:{}: {}", file_.string(), line, what));
}

}  // namespace pliant::volume_file
