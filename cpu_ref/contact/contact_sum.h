// Twin of contact_sum.cl and press_lanes.cl, which describe the computation (kernels/contact).
#pragma once
#include <bit>

#include "cpu_ref/contact/contact_point.h"

namespace pliant::ref::contact {

inline constexpr std::int64_t tool_force_numbers = 8;
inline constexpr int spread_parts = 64;

using Quanta = std::array<std::int32_t, 3>;

template <class Scalar>
[[gnu::always_inline]] inline Quanta quanta(const Vec<Scalar>& force, Scalar inverse) {
  return {quanta(force[0] * inverse), quanta(force[1] * inverse), quanta(force[2] * inverse)};
}

/// The first three numbers of a point.
template <class T, class Three>
inline void set_three(const PointNumbers<T>& numbers, const Three& v) {
  for (std::size_t k = 0; k < 3; ++k) numbers[static_cast<std::int64_t>(k)] = v[k];
}

/// The force of point i on tool t.
template <class Int>
inline PointNumbers<Int> tool_force_of(Int* contact_tool_force, std::int32_t points, std::int32_t t, std::int64_t i) {
  return {contact_tool_force + tool_force_numbers * points * t + tile_base(i, tool_force_numbers)};
}

/// Starts with zero force at this depth.
template <class Scalar>
inline void begin_touch(const PointNumbers<std::int32_t>& on_tool, Scalar depth) {
  for (std::int64_t k = 0; k < 6; ++k) on_tool[k] = 0;
  on_tool[6] = std::bit_cast<std::int32_t>(static_cast<float>(depth > Scalar(0) ? depth : Scalar(0)));
}

template <class Scalar>
inline void add_to_tool(const PointNumbers<std::int32_t>& on_tool, const Scalar* next_pose, const Scalar* params,
                        const Vec<Scalar>& p, const Quanta& q) {
  const Vec<Scalar> arm = difference(p, origin_of(next_pose));
  const Scalar scale = params[0] * params[3];
  Vec<Scalar> f{};
  for (std::size_t k = 0; k < 3; ++k) {
    f[k] = static_cast<Scalar>(-q[k]) * scale;
    on_tool[static_cast<std::int64_t>(k)] -= q[k];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    on_tool[static_cast<std::int64_t>(3 + k)] += quanta(std::fma(arm[i], f[j], -(arm[j] * f[i])));
  }
}

/// Notes the work by which a face of a blade spreads a point that still lies deeper in it by `lag`.
template <class Scalar>
inline void spread_by_face(const PointNumbers<std::int32_t>& on_tool, const Scalar* params, Scalar lag,
                           const Vec<Scalar>& normal, Scalar given) {
  const Vec<Scalar> f{static_cast<Scalar>(-on_tool[0]), static_cast<Scalar>(-on_tool[1]), static_cast<Scalar>(-on_tool[2])};
  const Scalar push = dot(f, normal) * ((given * Scalar(spread_parts)) / params[5]);
  on_tool[7] = 2 * quanta(lag > Scalar(0) && push > Scalar(0) ? push : Scalar(0)) + 1;
}

}  // namespace pliant::ref::contact
