// The table of named buffers. It drives allocation, hashing, comparison, and the NaN filling of the checking backend
// (host/backends/twins/check_backend.h).
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

/// Role of a buffer during a run.
enum class BufferRole {
  constant,  ///< part of the Model: no kernel writes it
  state,     ///< carries the simulation from step to step: checkpointed, hashed, compared
  scratch,   ///< written and read within a step: compared, not checkpointed
  control,   ///< written by the host between batches (step parameters, curve values)
};

/// Contents of a scratch buffer at the start of the next step. Other values must be written before they are read.
enum class Carried {
  nothing,    ///< everything is rewritten in each step
  unwritten,  ///< values that no pass ever writes keep their initial values
  all,        ///< values written by passes of earlier steps are used
};

/// What an edit that makes nodes, elements or regions anew (a cut, a tear, a moved region, other substeps) does to a state
/// buffer. Edits that leave all of them what they are (changed parameters, tools that come and go, joins that break, ballast)
/// keep every state buffer.
enum class Carry {
  undeclared,  ///< Program::add refuses it for a state buffer
  drop,        ///< begins anew from the new Program's initial values: pairs, points and regions are found again
  copy,        ///< [slots]: every copy of a node has the value of the node it was copied from
  velocity,    ///< [slots], what the integrator keeps of the motion: every copy of a node has its velocity, and held nodes none
};

/// How a state buffer names tools. Their numbers change where tools come and go.
enum class ToolNumbers {
  none,
  bits,    ///< integers whose bit t stands for tool t
  second,  ///< in tiles of two planes, the second: the tool's number + 1, or 0 for none
  fourth,  ///< in tiles of four planes, the fourth: the tool's number + 1, or 0 for none
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
  std::string shape;               ///< for display: "[nodes]", "[tiles][10][16]"
  std::string unit;                ///< "m", "N", "1"
  std::string producer;            ///< the kernel that writes it, "model" or "host"
  std::vector<double> reals;       ///< initial values, rounded once to the backend's real type; the rest is `padding`
  std::vector<std::int32_t> ints;  ///< initial values; the rest is 0
  double padding = 0;
  /// Ranges in which the initial values differ from those of the previous program, ascending; empty optional if unknown.
  /// Values beyond the end of the previous buffer need not be listed.
  std::optional<std::vector<ValueRange>> changed = std::nullopt;
  Carried carried = Carried::nothing;  ///< scratch only
  std::size_t fixed =
      0;  ///< scratch only: number of values at the end that no pass writes, so that they keep their initial values
  Carry carry = Carry::undeclared;        ///< state only
  ToolNumbers tools = ToolNumbers::none;  ///< state only
  BufferId copy_of = -1;                  ///< the state buffer of which this one keeps the last good values

  /// Number of values of four (in a double backend eight) bytes.
  [[nodiscard]] std::size_t values() const { return type == BufferType::real4 ? 4 * count : count; }
  [[nodiscard]] bool is_int() const { return type == BufferType::int32; }
};

}  // namespace pliant
