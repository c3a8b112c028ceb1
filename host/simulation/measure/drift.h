// Keeps displacements of free pieces small. Far from its rest position, a piece has displacements that float rounds more
// coarsely than its elements deform, which adds energy. So node_u holds the displacement without the distance that the piece
// has travelled.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "simulation/state/run_context.h"

namespace pliant {

class Drift {
 public:
  explicit Drift(RunContext& run) : run_(run) {}

  /// For every unconstrained piece that is further from its rest position than its own size: moves its mean displacement from
  /// node_u to RunState::offset, in multiples of a power of two so that hardly anything is rounded. Call just before states
  /// are kept.
  void follow();

 private:
  /// Nodes that elements or shape-matching regions connect.
  struct Piece {
    std::vector<std::int32_t> slots;
    double size = 0;  ///< longest side of its undeformed bounding box [m]
  };
  void find_loose_pieces();
  /// Shifts the displacements that shape matching stores as references of its last goals. `before`: the previous
  /// RunState::offset.
  void move_references(const std::vector<double>& before);

  RunContext& run_;
  std::shared_ptr<const Model> model_;  ///< the model that loose_ belongs to
  std::vector<Piece> loose_;
};

}  // namespace pliant
