// The membranes on the surfaces of bodies, as Glisson's capsule around the liver.
#pragma once
#include "model/model.h"

namespace pliant {

/// Adds the membranes of all bodies to the links of a model that has its surfaces, if there are any: triangles between embedded
/// points, without those on cuts and without slivers, their masses, and their stiffness. Throws Error (bad_input) where more
/// than two triangles of a membrane meet at an edge, or where a body has no triangles.
void add_membranes(const Scene& scene, Model& model);

bool has_membranes(const Scene& scene);

/// Calls f(slot, gradient [2] [1/m]) for every slot that moves triangle t: the gradient, along the tangents of the triangle at
/// rest, of the displacement of that slot as the triangle has it.
template <class F>
void for_each_gradient(const LinkPoints& points, const MembraneBatch& b, std::size_t t, const F& f) {
  const Membrane::Record& r = b.records[t];
  const std::array<std::array<double, 2>, 3> corner{{{-r[6], -(r[7] + r[8])}, {r[6], r[7]}, {0, r[8]}}};
  std::array<std::int32_t, 24> slots{};
  std::array<std::array<double, 2>, 24> sums{};
  std::size_t count = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int32_t p = b.points[t][a];
    for (std::size_t k = 0; k < 8; ++k) {
      if (points.weights[p][k] == 0) continue;
      std::size_t at = 0;
      while (at < count && slots[at] != points.slots[p][k]) ++at;
      if (at == count) slots[count++] = points.slots[p][k];
      for (std::size_t c = 0; c < 2; ++c) sums[at][c] += points.weights[p][k] * corner[a][c];
    }
  }
  for (std::size_t i = 0; i < count; ++i) f(slots[i], sums[i]);
}

/// Adds to `sum` [slots] what bounds the stiffness of the membranes at each slot [N/m]: the sums of the absolute values of its
/// row, V E / (1 - nu) sum_j |g_i . g_j| with the gradients g of for_each_gradient (Gershgorin). Points of one cell move
/// together, so a small triangle is not stiff. `u` ([slots][4] [m]; null: at rest): E / (1 - nu) times the largest squared
/// stretch, plus the largest principal stress.
void add_membrane_stiffness(const Model& model, const std::vector<double>* u, std::vector<double>& sum);

}  // namespace pliant
