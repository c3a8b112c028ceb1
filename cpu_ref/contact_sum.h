// Twin of kernels/contact_sum.cl, which says what is computed.
#pragma once
#include <atomic>
#include <bit>

#include "contact_point.h"

namespace pliant::ref::contact {

inline constexpr std::int64_t sum_numbers = 16;

using Quanta = std::array<std::int32_t, 3>;

template <class Scalar>
inline Quanta quanta(const Vec<Scalar>& force, Scalar inverse) {
  return {quanta(force[0] * inverse), quanta(force[1] * inverse), quanta(force[2] * inverse)};
}

inline void add(std::int32_t& sum, std::int32_t value) {
  std::atomic_ref<std::int32_t>(sum).fetch_add(value, std::memory_order_relaxed);
}
inline void add_quanta(std::int32_t* sum, std::int32_t value) {
  add(sum[0], value >> 15);
  add(sum[1], value & 32767);
}

template <class Scalar>
struct ToolSum {
  std::int32_t* sum;
  const Scalar* params;
  const Tools<Scalar>& tools;

  [[nodiscard]] std::int32_t* of(std::int32_t t) const {
    return &sum[sum_numbers * (std::int64_t{tools.step} * tools.count + t)];
  }
  void force(std::int32_t t, const Vec<Scalar>& p, const Quanta& q) const {
    const Vec<Scalar> arm = difference(p, origin_of(tools.next(t)));
    const Scalar scale = params[0] * params[3];
    Vec<Scalar> f{};
    for (std::size_t k = 0; k < 3; ++k) {
      f[k] = static_cast<Scalar>(-q[k]) * scale;
      add_quanta(of(t) + 2 * k, -q[k]);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      add_quanta(of(t) + 6 + 2 * k, quanta(std::fma(arm[i], f[j], -(arm[j] * f[i]))));
    }
  }
  void touch(std::int32_t t, Scalar area, Scalar depth) const {
    add_quanta(of(t) + 12, quanta(area * params[4]));
    const auto bits = std::bit_cast<std::int32_t>(static_cast<float>(depth > Scalar(0) ? depth : Scalar(0)));
    std::atomic_ref<std::int32_t> deepest(of(t)[14]);
    for (std::int32_t seen = deepest.load(std::memory_order_relaxed);
         seen < bits && !deepest.compare_exchange_weak(seen, bits, std::memory_order_relaxed);) {
    }
    add(of(t)[15], 1);
  }
};

}  // namespace pliant::ref::contact
