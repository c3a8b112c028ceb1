// What a simulation reports, and what it needs beside its buffers to go on.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

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

/// What a run needs beside its buffers to go on with the same bits.
struct SimulationState {
  std::int64_t step = 0, origin_step = 0;
  double origin_time = 0, dt = 0, stable_dt = 0, damping = 0;
  double caution = 1;                                  ///< share of the estimate that an automatic step still trusts
  std::map<std::string, std::vector<double>> vectors;  ///< what dynamic relaxation and the automatic step remember
};

/// Where a blade is to go.
struct BladePlace {
  std::string blade;               ///< any name
  std::array<Vec3d, 2> segment{};  ///< [m]
};

/// What an edit of the topology did, and the time it took [s]. `surface` is what the model waited for its surface.
struct CutReport {
  std::int64_t edges = 0;  ///< newly cut
  bool changed = false;    ///< whether elements were split
  double search = 0, topology = 0, surface = 0, model = 0, upload = 0;
  [[nodiscard]] double seconds() const { return search + topology + surface + model + upload; }
};

}  // namespace pliant
