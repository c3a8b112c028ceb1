// The table of named texel buffers. Allocation, hashing, comparison and what the checking backend fills with NaN
// (host/backends/twins/check_backend.h) are all driven by it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pliant {

enum class BufferType {
  real,   ///< one real per element (float on OpenCL)
  real4,  ///< a texel of four reals
  int32,  ///< one 32-bit integer
};

/// What happens to a buffer during a run.
enum class BufferRole {
  constant,  ///< part of the Model: never written by a kernel
  state,     ///< carries the simulation from step to step: checkpointed, hashed, compared
  scratch,   ///< written and read within a step: compared, not checkpointed
  control,   ///< written by the host between batches (step parameters, curve values)
};

/// What scratch still holds when the next step begins. Anything else is of no use: passes write it before they read it.
enum class Carried {
  nothing,    ///< all of it is written anew
  unwritten,  ///< values that no pass ever writes keep their initial values
  all,        ///< what passes wrote in the steps before counts
};

using BufferId = std::int32_t;

/// Values [first, last) of a buffer.
struct ValueRange {
  std::size_t first = 0, last = 0;
};

/// One row of the table. `count` counts elements of `type` (a real4 holds four reals).
struct Buffer {
  std::string name;
  BufferType type = BufferType::real;
  std::size_t count = 0;
  BufferRole role = BufferRole::scratch;
  std::string shape;               ///< for people: "[nodes]", "[tiles][10][16]"
  std::string unit;                ///< "m", "N", "1"
  std::string producer;            ///< the kernel that writes it, or "model" or "host"
  std::vector<double> reals;       ///< initial values, rounded once to the backend's real type; missing ones are `padding`
  std::vector<std::int32_t> ints;  ///< initial values; missing ones are zero
  double padding = 0;
  /// Where the initial values differ from those that the program before had, if that is known; ascending. What lies beyond the
  /// end of those need not be in it.
  std::optional<std::vector<ValueRange>> changed = std::nullopt;
  Carried carried = Carried::nothing;  ///< of scratch
  std::size_t fixed = 0;               ///< of scratch: so many values at its end no pass writes; they keep their initial values
  BufferId copy_of = -1;               ///< the state buffer whose last good values this one keeps

  /// Numbers of four (or, in a double backend, eight) bytes.
  [[nodiscard]] std::size_t values() const { return type == BufferType::real4 ? 4 * count : count; }
  [[nodiscard]] bool is_int() const { return type == BufferType::int32; }
};

}  // namespace pliant
