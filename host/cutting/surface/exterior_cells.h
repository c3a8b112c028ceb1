// Continues the cut through cells that the lattice does not have. The surface may stick out of the lattice by a fraction of a
// cell; what sticks out is divided like the material next to it.
#pragma once
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "cutting/surface/cell_interface.h"

namespace pliant::overlay {

class ExteriorCells {
 public:
  /// `cell_at`: the cell of the lattice of each grid number, or -1; has to outlive this object, like `source`.
  ExteriorCells(const SurfaceSource& source, const std::vector<std::int32_t>& cell_at);
  ~ExteriorCells();

  /// Cells of the lattice that changed, one component or more. Returns the cells of air around them that hold surface, as they
  /// are to be cut now: a function of all cells cut so far.
  std::vector<CutGridCell> update(const std::vector<CutGridCell>& changed);

 private:
  struct Block;
  struct Crossing {
    double at = -1;
    std::int32_t when = 0;
  };
  const Block& block(const GridIndex& corner);
  [[nodiscard]] std::int32_t lattice_cell(const GridIndex& cell) const;
  [[nodiscard]] const CutGridCell* cut_cell(const GridIndex& cell) const;
  [[nodiscard]] GridIndex anchor(const GridIndex& corner);
  [[nodiscard]] Crossing crossing(const GridIndex& a, const GridIndex& b);
  [[nodiscard]] Carrier carrier(const GridIndex& cell, const GridIndex& corner);
  CutGridCell cut(const GridIndex& cell);

  const SurfaceSource& source_;
  const std::vector<std::int32_t>& cell_at_;
  std::unordered_map<std::int64_t, CutGridCell> cut_;  ///< completely cut cells of the lattice
  std::unordered_map<std::int64_t, Block> blocks_;     ///< of one update
};

}  // namespace pliant::overlay
