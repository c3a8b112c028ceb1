// Sizes that the passes of contact share with the host.
#pragma once
#include <cstddef>
#include <cstdint>

namespace pliant {

inline constexpr std::int32_t contact_look_every = 16;   ///< steps between two looks for points that are near a tool
inline constexpr std::size_t contact_pose_numbers = 14;  ///< per step and tool in tool_pose (kernels/contact_point.cl)
inline constexpr std::size_t contact_sum_parts = 16;     ///< per step and tool in tool_sum (kernels/contact_tool_sum.cl)
inline constexpr std::size_t contact_sum_numbers = 16;   ///< per part

}  // namespace pliant
