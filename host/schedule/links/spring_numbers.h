// Numbers of springs for the kernels of links.
#pragma once
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "model/links/links.h"

namespace pliant {

/// Numbers of one spring (kernels/links/spring_pull.cl).
struct SpringRecord {
  Vec3d rest{};        ///< D, from the first end to the second [m]
  double length = 0;   ///< l0 [m]
  double squares = 0;  ///< |D|^2 - l0^2 [m^2]
  double first = 0, second = 0;
  double damper = 0;  ///< [N s/m]
};
SpringRecord spring_record(const LinkPoints& points, const SpringBatch& b, std::size_t s);

/// Defines of the kernels for the springs of a batch.
std::vector<std::pair<std::string, int>> spring_defines(const SpringBatch& b);

}  // namespace pliant
