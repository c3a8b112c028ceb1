// References: exact answers, or static equilibrium on two meshes whose difference says how far to trust the finer one.
#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "bench/accuracy/parts.h"
#include "pliant/error.h"

namespace pliant::bench::accuracy {
namespace {

namespace fs = std::filesystem;
using std::chrono::steady_clock;

/// The part of a symmetric body that is solved for: below the middle of every mirrored axis.
double middle(const Problem& p, int axis) { return p.size[axis] / 2; }
bool mirrored(const Problem& p, int axis) { return (p.mirror >> axis & 1) != 0; }

statics::Mesh mesh_for(const Problem& p, const std::array<int, 3>& level, const fs::path& scenes) {
  if (p.shape == Shape::liver) return lattice_mesh(p, level[0], scenes);
  std::array<int, 3> cells = level;
  Vec3d size = p.size;
  if (p.shape == Shape::cook) size[2] = p.size[0] / cells[0];
  for (int c = 0; c < 3; ++c) {
    if (!mirrored(p, c)) continue;
    cells[c] /= 2;
    size[c] /= 2;
  }
  statics::Mesh mesh = statics::box_mesh(statics::Element::tet10, cells, size);
  for (Vec3d& x : mesh.nodes) x = shaped(p, x);
  return mesh;
}

statics::Problem problem_for(const Problem& p, const std::array<int, 3>& level, const fs::path& scenes) {
  statics::Problem problem;
  problem.mesh = mesh_for(p, level, scenes);
  Material m;
  m.set_moduli(Law::neo_hookean, Moduli::from_young(p.young, p.poisson));
  m.density = kDensity;
  problem.materials = {m};
  problem.gravity = p.gravity;
  for (int c = 0; c < 3; ++c) {
    if (mirrored(p, c))
      statics::prescribe(
          problem, [&](const Vec3d& x) { return std::abs(x[c] - middle(p, c)) < 1e-9; }, 1 << c);
  }
  for (const Support& s : p.supports) {
    for (const std::int32_t n : statics::nodes_where(problem.mesh, s.where)) {
      const Vec3d u = s.displacement ? s.displacement(problem.mesh.nodes[n]) : Vec3d{};
      for (int c = 0; c < 3; ++c) {
        if (s.axes >> c & 1) problem.prescribed.push_back({n, c, u[c]});
      }
    }
  }
  for (const Traction& t : p.tractions) statics::add_traction(problem, t.where, t.traction);
  return problem;
}

struct Level {
  std::vector<Vec3d> u;
  std::int64_t nodes = 0;
};

Level solve_level(const Problem& p, const std::array<int, 3>& level, const fs::path& scenes) {
  const statics::Problem problem = problem_for(p, level, scenes);
  statics::Settings settings;
  settings.tolerance = 1e-9;
  const statics::Solution solution = statics::solve(problem, settings);
  if (!solution.converged) {
    throw Error(ErrorCode::bad_input, fmt::format("accuracy: the reference of problem {} ({} nodes) did not converge: {}",
                                                  p.name, problem.mesh.nodes.size(), solution.failure));
  }
  const statics::Field field(problem.mesh);
  Level result;
  result.nodes = static_cast<std::int64_t>(problem.mesh.nodes.size());
  for (Vec3d x : p.samples) {
    int folded = 0;
    for (int c = 0; c < 3; ++c) {
      if (!mirrored(p, c) || x[c] <= middle(p, c)) continue;
      x[c] = p.size[c] - x[c];
      folded |= 1 << c;
    }
    Vec3d u = field.value(field.locate(x), solution.displacement);
    for (int c = 0; c < 3; ++c) {
      if (folded >> c & 1) u[c] = -u[c];
    }
    result.u.push_back(u);
  }
  return result;
}

/// To multiples of 2^-30 of the largest displacement: far below the reference's own error, far above the rounding of a solver
/// that may add in another order next time.
void round_off(std::vector<Vec3d>& u) {
  double largest = 0;
  for (const Vec3d& x : u) largest = std::max(largest, vec::norm(x));
  const double grid = std::ldexp(1.0, std::ilogb(largest) - 30);
  for (Vec3d& x : u) {
    for (double& c : x) c = std::rint(c / grid) * grid;
  }
}

}  // namespace

Errors errors_of(const std::vector<Vec3d>& u, const std::vector<Vec3d>& reference) {
  double difference = 0, size = 0, furthest = 0, largest = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const Vec3d d = vec::sub(u[i], reference[i]);
    difference += vec::dot(d, d);
    size += vec::dot(reference[i], reference[i]);
    furthest = std::max(furthest, vec::norm(d));
    largest = std::max(largest, vec::norm(reference[i]));
  }
  return {std::sqrt(difference / size), furthest / largest};
}

Reference make_reference(const Problem& p, const fs::path& scenes) {
  const auto start = steady_clock::now();
  Reference r;
  if (p.exact) {
    r.u = p.exact(p);
    r.text = p.reference;
    r.error = p.exact_error;
  } else {
    const Level coarse = solve_level(p, p.levels[0], scenes), fine = solve_level(p, p.levels[1], scenes);
    r.u = fine.u;
    round_off(r.u);
    r.nodes = fine.nodes;
    // First order at worst, where an edge of a clamp or a tool makes the stress singular.
    const double ratio = static_cast<double>(p.levels[1][0]) / p.levels[0][0];
    r.error = errors_of(coarse.u, fine.u).l2 / (ratio - 1);
    r.text = fmt::format("converged: {} of {} nodes, Newton's method in double", p.shape == Shape::liver ? "hex8full" : "tet10",
                         fine.nodes);
  }
  r.seconds = std::chrono::duration<double>(steady_clock::now() - start).count();
  return r;
}

}  // namespace pliant::bench::accuracy
