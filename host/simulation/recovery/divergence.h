// Description of a divergence.
#pragma once
#include <cstdint>
#include <string>

namespace pliant {

/// The first element or node that was lost: not finite, or with "inverted": "stop" an element with J <= 0.
struct Divergence {
  std::int64_t step = 0;  ///< the step in which it was detected
  double time = 0;        ///< [s]
  std::string body;
  std::int64_t element = -1;        ///< index in its body
  bool node = false;                ///< true if `element` is the index of a node, which shape matching or springs move
  double dt = 0, stable_dt = 0;     ///< [s]
  std::int64_t last_good_step = 0;  ///< step of the state that the simulation now holds
  [[nodiscard]] std::string message() const;
};

}  // namespace pliant
