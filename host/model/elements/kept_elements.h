// Elements that are what they were in an earlier model of the same bodies. A cut or a tear changes the nodes of elements, but
// few of their shapes, and the highest frequency of a shape takes longer to find than all else in a model.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "model/model.h"

namespace pliant {

class KeptElements {
 public:
  /// Those of a batch of `earlier` (may be null; must outlive it) with the kind, body and material of `now`.
  KeptElements(const Model* earlier, const ElementBatch& now);

  struct Numbers {
    std::span<const double> record;
    double frequency;  ///< ElementBatch::frequency [1/s]
  };
  /// Element `e` of the body, if its corners were at `x` at rest [m].
  [[nodiscard]] std::optional<Numbers> find(std::size_t e, std::span<const Vec3d> x) const;

 private:
  const Model* earlier_;
  const ElementBatch* batch_ = nullptr;
  std::vector<std::int32_t> place_;  ///< in batch_, of each element of the body, -1: none
};

}  // namespace pliant
