// Sizes shared by the contact passes and the host.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/contact/contact.h"

namespace pliant {

inline constexpr std::int32_t contact_look_every = 16;   ///< steps between two possible broad-phase searches
inline constexpr std::size_t contact_pose_numbers = 15;  ///< per step and tool in tool_pose (kernels/contact/contact_point.cl)
inline constexpr std::size_t contact_list_end = 16;      ///< empty entries at the end of a list of tiles
inline constexpr std::size_t contact_sum_parts = 16;    ///< per step and tool in tool_sum (kernels/contact/contact_tool_sum.cl)
inline constexpr std::size_t contact_sum_numbers = 18;  ///< per part
inline constexpr double contact_spread_parts =
    64;  ///< of the margin: the unit of way of spreading (kernels/contact/contact_sum.cl)

/// The values of the buffer tool_grid: the distances of all tools one after another, at least one value [m].
inline std::vector<double> tool_grid(const ToolForms& forms) {
  std::vector<double> grid;
  for (const ToolForm& form : forms) grid.insert(grid.end(), form.distance.begin(), form.distance.end());
  if (grid.empty()) grid.push_back(0);
  return grid;
}

}  // namespace pliant
