// The problems and methods of `pliant bench accuracy`. A new problem is one function here and one line in problems().
#include <fmt/format.h>

#include <cmath>

#include "bench/accuracy/parts.h"
#include "mesh_io/mesh_io.h"

namespace pliant::bench::accuracy {
namespace {

constexpr double kClose = 1e-6;  ///< [m], far below every spacing
constexpr int kX = 1, kY = 2, kZ = 4;

Where at(int axis, double value) {
  return [=](const Vec3d& x) { return std::abs(x[axis] - value) < kClose; };
}
Where everywhere() {
  return [](const Vec3d&) { return true; };
}

std::vector<Vec3d> spread(const Vec3d& size, int count = 300) {
  std::vector<Vec3d> points;
  for (int i = 1; i <= count; ++i) {
    const Vec3d h = halton(i);
    points.push_back({size[0] * h[0], size[1] * h[1], size[2] * h[2]});
  }
  return points;
}

/// Speed of the slowest waves of a bar [m/s].
double speed(const Problem& p) { return std::sqrt(p.young / kDensity); }

Problem box(const char* name, const Vec3d& size, const std::array<int, 3>& cells, double young, double poisson) {
  Problem p;
  p.name = name;
  p.size = size;
  p.cells = cells;
  p.refine = {1, 2, 4};
  p.young = young;
  p.poisson = poisson;
  p.samples = spread(size);
  p.characteristic = size[2];
  return p;
}

Problem uniaxial() {
  Problem p = box("uniaxial", {0.05, 0.05, 0.1}, {2, 2, 4}, 3000, 0.45);
  p.title = "Uniaxial stretch";
  p.lead = "A block is drawn out by 30 %, its sides free: the strain is the same everywhere, so every finite element is exact.";
  p.supports = {{at(0, 0), kX, {}}, {at(1, 0), kY, {}}, {at(2, 0), kZ, {}}, {at(2, 0.1), kZ, [](const Vec3d&) {
                                                                               return Vec3d{0, 0, (kStretch - 1) * 0.1};
                                                                             }}};
  p.omega = 2.5 * speed(p) / 0.1;
  p.seed = {0, 0, 0.1};
  p.exact = exact_uniaxial;
  p.reference = "exact: homogeneous stretch, lateral stress zero";
  return p;
}

Problem shear() {
  Problem p = box("shear", {0.08, 0.08, 0.08}, {4, 4, 4}, 3000, 0.45);
  p.title = "Simple shear";
  p.lead = "The whole surface of a cube is sheared by 0.3 and the inside must follow.";
  const auto surface = [](const Vec3d& x) {
    for (const double c : x) {
      if (c < kClose || c > 0.08 - kClose) return true;
    }
    return false;
  };
  p.supports = {{surface, kX | kY | kZ, [](const Vec3d& x) { return Vec3d{kShear * x[1], 0, 0}; }}};
  p.omega = 3 * speed(p) / 0.08;
  p.seed = {0.04, 0.08, 0.04};
  p.exact = exact_shear;
  p.reference = "exact: u = (0.3 Y, 0, 0)";
  return p;
}

Problem column() {
  Problem p = box("column", {0.02, 0.02, 0.1}, {1, 1, 5}, 3000, 0.3);
  p.title = "Confined column";
  p.lead = "A column in a smooth tube sinks under three times its weight: one dimension, strains of up to 40 %.";
  p.gravity = {0, 0, -30};
  p.supports = {{everywhere(), kX | kY, {}}, {at(2, 0), kZ, {}}};
  p.omega = 1.57 * std::sqrt(1.346) * speed(p) / 0.1;
  p.seed = {0, 0, 0};
  p.exact = exact_column;
  p.reference = "exact: the stress of every layer carries what lies above it";
  return p;
}

Problem elastica() {
  Problem p = box("elastica", {0.2, 0.02, 0.02}, {10, 1, 1}, 3000, 0);
  p.title = "Elastica with a tip load";
  p.lead = "A slender beam, clamped at one end, bends under a dead load at its tip to 40 % of its length.";
  const double inertia = std::pow(0.02, 4) / 12, load = kTipLoad * p.young * inertia / 0.04;
  p.supports = {{at(0, 0), kX | kY | kZ, {}}};
  p.tractions = {{at(0, 0.2), {0, -load / 4e-4, 0}, 0.02}};
  p.omega = 3.516 * 0.02 / std::sqrt(12.0) / 0.04 * speed(p);
  p.seed = {0, 0.01, 0.01};
  p.samples.clear();
  for (int i = 1; i <= 40; ++i) p.samples.push_back({0.2 * i / 40, 0.01, 0.01});
  p.exact = exact_elastica;
  p.exact_error = 1.7e-3;  // measured: against tet10 of 19 000 nodes, itself good to 3e-5
  p.reference = "exact for a beam that shears and stretches (Reissner)";
  p.characteristic = 0.02;
  return p;
}

Problem cantilever(double poisson) {
  const std::string nu = fmt::format("{:g}", poisson);
  Problem p = box("", {0.08, 0.02, 0.02}, {8, 2, 2}, 8e4, poisson);
  p.name = "cantilever-" + nu;
  p.title = "Cantilever, nu = " + nu;
  p.lead = "A short beam hangs under its weight by about a fifth of its length; towards nu = 0.5 elements may lock.";
  p.gravity = {0, -9.81, 0};
  p.supports = {{at(0, 0), kX | kY | kZ, {}}};
  p.omega = 3.516 * 0.02 / std::sqrt(12.0) / 0.0064 * speed(p);
  p.seed = {0, 0.01, 0.01};
  p.characteristic = 0.02;
  p.mirror = kZ;
  p.levels = {{{24, 6, 6}, {32, 8, 8}}};
  p.quick_levels = {{{8, 2, 2}, {12, 3, 4}}};
  return p;
}

Problem cook() {
  Problem p = box("cook", {0.048, 0.06, 0.012}, {4, 4, 1}, 3000, 0.49);
  p.title = "Cook's membrane";
  p.lead = "A tapered panel in plane strain, nearly incompressible, is bent and sheared by a load on its right edge.";
  p.shape = Shape::cook;
  p.refine = {1, 2, 4, 8};
  p.supports = {{at(0, 0), kX | kY | kZ, {}}, {everywhere(), kZ, {}}};
  p.tractions = {{at(0, 0.048), {0, 0.025 * p.young, 0}, 0.016}};
  p.omega = 0.6 * speed(p) / 0.048;
  p.seed = {0, 0.044, 0};
  p.characteristic = 0.048;
  p.samples.clear();
  for (int i = 1; i <= 300; ++i) {
    const Vec3d h = halton(i);
    p.samples.push_back({0.048 * h[0], 0.044 * h[0] + (0.044 - 0.028 * h[0]) * h[1], 0});
  }
  p.levels = {{{32, 32, 1}, {48, 48, 1}}};
  p.quick_levels = {{{12, 12, 1}, {16, 16, 1}}};
  return p;
}

Problem twist() {
  Problem p = box("twist", {0.04, 0.04, 0.08}, {2, 2, 4}, 3000, 0.45);
  p.title = "Twisted column";
  p.lead = "The upper end of a square column is turned by 60 degrees against the lower end.";
  const auto turn = [](const Vec3d& x) {
    const double a = M_PI / 3, c = std::cos(a), s = std::sin(a), dx = x[0] - 0.02, dy = x[1] - 0.02;
    return Vec3d{c * dx - s * dy - dx, s * dx + c * dy - dy, 0};
  };
  p.supports = {{at(2, 0), kX | kY | kZ, {}}, {at(2, 0.08), kX | kY | kZ, turn}};
  p.omega = 1.5 * speed(p) / 0.08;
  p.seed = {0, 0, 0.08};
  p.characteristic = 0.04;
  p.levels = {{{6, 6, 12}, {8, 8, 16}}};
  p.quick_levels = {{{3, 3, 6}, {4, 4, 8}}};
  return p;
}

Problem indentation() {
  Problem p = box("indentation", {0.08, 0.08, 0.04}, {4, 4, 2}, 3000, 0.45);
  p.title = "Indented block";
  p.lead = "A rough square tool, half as wide as the block, is pressed into its top by a fifth of its height.";
  const auto tool = [](const Vec3d& x) {
    return x[2] > 0.04 - kClose && std::abs(x[0] - 0.04) < 0.02 + kClose && std::abs(x[1] - 0.04) < 0.02 + kClose;
  };
  p.supports = {{at(2, 0), kX | kY | kZ, {}}, {tool, kX | kY | kZ, [](const Vec3d&) { return Vec3d{0, 0, -0.008}; }}};
  p.omega = 0.8 * speed(p) / 0.04;
  p.seed = {0.04, 0.04, 0.04};
  p.mirror = kX | kY;
  p.characteristic = 0.08;
  p.levels = {{{16, 16, 8}, {24, 24, 12}}};
  p.quick_levels = {{{8, 8, 4}, {12, 12, 6}}};
  return p;
}

Problem liver(const std::filesystem::path& scenes) {
  const TriangleMesh surface = read_surface(scenes / "meshes" / "liver.obj");
  Problem p = box("liver", {0.216, 0.216, 0.216}, {10, 10, 10}, 3000, 0.45);
  p.title = "Liver under a local pull";
  p.lead =
      "An organ, held at its right side, is pulled up by 15 mm at a patch; lattice, clamp and patch are chosen as a user "
      "would.";
  p.shape = Shape::liver;
  p.refine = {1, 2, 3};
  p.supports = {
      {[](const Vec3d& x) { return x[0] <= -0.09; }, kX | kY | kZ, {}},
      {[](const Vec3d& x) { return x[0] * x[0] + (x[1] - 0.075) * (x[1] - 0.075) + x[2] * x[2] <= 0.02 * 0.02; }, kX | kY | kZ,
       [](const Vec3d&) {
         return Vec3d{0, 0.015, 0};
       }}};
  p.omega = 0.7 * speed(p) / 0.2;
  p.seed = {0, 0.075, 0};
  p.samples.clear();
  const std::size_t every = std::max<std::size_t>(1, surface.vertices.size() / 400);
  for (std::size_t v = 0; v < surface.vertices.size(); v += every) p.samples.push_back(surface.vertices[v]);
  // Twice as fine: the nodes that clamp and patch hold are then among those of the finer lattice.
  p.levels = {{{20, 0, 0}, {40, 0, 0}}};
  p.quick_levels = {{{15, 0, 0}, {30, 0, 0}}};
  return p;
}

}  // namespace

Vec3d halton(int index) {
  Vec3d x{};
  constexpr int bases[] = {2, 3, 5};
  for (int c = 0; c < 3; ++c) {
    double share = 1;
    for (int i = index; i > 0; i /= bases[c]) {
      share /= bases[c];
      x[c] += share * (i % bases[c]);
    }
  }
  return x;
}

std::vector<Problem> problems(const std::filesystem::path& scenes, bool quick) {
  std::vector<Problem> all{uniaxial(),       shear(),           column(), elastica(), cantilever(0.3), cantilever(0.45),
                           cantilever(0.49), cantilever(0.499), cook(),   twist(),    indentation(),   liver(scenes)};
  for (Problem& p : all) {
    if (!quick) continue;
    p.refine = {1, 2};
    p.levels = p.quick_levels;
  }
  return all;
}

std::vector<Method> methods(bool quick) {
  std::vector<Method> all;
  for (const ElementKind e : {ElementKind::tet4, ElementKind::tet4anp, ElementKind::hex8, ElementKind::hex8full}) {
    all.push_back({to_string(e), ModelType::tled, e});
  }
  for (const int width : {1, 2, 3}) {
    if (!quick || width == 2) all.push_back({fmt::format("flsm-{}", width), ModelType::flsm, ElementKind::hex8, width});
  }
  for (const int percent : {25, 50, 75}) {
    if (quick && percent != 50) continue;
    all.push_back({fmt::format("hybrid-{}", percent), ModelType::hybrid, ElementKind::hex8, 2, percent / 100.0});
  }
  return all;
}

std::string Case::key() const { return fmt::format("{}|{}|{}|{}|{}", problem->name, method->name, refine, step, backend); }

std::string Case::text() const {
  return fmt::format("{}, {}, {} times as fine, step {}, {}", problem->name, method->name, refine, step, backend);
}

}  // namespace pliant::bench::accuracy
