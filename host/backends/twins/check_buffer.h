// A buffer of the checking backend, stored in two worlds with the same numbers, except where nothing was written. There,
// world 0 contains a quiet NaN and world 1 a number between 1 and 2 of either sign, different at every place, so that
// everything that depends on such a value, including a copy, differs between the worlds. For integers the values are 17 and a
// number from 32 to 63: if used as an index, they must stay within some buffer, or the process would end without a message.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cpu_ref/twin.h"
#include "program/buffer.h"

namespace pliant::ref {

/// Bytes of one world: zone, values, zone.
using WorldImage = std::vector<unsigned char>;

class CheckBuffer {
 public:
  static constexpr std::ptrdiff_t kZone = 256;  ///< number of guard values before and after the buffer
  static constexpr int kWorlds = 2;

  /// Sets initial values in both worlds. Throws Error if they do not fit.
  CheckBuffer(const Buffer& row, BufferId id);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::ptrdiff_t values() const { return values_; }
  /// Returns true if passes may write to it.
  [[nodiscard]] bool writable() const { return role_ == BufferRole::state || role_ == BufferRole::scratch; }

  /// Returns the buffer as an argument of a twin that runs in this world.
  [[nodiscard]] ArgValue<float> argument(int world);
  /// Returns the bits of value i, from -kZone to values() + kZone.
  [[nodiscard]] std::uint32_t bits(int world, std::ptrdiff_t i) const { return bits_in(worlds_[world], i); }
  [[nodiscard]] static std::uint32_t bits_in(const WorldImage& image, std::ptrdiff_t i);
  [[nodiscard]] const unsigned char* bytes(int world) const { return &worlds_[world][4 * kZone]; }

  /// Writes new values from the host, four bytes each, in both worlds.
  void write(const void* values);
  /// Makes scratch undefined that does not carry values from the previous step.
  void begin_step();

  /// Violations by a pass: each returns the first place of its kind, if any.
  [[nodiscard]] std::optional<std::ptrdiff_t> written_outside() const;
  /// A value that must keep what the host wrote but has changed: in constant and control buffers, and in the fixed end of
  /// scratch.
  [[nodiscard]] std::optional<std::ptrdiff_t> changed() const;
  /// A value that was written and depends on an unwritten value.
  [[nodiscard]] std::optional<std::ptrdiff_t> doubtful() const;
  /// A value that was not written.
  [[nodiscard]] std::optional<std::ptrdiff_t> unwritten() const;
  /// Records which values passes have written, for buffers whose other values keep their initial ones.
  void note_written();

  /// Saves and restores the bytes of a world, to run a pass again.
  [[nodiscard]] const WorldImage& image(int world) const { return worlds_[world]; }
  void set_image(int world, const WorldImage& image) { worlds_[world].assign(image.begin(), image.end()); }

 private:
  [[nodiscard]] std::uint32_t poison(int world, std::ptrdiff_t i) const;
  [[nodiscard]] bool undefined(std::ptrdiff_t i) const { return bits(0, i) == poison(0, i) && bits(1, i) == poison(1, i); }
  /// Returns true if values may be undefined: scratch that does not carry everything between steps.
  [[nodiscard]] bool may_be_undefined() const { return role_ == BufferRole::scratch && carried_ != Carried::all; }
  void fill_poison(std::ptrdiff_t first, std::ptrdiff_t last);
  /// Returns the first i in [first, last) at which two rows of values differ and `counts(i)`.
  template <class Counts>
  static std::optional<std::ptrdiff_t> first_difference(const unsigned char* a, const unsigned char* b, std::ptrdiff_t first,
                                                        std::ptrdiff_t last, Counts&& counts);

  std::string name_;
  BufferId id_;
  BufferRole role_;
  Carried carried_;
  bool is_int_;
  std::ptrdiff_t values_, fixed_;  ///< fixed_: index of the first value of the fixed end
  WorldImage worlds_[kWorlds];
  std::vector<unsigned char> kept_;  ///< last values written by the host
  std::vector<char> written_;        ///< marks of values written by passes, where needed
};

}  // namespace pliant::ref
