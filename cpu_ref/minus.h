// Negation of an fma result with the sign of zero preserved.
#pragma once
#include <bit>
#include <cstdint>
#include <type_traits>

namespace pliant::ref {

/// Returns -x for the result x of an fma. g++ contracts -fma(a, b, c) to one instruction, which returns +0 for a zero sum
/// where the kernel returns -0. Flipping the sign bit avoids this.
template <class Scalar>
[[gnu::always_inline]] inline Scalar minus(Scalar x) {
  using Bits = std::conditional_t<sizeof(Scalar) == 4, std::uint32_t, std::uint64_t>;
  return std::bit_cast<Scalar>(std::bit_cast<Bits>(x) ^ Bits{1} << (8 * sizeof(Scalar) - 1));
}

}  // namespace pliant::ref
