// How a simulation ends that cannot go on.
#pragma once
#include <cstdint>
#include <string>

namespace pliant {

/// The first element whose J stopped being a positive, finite number.
struct Divergence {
  std::int64_t step = 0;  ///< the step in which it was seen
  double time = 0;        ///< [s]
  std::string body;
  std::int64_t element = -1;        ///< number in its body
  bool node = false;                ///< `element` is the number of a node that shape matching moves
  double dt = 0, stable_dt = 0;     ///< [s]
  std::int64_t last_good_step = 0;  ///< the state that the simulation now holds
  [[nodiscard]] std::string message() const;
};

}  // namespace pliant
