// The negative of what fma gives.
#pragma once
#include <bit>
#include <cstdint>
#include <type_traits>

namespace pliant::ref {

/// -x for an x that comes out of fma. g++ makes one instruction of -fma(a, b, c), which gives +0 where the sum is zero; that of
/// a kernel is -0. So the sign is turned as a bit, which g++ leaves alone.
template <class Scalar>
inline Scalar minus(Scalar x) {
  using Bits = std::conditional_t<sizeof(Scalar) == 4, std::uint32_t, std::uint64_t>;
  return std::bit_cast<Scalar>(std::bit_cast<Bits>(x) ^ Bits{1} << (8 * sizeof(Scalar) - 1));
}

}  // namespace pliant::ref
