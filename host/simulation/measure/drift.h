// Pieces that nothing holds fly as far as they like. In float the elements of a piece far from its place at rest see places
// that are rounded more coarsely than they deform, and gain energy; so node_u leaves out how far the piece has flown.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "simulation/state/run_context.h"

namespace pliant {

class Drift {
 public:
  explicit Drift(RunContext& run) : run_(run) {}

  /// For every piece that nothing holds and that is further from its place at rest than its own size: take its mean
  /// displacement out of node_u and into RunState::offset, in multiples of a power of two, so that hardly anything is rounded.
  /// To be called where states are kept, before they are.
  void follow();

 private:
  /// Nodes that elements, or regions of shape matching, hang together.
  struct Piece {
    std::vector<std::int32_t> slots;
    double size = 0;  ///< [m] longest side of its box at rest
  };
  void find_loose_pieces();
  /// Shape matching remembers the displacement that its last goals were relative to. `before`: RunState::offset until now.
  void move_references(const std::vector<double>& before);

  RunContext& run_;
  std::shared_ptr<const Model> model_;  ///< whose pieces these are
  std::vector<Piece> loose_;
};

}  // namespace pliant
