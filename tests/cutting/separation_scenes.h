// Scenes with blades that part bodies along the faces of their elements, and what no edit may change.
#pragma once
#include <bit>
#include <random>
#include <string>
#include <vector>

#include "cutting/block_scenes.h"
#include "io/save.h"
#include "model/pieces.h"
#include "solver/scenes.h"
#include "support/error_of.h"
#include "tearing/method.h"

namespace pliant::separation_test {

using namespace cut_test;
using test::error_of;

inline Blade separating(const std::string& name, std::vector<std::array<double, 7>> path) {
  return with_method(BladeMethod::separation, name, std::move(path));
}

struct Separation : BlockScenes {
  [[nodiscard]] Scene block(ElementKind element = ElementKind::tet4) const {
    return BlockScenes::block(BladeMethod::separation, element);
  }
  [[nodiscard]] Scene block_cut_through() const { return cut_through(BladeMethod::separation); }
};

/// What no edit may change: the elements, mass and volume, and that the surface is closed.
inline void expect_kept(const Simulation& s, std::int64_t elements, double mass, double volume) {
  EXPECT_EQ(s.model().bodies[0].elements(), elements);
  EXPECT_NEAR(mass_of(s) / mass, 1, 1e-12);
  EXPECT_NEAR(volume_of(s) / volume, 1, 1e-12);
  EXPECT_EQ(singular_edges(s.model().surface.triangles), 0);
}

/// Faces of tetrahedra that have opened.
inline std::int64_t opened_faces(const Simulation& s) {
  std::int64_t sides = 0;
  for (const TearRecord& tear : s.state().tears) sides += std::popcount(static_cast<unsigned>(tear.broken()));
  return sides / 2;
}

/// The broken faces of a body, sorted by element: [elements] bits.
inline std::vector<int> broken_faces(const Simulation& s) {
  std::vector<int> bits(static_cast<std::size_t>(s.model().bodies[0].elements()), 0);
  for (const TearRecord& tear : s.state().tears) bits[static_cast<std::size_t>(tear.tet)] = tear.broken();
  return bits;
}

}  // namespace pliant::separation_test
