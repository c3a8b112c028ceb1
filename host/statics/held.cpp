// Whether the prescribed components leave a part of the mesh free to move as a rigid body.
#include <fmt/format.h>

#include <map>
#include <numeric>

#include "pliant/error.h"
#include "statics/system.h"

namespace pliant::statics {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Number of the connected part of each node.
std::vector<std::int32_t> parts_of(const Mesh& mesh) {
  std::vector<std::int32_t> parent(mesh.nodes.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::int32_t n) {
    while (parent[n] != n) n = parent[n] = parent[parent[n]];
    return n;
  };
  for (std::int64_t e = 0; e < mesh.elements(); ++e) {
    const std::int32_t* const nodes = mesh.nodes_of(e);
    for (int a = 1; a < corners_of(mesh.element); ++a) {
      const std::int32_t i = root(nodes[0]), j = root(nodes[a]);
      parent[std::max(i, j)] = std::min(i, j);
    }
  }
  for (std::size_t n = 0; n < parent.size(); ++n) parent[n] = root(static_cast<std::int32_t>(n));
  return parent;
}

}  // namespace

void check_held(const Problem& problem) {
  const Mesh& mesh = problem.mesh;
  const std::vector<std::int32_t> part = parts_of(mesh);
  struct Part {
    Vector3d centre = Vector3d::Zero();
    double nodes = 0, radius = 0;
    Matrix6d held = Matrix6d::Zero();  ///< sum of r r^T over prescribed components; r = what the six rigid motions do to one
  };
  std::map<std::int32_t, Part> parts;
  for (std::size_t n = 0; n < part.size(); ++n) {
    parts[part[n]].centre += eigen(mesh.nodes[n]);
    parts[part[n]].nodes += 1;
  }
  for (auto& [root, p] : parts) p.centre /= p.nodes;
  for (std::size_t n = 0; n < part.size(); ++n) {
    Part& p = parts[part[n]];
    p.radius = std::max(p.radius, (eigen(mesh.nodes[n]) - p.centre).norm());
  }
  for (const Prescribed& entry : problem.prescribed) {
    Part& p = parts.at(part[entry.node]);
    const Vector3d x = (eigen(mesh.nodes[entry.node]) - p.centre) / p.radius;
    Eigen::Matrix<double, 6, 1> r = Eigen::Matrix<double, 6, 1>::Zero();
    r[entry.axis] = 1;
    for (int turn = 0; turn < 3; ++turn) r[3 + turn] = Vector3d::Unit(turn).cross(x)[entry.axis];
    p.held += r * r.transpose();
  }
  for (const auto& [root, p] : parts) {
    const double least = Eigen::SelfAdjointEigenSolver<Matrix6d>(p.held).eigenvalues()[0];
    if (least > 1e-10 * std::max(1.0, p.held.trace())) continue;
    throw Error(
        ErrorCode::bad_input,
        fmt::format(
            "static problem: the part of the mesh that holds node {} ({:.0f} nodes) may still move as a rigid body, so it has "
            "no one equilibrium; fix or prescribe at least three of its nodes that are not on one line",
            root, p.nodes));
  }
}

}  // namespace pliant::statics
