// Numbers in network byte order, from and to bytes.
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace pliant::devices {

/// Reads numbers one after another. Beyond the end it reads 0 and good() is false from then on.
class BigEndianReader {
 public:
  explicit BigEndianReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  template <class Unsigned>
  Unsigned number() {
    if (bytes_.size() - at_ < sizeof(Unsigned)) good_ = false;
    Unsigned value = 0;
    for (std::size_t i = 0; good_ && i < sizeof(Unsigned); ++i) value = static_cast<Unsigned>(value << 8 | bytes_[at_ + i]);
    if (good_) at_ += sizeof(Unsigned);
    return value;
  }
  double float32() { return static_cast<double>(std::bit_cast<float>(number<std::uint32_t>())); }
  double float64() { return std::bit_cast<double>(number<std::uint64_t>()); }
  [[nodiscard]] bool good() const { return good_; }
  [[nodiscard]] bool at_end() const { return good_ && at_ == bytes_.size(); }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

/// Writes numbers one after another into memory that is known to be large enough.
class BigEndianWriter {
 public:
  explicit BigEndianWriter(std::uint8_t* bytes) : bytes_(bytes) {}
  void number(std::uint64_t value, std::size_t bytes) {
    for (std::size_t i = bytes; i-- > 0;) bytes_[size_++] = static_cast<std::uint8_t>(value >> (8 * i));
  }
  void float32(double value) { number(std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4); }
  void float64(double value) { number(std::bit_cast<std::uint64_t>(value), 8); }
  /// A text, and zeros up to `bytes` bytes.
  void text(const char* text, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) bytes_[size_++] = static_cast<std::uint8_t>(*text != '\0' ? *text++ : '\0');
  }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  std::uint8_t* bytes_;
  std::size_t size_ = 0;
};

}  // namespace pliant::devices
