// Iterates over the finite elements of a Model, whether they are in lists or in bricks.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "elements/elements.h"
#include "layout.h"
#include "model/model.h"

namespace pliant {

struct ElementView {
  ElementKind kind;
  std::int32_t body;
  std::int64_t id;  ///< index in the body
  std::span<const std::int32_t> slots;
  const Material& material;
  std::span<const double> record;
  double share;    ///< fraction of a full element's stiffness, by fill and modulus
  double modulus;  ///< relative to the material's
  [[nodiscard]] double volume() const { return element_volume(kind, record); }  ///< undeformed volume of a full element [m^3]
};

/// Returns the slots of the corners of the brick cell whose low corner is `slot`.
std::array<std::int32_t, 8> brick_cell_corners(const Model& model, std::int32_t slot);

/// Calls f(ElementView) for every element.
template <class F>
void for_each_element(const Model& model, const F& f) {
  for (const ElementBatch& batch : model.batches) {
    for (std::size_t e = 0; e < batch.size(); ++e) {
      f(ElementView{batch.kind, batch.body, batch.id[e], batch.nodes_of(e), batch.material, batch.record_of(e), batch.share[e],
                    model.bodies[batch.body].materials.modulus_of(batch.id[e])});
    }
  }
  for (const BrickBatch& batch : model.brick_batches) {
    const std::vector<double> record = batch.record();
    const std::int32_t first = batch.first * PLIANT_BRICK_NODES, end = first + batch.count * PLIANT_BRICK_NODES;
    for (std::int32_t slot = first; slot < end; ++slot) {
      if (!(model.brick_fill[slot] > 0)) continue;
      const std::array<std::int32_t, 8> corners = brick_cell_corners(model, slot);
      f(ElementView{BrickBatch::kind(), model.brick_body[slot / PLIANT_BRICK_NODES], model.brick_cell[slot], corners,
                    batch.material, record, model.brick_fill[slot], 1});
    }
  }
}

/// Returns the values at its `N` corners, a column each. `of(slot)` returns a vector.
template <int N, class Of>
Eigen::Matrix<double, 3, N> corner_values(const ElementView& e, const Of& of) {
  Eigen::Matrix<double, 3, N> u;
  for (int a = 0; a < N; ++a) u.col(a) = of(e.slots[a]);
  return u;
}

/// Calls f(gradients [corners][3] [1/m], weight [m^3], u) for each quadrature point. `u`: displacements of the corners from
/// `of(slot)`, a column each [m]. The weight includes the element's share.
template <class Of, class F>
void for_each_point(const ElementView& e, const Of& of, const F& f) {
  with_element(e.kind, [&](auto element) {
    using Type = decltype(element);
    const auto u = corner_values<Type::info.corners>(e, of);
    Type::for_each_point(e.record, [&](const auto& gradients, double weight) { f(gradients, e.share * weight, u); });
  });
}

/// Hourglass control: its energy [J], and an upper bound of its stiffness [N/m], at these displacements.
template <class Of>
double hourglass_energy(const ElementView& e, const Of& of) {
  return with_element(e.kind, [&](auto element) {
    using Type = decltype(element);
    return e.share * Type::hourglass_energy(e.record, corner_values<Type::info.corners>(e, of));
  });
}
template <class Of>
double hourglass_bound(const ElementView& e, const Of& of) {
  return with_element(e.kind, [&](auto element) {
    using Type = decltype(element);
    return e.share * Type::hourglass_bound(e.record, corner_values<Type::info.corners>(e, of));
  });
}

}  // namespace pliant
