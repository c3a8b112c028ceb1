#include "solver/buffer_checks.h"

#include <fmt/format.h>

#include <algorithm>

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

void round_reals(const std::vector<double>& values, float* out) {
  std::transform(values.begin(), values.end(), out, [](double v) { return static_cast<float>(v); });
}

void round_reals(const std::vector<double>& values, double* out) { std::copy(values.begin(), values.end(), out); }

}  // namespace pliant
