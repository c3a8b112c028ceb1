// How finely a body is filled with a lattice: the key "lattice" of a body.
#pragma once
#include <cstdint>

namespace pliant {

struct LatticeSpec {
  double spacing = 0;      ///< edge of a cell [m]; 0 if `nodes` is given
  std::int64_t nodes = 0;  ///< wanted number of nodes; 0 if `spacing` is given
};

}  // namespace pliant
