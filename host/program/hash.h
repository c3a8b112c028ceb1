// XXH3, 64 bits, of bytes: golden runs, checkpoints, comparisons. Not cryptographic. `xxhsum -H3` computes it for a file.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace pliant {

/// Hash of bytes that come piece by piece: that of one block with all of them.
class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(Hasher&&) noexcept;
  Hasher& operator=(Hasher&&) noexcept;

  void add(const void* data, std::size_t size);
  [[nodiscard]] std::uint64_t value() const;  ///< of what has come so far; more may follow

 private:
  struct State;
  std::unique_ptr<State> state_;
};

[[nodiscard]] std::uint64_t hash_bytes(const void* data, std::size_t size);
[[nodiscard]] std::uint64_t hash_bytes(const std::string& text);

/// Sixteen lower-case hexadecimal digits, as xxhsum prints them.
[[nodiscard]] std::string hash_text(std::uint64_t hash);

}  // namespace pliant
