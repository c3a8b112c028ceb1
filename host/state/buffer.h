// The table of named texel buffers. Allocation, hashing, dumping, NaN-filling and comparison are all driven by it.
#pragma once
#include <cstddef>
#include <cstdint>
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

using BufferId = std::int32_t;

/// One row of the table. `count` counts elements of `type` (a real4 holds four reals).
struct Buffer {
  std::string name;
  BufferType type = BufferType::real;
  std::size_t count = 0;
  BufferRole role = BufferRole::scratch;
  std::string shape;               ///< for people: "[nodes]", "[tiles][10][16]"
  std::string unit;                ///< "m", "N", "1"
  std::string producer;            ///< the kernel that writes it, or "model" or "host"
  std::vector<double> reals;       ///< initial values; empty means zero. Rounded once to the backend's real type.
  std::vector<std::int32_t> ints;  ///< initial values; empty means zero

  /// Numbers of four (or, in a double backend, eight) bytes.
  [[nodiscard]] std::size_t values() const { return type == BufferType::real4 ? 4 * count : count; }
  [[nodiscard]] bool is_int() const { return type == BufferType::int32; }
};

}  // namespace pliant
