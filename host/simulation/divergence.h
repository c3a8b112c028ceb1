// How a simulation ends that cannot go on, and what it went through.
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

/// Elements that had J <= 0 and went on. Counted since the simulation was made: nothing that comes depends on it.
struct Inversions {
  std::int64_t batches = 0;     ///< in how many batches there were some
  std::int64_t most = 0;        ///< most of them in one batch
  std::int64_t last = 0;        ///< in the last batch
  std::int64_t first_step = 0;  ///< the first batch with some began with this step
  double first_time = 0;        ///< [s]
  std::int64_t calmed = 0;      ///< elements that lost relative motion (calm.h)
  std::string body;             ///< of one of the first
  std::int64_t element = -1;    ///< its number in the body
};

/// Inertia given to nodes whose elements asked for a shorter step than Scene::least_step. Counted likewise.
struct BallastReport {
  std::int64_t nodes = 0;  ///< now
  double mass = 0;         ///< now [kg]
  double most = 0;         ///< at any time [kg]
};

}  // namespace pliant
