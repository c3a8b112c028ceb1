#include "backends/interface/buffer_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "pliant/error.h"

namespace pliant {

void check_id(BufferId id, std::size_t buffers) {
  if (id >= 0 && static_cast<std::size_t>(id) < buffers) return;
  throw Error(ErrorCode::internal, fmt::format("there is no buffer {}: the program has {}", id, buffers));
}

void check_type(const Buffer& buffer, bool ints) {
  if (buffer.is_int() == ints) return;
  throw Error(ErrorCode::internal, fmt::format("buffer \"{}\" holds {}", buffer.name, ints ? "reals" : "integers"));
}

void check_size(const Buffer& buffer, std::size_t size) {
  if (size == buffer.values()) return;
  throw Error(ErrorCode::internal,
              fmt::format("buffer \"{}\" holds {} values, received {}", buffer.name, buffer.values(), size));
}

void check_copy(const Buffer& from, const Buffer& to) {
  if (from.is_int() == to.is_int() && from.values() == to.values()) return;
  throw Error(ErrorCode::internal, fmt::format("copy: \"{}\" and \"{}\" differ in size", from.name, to.name));
}

std::size_t initial_count(const Buffer& buffer) {
  const std::size_t given = buffer.is_int() ? buffer.ints.size() : buffer.reals.size();
  if (given > buffer.values()) {
    throw Error(ErrorCode::internal,
                fmt::format("buffer \"{}\" has {} initial values for {}", buffer.name, given, buffer.values()));
  }
  return given;
}

void round_reals(std::span<const double> values, float* out) {
  std::transform(values.begin(), values.end(), out, [](double v) { return static_cast<float>(v); });
}

void round_reals(std::span<const double> values, double* out) { std::copy(values.begin(), values.end(), out); }

namespace {

constexpr std::size_t kBlock = 32;  // number of values compared together
constexpr std::size_t kGap = 1024;  // unchanged values that are uploaded instead of starting a new range

/// Returns true if values [first, last) have the same bits; unspecified values are the padding.
template <class T>
bool same_values(const std::vector<T>& a, T a_padding, const std::vector<T>& b, T b_padding, std::size_t first,
                 std::size_t last) {
  if (last <= a.size() && last <= b.size()) return std::memcmp(&a[first], &b[first], (last - first) * sizeof(T)) == 0;
  for (std::size_t i = first; i < last; ++i) {
    const T u = i < a.size() ? a[i] : a_padding, v = i < b.size() ? b[i] : b_padding;
    if (std::memcmp(&u, &v, sizeof(T)) != 0) return false;
  }
  return true;
}

}  // namespace

std::vector<ValueRange> changed_values(const Buffer& before, const Buffer& next) {
  std::vector<ValueRange> ranges;
  const std::size_t count = next.values(), known = std::min(before.values(), count);
  const auto add = [&](std::size_t first, std::size_t last) {
    if (!ranges.empty() && first <= ranges.back().last + kGap) {
      ranges.back().last = last;
    } else {
      ranges.push_back({first, last});
    }
  };
  if (next.changed) {
    for (const ValueRange& range : *next.changed) {
      if (range.first < known) add(range.first, std::min(range.last, known));
    }
  }
  for (std::size_t first = 0; first < known && !next.changed; first += kBlock) {
    const std::size_t last = std::min(first + kBlock, known);
    const bool same = next.is_int() ? same_values(before.ints, 0, next.ints, 0, first, last)
                                    : same_values(before.reals, before.padding, next.reals, next.padding, first, last);
    if (!same) add(first, last);
  }
  if (known < count) add(known, count);
  return ranges;
}

const Buffer* find_same(const std::vector<Buffer>& table, const Buffer& wanted, std::size_t near) {
  const auto same = [&](const Buffer& b) { return b.name == wanted.name && b.type == wanted.type && b.role == wanted.role; };
  if (near < table.size() && same(table[near])) return &table[near];
  const auto found = std::find_if(table.begin(), table.end(), same);
  return found == table.end() ? nullptr : &*found;
}

}  // namespace pliant
