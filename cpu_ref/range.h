// The part of a pass that one call of a twin processes.
#pragma once
#include <cstdint>

namespace pliant::ref {

/// Indices begin .. end - 1: elements or nodes (`lanes`, begin and end multiples of 16; `items`) or bricks (`bricks`).
struct Range {
  std::int64_t begin = 0, end = 0;
};

}  // namespace pliant::ref
