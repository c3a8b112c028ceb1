#include "backends/twins/check_buffer.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "backends/interface/buffer_checks.h"

namespace pliant::ref {
namespace {

constexpr std::ptrdiff_t kBlock = 64;  // number of values compared together

void set_bits(unsigned char* values, std::ptrdiff_t i, std::uint32_t bits) { std::memcpy(values + 4 * i, &bits, 4); }

std::uint32_t get_bits(const unsigned char* values, std::ptrdiff_t i) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, values + 4 * i, 4);
  return bits;
}

}  // namespace

CheckBuffer::CheckBuffer(const Buffer& row, BufferId id)
    : name_(row.name),
      id_(id),
      role_(row.role),
      carried_(row.carried),
      is_int_(row.is_int()),
      values_(static_cast<std::ptrdiff_t>(row.values())),
      fixed_(values_ - static_cast<std::ptrdiff_t>(std::min(row.fixed, row.values()))) {
  for (WorldImage& world : worlds_) world.resize(4 * static_cast<std::size_t>(values_ + 2 * kZone));
  fill_poison(-kZone, 0);
  fill_poison(values_, values_ + kZone);
  const std::size_t given = initial_count(row);
  if (row.is_int()) {
    std::vector<std::int32_t> initial(row.values(), 0);
    std::copy(row.ints.begin(), row.ints.end(), initial.begin());
    write(initial.data());
  } else {
    std::vector<float> initial(row.values(), static_cast<float>(row.padding));
    round_reals(std::span(row.reals).first(given), initial.data());
    write(initial.data());
  }
  if (may_be_undefined() && carried_ == Carried::unwritten) written_.assign(row.values(), 0);
}

std::uint32_t CheckBuffer::bits_in(const WorldImage& image, std::ptrdiff_t i) { return get_bits(image.data(), i + kZone); }

std::uint32_t CheckBuffer::poison(int world, std::ptrdiff_t i) const {
  if (world == 0) return is_int_ ? 17 : 0x7fc0deadu;
  std::uint32_t h = static_cast<std::uint32_t>(i) * 0x9e3779b1u ^ static_cast<std::uint32_t>(id_ + 1) * 0x85ebca77u;
  h ^= h >> 15;
  return is_int_ ? 32u | (h & 31u) : 0x3f800000u | (h & 0x807fffffu);
}

void CheckBuffer::fill_poison(std::ptrdiff_t first, std::ptrdiff_t last) {
  for (int world = 0; world < kWorlds; ++world) {
    for (std::ptrdiff_t i = first; i < last; ++i) set_bits(worlds_[world].data(), i + kZone, poison(world, i));
  }
}

ArgValue<float> CheckBuffer::argument(int world) {
  unsigned char* values = &worlds_[world][4 * kZone];
  ArgValue<float> value;
  if (is_int_) {
    value.ints = reinterpret_cast<std::int32_t*>(values);
  } else {
    value.reals = reinterpret_cast<float*>(values);
  }
  return value;
}

void CheckBuffer::write(const void* values) {
  const auto* bytes = static_cast<const unsigned char*>(values);
  kept_.assign(bytes, bytes + 4 * values_);
  for (WorldImage& world : worlds_) std::copy(kept_.begin(), kept_.end(), world.begin() + 4 * kZone);
}

void CheckBuffer::begin_step() {
  if (!may_be_undefined()) return;
  if (carried_ == Carried::nothing) return fill_poison(0, fixed_);
  for (std::ptrdiff_t i = 0; i < fixed_ && !written_.empty(); ++i) {
    if (written_[static_cast<std::size_t>(i)] != 0) fill_poison(i, i + 1);
  }
}

template <class Counts>
std::optional<std::ptrdiff_t> CheckBuffer::first_difference(const unsigned char* a, const unsigned char* b,
                                                            std::ptrdiff_t first, std::ptrdiff_t last, Counts&& counts) {
  for (std::ptrdiff_t block = first; block < last; block += kBlock) {
    const std::ptrdiff_t end = std::min(block + kBlock, last);
    if (std::memcmp(a + 4 * block, b + 4 * block, static_cast<std::size_t>(4 * (end - block))) == 0) continue;
    for (std::ptrdiff_t i = block; i < end; ++i) {
      if (get_bits(a, i) != get_bits(b, i) && counts(i)) return i;
    }
  }
  return std::nullopt;
}

std::optional<std::ptrdiff_t> CheckBuffer::written_outside() const {
  // Check the values next to the buffer first, where an overrun begins.
  for (std::ptrdiff_t k = 0; k < kZone; ++k) {
    if (!undefined(-1 - k)) return -1 - k;
    if (!undefined(values_ + k)) return values_ + k;
  }
  return std::nullopt;
}

std::optional<std::ptrdiff_t> CheckBuffer::changed() const {
  const std::ptrdiff_t first = writable() ? fixed_ : 0;
  std::optional<std::ptrdiff_t> found;
  for (int world = 0; world < kWorlds && !found; ++world) {
    found = first_difference(bytes(world), kept_.data(), first, values_, [](std::ptrdiff_t) { return true; });
  }
  return found;
}

std::optional<std::ptrdiff_t> CheckBuffer::doubtful() const {
  return first_difference(bytes(0), bytes(1), 0, values_,
                          [this](std::ptrdiff_t i) { return !may_be_undefined() || !undefined(i); });
}

std::optional<std::ptrdiff_t> CheckBuffer::unwritten() const {
  return first_difference(bytes(0), bytes(1), 0, values_, [](std::ptrdiff_t) { return true; });
}

void CheckBuffer::note_written() {
  if (written_.empty()) return;
  first_difference(bytes(0), kept_.data(), 0, fixed_, [this](std::ptrdiff_t i) {
    written_[static_cast<std::size_t>(i)] = 1;
    return false;
  });
}

}  // namespace pliant::ref
