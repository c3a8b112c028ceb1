// Twin of kernels/contact/contact_tool_sum.cl.
#include "cpu_ref/contact/contact_sum.h"
#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar>
void contact_tool_sum(Range range, const std::int32_t* contact_tool_force, const Scalar* contact_rest,
                      const std::int32_t* contact_list, const std::int32_t* contact_near, std::int32_t* tool_sum,
                      const Scalar* contact_params, std::int32_t point_count, std::int32_t tools, std::int32_t step) {
  using namespace contact;
  constexpr std::int64_t parts = 16, numbers = 18;
  for (std::int64_t item = range.begin; item < range.end; ++item) {
    const auto t = static_cast<std::int32_t>(item / parts);
    std::array<std::int64_t, 8> sum{};
    std::int32_t deepest = 0, count = 0;
    for (std::int64_t k = item % parts; contact_list[k] >= 0; k += parts) {
      const std::int64_t tile = contact_list[k];
      if ((contact_near[tile] >> t & 1) == 0) continue;
      for (std::int64_t i = tile * PLIANT_TILE; i < (tile + 1) * PLIANT_TILE; ++i) {
        const PointNumbers<const std::int32_t> force = tool_force_of(contact_tool_force, point_count, t, i);
        if (force[7] == 0) continue;
        for (std::size_t c = 0; c < 6; ++c) sum[c] += force[static_cast<std::int64_t>(c)];
        sum[6] += quanta(contact_rest[tile_base(i, 4) + std::int64_t{3} * PLIANT_TILE] * contact_params[4]);
        deepest = std::max(deepest, force[6]);
        sum[7] += force[7] >> 1;
        ++count;
      }
    }
    std::int32_t* out = tool_sum + numbers * (std::int64_t{step} * tools * parts + item);
    for (std::size_t c = 0; c < 8; ++c) {
      const std::size_t at = c < 7 ? 2 * c : 16;
      out[at] = static_cast<std::int32_t>(sum[c] >> 15);
      out[at + 1] = static_cast<std::int32_t>(sum[c] & 32767);
    }
    out[14] = deepest;
    out[15] = count;
  }
}

void register_contact_tool_sum(Registry& registry) {
  registry.add("contact_tool_sum", contact_tool_sum<float>, contact_tool_sum<double>);
}

}  // namespace pliant::ref
