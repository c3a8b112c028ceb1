// Checks and conversions of buffer contents, shared by the backends. Each check throws Error(ErrorCode::internal) with the
// name of the buffer.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "program/buffer.h"

namespace pliant {

/// Checks that a program with `buffers` buffers has this id.
void check_id(BufferId id, std::size_t buffers);

/// Checks that the buffer holds integers or reals, as requested.
void check_type(const Buffer& buffer, bool ints);

/// Checks that the buffer holds `size` values.
void check_size(const Buffer& buffer, std::size_t size);

/// Checks that one can be copied to the other: the same number of values of the same kind.
void check_copy(const Buffer& from, const Buffer& to);

/// Returns the number of initial values given; the rest is Buffer::padding. Checks that they fit into the buffer.
std::size_t initial_count(const Buffer& buffer);

/// Rounds each value once to the backend's real type, in the rounding mode of the calling thread.
void round_reals(std::span<const double> values, float* out);
void round_reals(std::span<const double> values, double* out);

/// Returns the ranges in which the initial values of `next` differ in a bit from those of `before` or lie beyond its end.
/// Nearby ranges are merged.
std::vector<ValueRange> changed_values(const Buffer& before, const Buffer& next);

/// Returns the buffer with the same name, type and role in a table, or nullptr; `near` is its probable index.
const Buffer* find_same(const std::vector<Buffer>& table, const Buffer& wanted, std::size_t near);

}  // namespace pliant
