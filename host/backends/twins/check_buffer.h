// A buffer as the checking backend keeps it: in two worlds that hold the same numbers except where nothing was written. There
// world 0 holds a quiet NaN and world 1 numbers between 1 and 2 of either sign, another at every place, so that whatever
// depends on such a value, also a copy of it, differs between the worlds. Integers are 17 and something from 32 to 63: one that
// is used as an index must not lead away from all buffers, or the process would end without a message.
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
  static constexpr std::ptrdiff_t kZone = 256;  ///< values before and behind the buffer that nothing may write
  static constexpr int kWorlds = 2;

  /// Initial values in both worlds. Throws Error if they do not fit.
  CheckBuffer(const Buffer& row, BufferId id);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::ptrdiff_t values() const { return values_; }
  /// Whether passes may write into it at all.
  [[nodiscard]] bool writable() const { return role_ == BufferRole::state || role_ == BufferRole::scratch; }

  /// As an argument of a twin that runs in this world.
  [[nodiscard]] ArgValue<float> argument(int world);
  /// The bits of value i; from -kZone to values() + kZone.
  [[nodiscard]] std::uint32_t bits(int world, std::ptrdiff_t i) const { return bits_in(worlds_[world], i); }
  [[nodiscard]] static std::uint32_t bits_in(const WorldImage& image, std::ptrdiff_t i);
  [[nodiscard]] const unsigned char* bytes(int world) const { return &worlds_[world][4 * kZone]; }

  /// New values from the host, four bytes each: they hold in both worlds.
  void write(const void* values);
  /// Make scratch undefined that the step before leaves nothing in.
  void begin_step();

  /// What a pass did: each is the first place of its kind, if there is one.
  [[nodiscard]] std::optional<std::ptrdiff_t> written_outside() const;
  /// A value that keeps what the host gave and does so no more: of constant and control buffers, and of the fixed end of
  /// scratch.
  [[nodiscard]] std::optional<std::ptrdiff_t> changed() const;
  /// A value that was written and depends on what was not.
  [[nodiscard]] std::optional<std::ptrdiff_t> doubtful() const;
  /// A value that nothing wrote.
  [[nodiscard]] std::optional<std::ptrdiff_t> unwritten() const;
  /// Remember which values passes write, where the others keep their initial ones.
  void note_written();

  /// Of the bytes of a whole world: for running a pass again.
  [[nodiscard]] const WorldImage& image(int world) const { return worlds_[world]; }
  void set_image(int world, const WorldImage& image) { worlds_[world].assign(image.begin(), image.end()); }

 private:
  [[nodiscard]] std::uint32_t poison(int world, std::ptrdiff_t i) const;
  [[nodiscard]] bool undefined(std::ptrdiff_t i) const { return bits(0, i) == poison(0, i) && bits(1, i) == poison(1, i); }
  /// Whether a step may find nothing in it.
  [[nodiscard]] bool may_be_undefined() const { return role_ == BufferRole::scratch && carried_ != Carried::all; }
  void fill_poison(std::ptrdiff_t first, std::ptrdiff_t last);
  /// The first i of [first, last) where two rows of values differ and `counts(i)`.
  template <class Counts>
  static std::optional<std::ptrdiff_t> first_difference(const unsigned char* a, const unsigned char* b, std::ptrdiff_t first,
                                                        std::ptrdiff_t last, Counts&& counts);

  std::string name_;
  BufferId id_;
  BufferRole role_;
  Carried carried_;
  bool is_int_;
  std::ptrdiff_t values_, fixed_;  ///< fixed_: the first of the fixed end
  WorldImage worlds_[kWorlds];
  std::vector<unsigned char> kept_;  ///< what the host wrote last
  std::vector<char> written_;        ///< by passes, where that counts
};

}  // namespace pliant::ref
