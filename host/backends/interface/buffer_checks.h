// What both backends check and convert when numbers go into their buffers or come back. Each check throws
// Error(ErrorCode::internal) that names the buffer.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "program/buffer.h"

namespace pliant {

/// A program with `buffers` buffers has one of this id.
void check_id(BufferId id, std::size_t buffers);

/// The buffer holds integers, or reals, as asked for.
void check_type(const Buffer& buffer, bool ints);

/// The buffer holds `size` values.
void check_size(const Buffer& buffer, std::size_t size);

/// One can be copied onto the other: both hold as many values of the same kind.
void check_copy(const Buffer& from, const Buffer& to);

/// How many initial values the buffer has; the rest is zero. Checks that they fit into it.
std::size_t initial_count(const Buffer& buffer);

/// Rounds each value once to the backend's real type, in the rounding mode of the calling thread.
void round_reals(std::span<const double> values, float* out);
void round_reals(std::span<const double> values, double* out);

/// Where the initial values of `next` differ in a bit from those of `before`, or lie beyond its end. Ranges that are close to
/// each other are one.
std::vector<ValueRange> changed_values(const Buffer& before, const Buffer& next);

/// The buffer of this name, kind and role in a table, or nullptr; `near` is where it probably stands.
const Buffer* find_same(const std::vector<Buffer>& table, const Buffer& wanted, std::size_t near);

}  // namespace pliant
