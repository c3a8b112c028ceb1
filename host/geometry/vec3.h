// A point or vector in space, as all set-up code has it.
#pragma once
#include <array>

namespace pliant {

using Vec3d = std::array<double, 3>;

}  // namespace pliant
