// A 64-bit hash of bytes for golden runs, checkpoints and comparisons. Not cryptographic.
// The same bytes give the same value on every machine and compiler; two inputs of equal length that differ in one aligned
// 8-byte word always differ in hash (each round is a bijection of the state for a given word, and of the word for a given
// state).
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace pliant {

namespace hash_detail {
constexpr std::uint64_t kOdd1 = 0xd6e8feb86659fd93ULL;
constexpr std::uint64_t kOdd2 = 0xa0761d6478bd642fULL;

inline std::uint64_t round(std::uint64_t state, std::uint64_t word) { return std::rotl(state ^ (word * kOdd1), 29) * kOdd2; }

inline std::uint64_t finish(std::uint64_t state) {
  state = (state ^ (state >> 32)) * kOdd1;
  state = (state ^ (state >> 29)) * kOdd2;
  return state ^ (state >> 32);
}

/// Up to 8 bytes, the first lowest; missing ones are zero.
inline std::uint64_t word(const unsigned char* bytes, std::size_t count) {
  std::uint64_t w = 0;
  if constexpr (std::endian::native == std::endian::little) {
    std::memcpy(&w, bytes, count);
  } else {
    for (std::size_t i = 0; i < count; ++i) w |= std::uint64_t{bytes[i]} << (8 * i);
  }
  return w;
}
}  // namespace hash_detail

/// Hash of `size` bytes. Chain several blocks by passing the previous result as `seed`; the length of each block counts.
inline std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t seed = 0) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::uint64_t state = hash_detail::round(seed ^ hash_detail::kOdd2, size);
  std::size_t i = 0;
  for (; i + 8 <= size; i += 8) state = hash_detail::round(state, hash_detail::word(bytes + i, 8));
  if (i < size) state = hash_detail::round(state, hash_detail::word(bytes + i, size - i));
  return hash_detail::finish(state);
}

inline std::uint64_t hash_bytes(const std::string& text, std::uint64_t seed = 0) {
  return hash_bytes(text.data(), text.size(), seed);
}

/// Sixteen lower-case hexadecimal digits.
inline std::string hash_text(std::uint64_t hash) {
  std::string text(16, '0');
  for (int i = 15; i >= 0; --i, hash >>= 4) text[static_cast<std::size_t>(i)] = "0123456789abcdef"[hash & 15];
  return text;
}

}  // namespace pliant
