// Boxes as static problems.
#pragma once
#include <Eigen/Dense>
#include <random>

#include "physics/harness.h"
#include "statics/statics.h"

namespace pliant::statics_test {

using physics::eigen;
using physics::plain;
using statics::Element;
using statics::Mesh;
using statics::Problem;
using statics::Settings;
using statics::Solution;

inline const std::vector<Element>& all_elements() {
  static const std::vector<Element> elements{Element::tet4, Element::tet10, Element::hex8full};
  return elements;
}

inline bool on(double x, double at) { return std::abs(x - at) < 1e-9; }
inline bool on_boundary(const Vec3d& x, const Vec3d& size) {
  for (int c = 0; c < 3; ++c) {
    if (on(x[c], 0) || on(x[c], size[c])) return true;
  }
  return false;
}

/// A box whose inner corners are moved by up to `distortion` of a cell; edges of tet10 stay straight.
inline Mesh distorted_box(Element element, const std::array<int, 3>& cells, const Vec3d& size, double distortion) {
  const bool quadratic = element == Element::tet10;
  Mesh mesh = statics::box_mesh(quadratic ? Element::tet4 : element, cells, size);
  std::mt19937 random(7);
  for (Vec3d& x : mesh.nodes) {
    for (int c = 0; c < 3; ++c) {
      const double shift = (static_cast<double>(random()) / 4294967295.0 * 2 - 1) * distortion * size[c] / cells[c];
      if (!on(x[c], 0) && !on(x[c], size[c])) x[c] += shift;
    }
  }
  return quadratic ? statics::to_quadratic(mesh) : mesh;
}

inline Solution solved(const Problem& problem, const Settings& settings = {}) {
  Solution solution = statics::solve(problem, settings);
  EXPECT_TRUE(solution.converged) << solution.failure;
  return solution;
}

/// Largest distance between displacements and a field at the nodes.
template <class Function>
double largest_miss(const Problem& problem, const Solution& solution, const Function& exact) {
  double most = 0;
  for (std::size_t n = 0; n < problem.mesh.nodes.size(); ++n)
    most = std::max(most, (eigen(solution.displacement[n]) - exact(eigen(problem.mesh.nodes[n]))).norm());
  return most;
}

}  // namespace pliant::statics_test
