// Sizes shared by the passes of blades that cut by force and the host (kernels/contact/blade_press.cl).
#pragma once
#include <cstddef>

namespace pliant {

inline constexpr std::size_t blade_sample_nodes = 8;     ///< that carry the front point of a sample
inline constexpr std::size_t blade_sample_numbers = 12;  ///< per sample in blade_data
inline constexpr std::size_t blade_pose_numbers = 6;     ///< per step and blade in blade_pose
inline constexpr std::size_t blade_force_numbers = 4;    ///< per step and sample in blade_force

}  // namespace pliant
