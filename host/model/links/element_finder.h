// Elements of a body at places at rest. Private to host/model/links.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "geometry/spatial_hash.h"
#include "model/elements/body_mesh.h"

namespace pliant {

/// A point in an element: nodes of the body with their weights.
struct Held {
  std::int32_t element = -1;
  std::array<std::int32_t, 4> nodes{};
  std::array<double, 4> weights{};
};

/// Finds the element that holds a point at rest. Of the copies of a cut element it is the one with most of the point's weight
/// on nodes that have material there.
class ElementFinder {
 public:
  /// Most times that a line is halved until its parts lie in elements that touch.
  static constexpr int kHalvings = 12;

  /// Refers to `solid`.
  explicit ElementFinder(const BodyElements& solid);
  /// Element -1: no element holds it.
  [[nodiscard]] Held find(const Vec3d& p);
  /// Number of corners of two elements at the same places, and of nodes that they have in common.
  [[nodiscard]] int common_places(std::int32_t e, std::int32_t f) const { return pairs(e, f, true); }
  [[nodiscard]] int common_nodes(std::int32_t e, std::int32_t f) const { return pairs(e, f, false); }

 private:
  [[nodiscard]] std::optional<Held> in_tet(std::int32_t e, const std::array<std::int32_t, 4>& nodes, const Vec3d& p) const;
  [[nodiscard]] std::optional<Held> in_element(std::int32_t e, const Vec3d& p) const;
  [[nodiscard]] double real_weight(const Held& held) const;
  [[nodiscard]] int pairs(std::int32_t e, std::int32_t f, bool places) const;

  const BodyElements& solid_;
  double edge_ = 0;  ///< about that of an element [m]
  SpatialHash hash_;
};

}  // namespace pliant
