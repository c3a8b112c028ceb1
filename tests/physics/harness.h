// Scenes built in code, backends by name, and what the physics tests read from a Simulation.
#pragma once
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "backends/choice/backends.h"
#include "geometry/mesh.h"
#include "io/obj.h"
#include "kernels/laws/law_oracle.h"
#include "simulation/measure/energy.h"
#include "simulation/simulation.h"
#include "support/opencl.h"
#include "support/temp_folder.h"

namespace pliant::physics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

inline Vector3d eigen(const Vec3d& a) { return {a[0], a[1], a[2]}; }
inline Vec3d plain(const Vector3d& a) { return {a[0], a[1], a[2]}; }

// --- Backends ---

/// A test of this fixture runs on "cpu", "cpu:double" and the first OpenCL device; it is skipped where there is none.
class OnBackend : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (std::string(GetParam()) == "opencl:0" && !test::has_opencl()) GTEST_SKIP() << "there is no OpenCL device";
  }
  [[nodiscard]] bool in_double() const { return std::string(GetParam()) == "cpu:double"; }
  /// The bound for float, or the tighter one.
  [[nodiscard]] double bound(double in_float, double in_double_) const { return in_double() ? in_double_ : in_float; }
};

inline std::string backend_label(const ::testing::TestParamInfo<const char*>& info) {
  const std::string name = info.param;
  return name == "cpu" ? "cpu" : name == "cpu:double" ? "cpu_double" : "opencl";
}

#define PLIANT_ON_BACKENDS(fixture) \
  INSTANTIATE_TEST_SUITE_P(On, fixture, ::testing::Values("cpu", "cpu:double", "opencl:0"), ::pliant::physics::backend_label)

/// Print and check |error| <= bound.
inline void check(const std::string& what, double error, double bound) {
  std::printf("  %-58s error %10.3e  bound %9.2e\n", what.c_str(), error, bound);
  EXPECT_LE(std::abs(error), bound) << what;
}

inline void check_relative(const std::string& what, double value, double exact, double bound) {
  std::printf("  %-58s %14.7g  exact %14.7g  error %10.3e  bound %9.2e\n", what.c_str(), value, exact, value / exact - 1,
              bound);
  EXPECT_LE(std::abs(value - exact), bound * std::abs(exact)) << what;
}

// --- Meshes ---

/// A new file name in a folder that vanishes when the tests end.
inline std::filesystem::path next_file(const char* extension) {
  static const test::TempFolder folder;
  static int count = 0;
  return folder.path() / ("mesh" + std::to_string(count++) + extension);
}

/// What a body is made of.
enum class Discretization { tet4, tet4anp, hex8, hex8full, hex8_bricks, hex8full_lattice };
inline const std::vector<Discretization>& all_cuts() {
  static const std::vector<Discretization> cuts{Discretization::tet4,        Discretization::tet4anp,
                                                Discretization::hex8,        Discretization::hex8full,
                                                Discretization::hex8_bricks, Discretization::hex8full_lattice};
  return cuts;
}
inline bool is_lattice(Discretization cut) {
  return cut == Discretization::hex8_bricks || cut == Discretization::hex8full_lattice;
}
inline bool is_tet(Discretization cut) { return cut == Discretization::tet4 || cut == Discretization::tet4anp; }
inline const char* name_of(Discretization cut) {
  switch (cut) {
    case Discretization::tet4:
      return "tet4";
    case Discretization::tet4anp:
      return "tet4anp";
    case Discretization::hex8:
      return "hex8";
    case Discretization::hex8full:
      return "hex8full";
    case Discretization::hex8_bricks:
      return "hex8 bricks";
    case Discretization::hex8full_lattice:
      return "hex8full lattice";
  }
  return "";
}
inline ElementKind kind_of(Discretization cut) {
  switch (cut) {
    case Discretization::tet4:
      return ElementKind::tet4;
    case Discretization::tet4anp:
      return ElementKind::tet4anp;
    case Discretization::hex8:
    case Discretization::hex8_bricks:
      return ElementKind::hex8;
    case Discretization::hex8full:
    case Discretization::hex8full_lattice:
      return ElementKind::hex8full;
  }
  return ElementKind::hex8;
}

/// A box [0, n_x d] x ... of cubes of edge d. `distortion`: share of d by which nodes move, on a face only inside it.
struct Box {
  std::array<int, 3> cells{1, 1, 1};
  double edge = 1;  ///< [m]
  double distortion = 0;
  unsigned seed = 1;
  [[nodiscard]] Vec3d size() const { return {cells[0] * edge, cells[1] * edge, cells[2] * edge}; }
  [[nodiscard]] double volume() const { return size()[0] * size()[1] * size()[2]; }
};

inline VolumeMesh make_mesh(const Box& box, bool tets) {
  VolumeMesh mesh;
  std::mt19937 random(box.seed);
  const int nx = box.cells[0], ny = box.cells[1], nz = box.cells[2];
  const std::array<int, 3> n = box.cells;
  for (int k = 0; k <= nz; ++k) {
    for (int j = 0; j <= ny; ++j) {
      for (int i = 0; i <= nx; ++i) {
        const std::array<int, 3> at{i, j, k};
        Vec3d x;
        for (int c = 0; c < 3; ++c) {
          const double shift = (static_cast<double>(random()) / 4294967295.0 * 2 - 1) * box.distortion * box.edge;
          x[c] = at[c] * box.edge + (at[c] == 0 || at[c] == n[c] ? 0 : shift);
        }
        mesh.vertices.push_back(x);
      }
    }
  }
  const auto node = [&](int i, int j, int k) { return static_cast<std::int32_t>(i + (nx + 1) * (j + (ny + 1) * k)); };
  // Six tetrahedra around the diagonal from corner 0 to 7, one for each order of the axes.
  static constexpr int paths[6][2]{{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        std::array<std::int32_t, 8> c{};
        for (int a = 0; a < 8; ++a) c[a] = node(i + (a & 1), j + (a >> 1 & 1), k + (a >> 2 & 1));
        if (tets) {
          for (const auto& p : paths) mesh.tets.push_back({c[0], c[p[0]], c[p[1]], c[7]});
        } else {
          mesh.hexes.push_back({c[0], c[1], c[3], c[2], c[4], c[5], c[7], c[6]});
        }
      }
    }
  }
  return mesh;
}

/// A legacy VTK file with every digit of the coordinates.
inline std::filesystem::path save(const VolumeMesh& mesh) {
  const auto file = next_file(".vtk");
  std::ofstream out(file);
  out.precision(17);
  out << "# vtk DataFile Version 3.0\nmesh\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " << mesh.vertices.size() << " double\n";
  for (const Vec3d& x : mesh.vertices) out << x[0] << ' ' << x[1] << ' ' << x[2] << '\n';
  const std::size_t cells = mesh.tets.size() + mesh.hexes.size();
  out << "CELLS " << cells << ' ' << 5 * mesh.tets.size() + 9 * mesh.hexes.size() << '\n';
  for (const auto& t : mesh.tets) out << "4 " << t[0] << ' ' << t[1] << ' ' << t[2] << ' ' << t[3] << '\n';
  for (const auto& h : mesh.hexes) {
    out << 8;
    for (const auto n : h) out << ' ' << n;
    out << '\n';
  }
  out << "CELL_TYPES " << cells << '\n';
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) out << "10\n";
  for (std::size_t i = 0; i < mesh.hexes.size(); ++i) out << "12\n";
  return file;
}

/// The surface of the regular box, two triangles per cell face.
inline TriangleMesh box_surface(const Box& box) {
  const VolumeMesh mesh = make_mesh({box.cells, box.edge, 0, 1}, false);
  TriangleMesh surface;
  std::vector<std::int32_t> vertex(mesh.vertices.size(), -1);
  for (auto t : boundary_triangles(mesh)) {
    for (std::int32_t& v : t) {
      if (vertex[v] < 0) {
        vertex[v] = static_cast<std::int32_t>(surface.vertices.size());
        surface.vertices.push_back(mesh.vertices[v]);
      }
      v = vertex[v];
    }
    surface.triangles.push_back(t);
  }
  return surface;
}

inline std::filesystem::path save(const TriangleMesh& mesh) {
  const auto file = next_file(".obj");
  write_obj(file, mesh);
  return file;
}

// --- Scenes ---

inline Material material(Law law, double mu, double kappa, double density = 1000) {
  return make_material(law, Moduli::from_bulk(mu, kappa), density);
}
inline Material material_young(Law law, double young, double poisson, double density = 1000) {
  return material(law, young / (2 * (1 + poisson)), young / (3 * (1 - 2 * poisson)), density);
}

inline Body box_body(const Box& box, Discretization cut, const Material& m) {
  Body body;
  body.name = name_of(cut);
  body.element = kind_of(cut);
  body.material = m;
  if (is_lattice(cut)) {
    body.surface = save(box_surface(box));
    body.lattice.spacing = box.edge;
  } else {
    body.mesh = save(make_mesh(box, is_tet(cut)));
  }
  return body;
}

inline Selection all_nodes() { return {}; }
/// Nodes (or triangles) within `slack` [m] of the plane x_axis = value.
inline Selection face(int axis, double value, double slack = 1e-6) {
  Selection s;
  s.kind = Selection::Kind::box;
  s.a = {-1e3, -1e3, -1e3};
  s.b = {1e3, 1e3, 1e3};
  s.a[axis] = value - slack;
  s.b[axis] = value + slack;
  // contains() widens by 1e-9 of the largest coordinate: with 1e3 by 1e-6, so `slack` is nearly doubled.
  return s;
}

inline Fixed roller(int axis, double value = 0) {
  Fixed f;
  f.where = face(axis, value);
  f.axes = {axis == 0, axis == 1, axis == 2};
  return f;
}

inline Curve smooth(double duration) {
  Curve c;
  c.kind = Curve::Kind::smooth;
  c.duration = duration;
  return c;
}

inline Prescribed pull(int axis, double at, double displacement, const Curve& curve) {
  Prescribed p;
  p.where = face(axis, at);
  p.displacement[axis] = displacement;
  p.curve = curve;
  return p;
}

inline std::unique_ptr<Simulation> simulate(const Scene& scene, const char* backend, SimulationOptions options = {}) {
  return std::make_unique<Simulation>(scene, open_backend(backend), options);
}

// --- States ---

inline std::vector<Vec3d> texels(const std::vector<double>& reals) {
  std::vector<Vec3d> out(reals.size() / 4);
  for (std::size_t s = 0; s < out.size(); ++s) out[s] = {reals[4 * s], reals[4 * s + 1], reals[4 * s + 2]};
  return out;
}
inline std::vector<Vec3d> read_texels(const Simulation& sim, const char* buffer) {
  std::vector<Vec3d> out = texels(sim.backend().read_reals(sim.program().find(buffer)));
  const std::vector<double>& offset = sim.state().offset;  // what node_u leaves out of the displacement
  for (std::size_t i = 0; i < offset.size() && std::string(buffer) == "node_u"; ++i) out[i / 3][i % 3] += offset[i];
  return out;
}

/// With the velocities of the last step.
inline Momenta momenta_of(Simulation& sim) {
  auto w = read_texels(sim, "node_w");
  for (Vec3d& x : w) x = plain(eigen(x) / sim.dt());
  return momenta(sim.model(), read_texels(sim, "node_u"), w);
}
/// Write the three components of every slot that is a node.
inline void write_texels(Simulation& sim, const char* buffer, const std::vector<Vec3d>& values) {
  const BufferId id = sim.program().find(buffer);
  std::vector<double> reals = sim.backend().read_reals(id);
  for (std::size_t s = 0; s < values.size(); ++s) {
    for (int c = 0; c < 3; ++c) {
      if (sim.model().mass[s] > 0) reals[4 * s + c] = values[s][c];
    }
  }
  sim.backend().write_reals(id, reals);
}
inline std::vector<Vec3d> displaced(const Model& model, const std::function<Vector3d(const Vector3d&)>& u) {
  std::vector<Vec3d> out(model.slots);
  for (std::int32_t s = 0; s < model.slots; ++s) out[s] = plain(u(eigen(model.rest[s])));
  return out;
}
/// R - F by slot, at the displacements that the backend holds.
inline std::vector<Vec3d> forces(Simulation& sim) {
  std::vector<std::vector<Vec3d>> all;
  for (std::size_t b = 0; b < sim.model().bodies.size(); ++b) all.push_back(sim.residual_forces(b));
  return by_slot(sim.model(), all);
}

/// Mean first Piola-Kirchhoff stress over the rest volume from the internal forces F = -f: V P = sum F X^T.
inline Matrix3d mean_stress(const Model& model, const std::vector<Vec3d>& f, double volume) {
  Matrix3d p = Matrix3d::Zero();
  for (std::int32_t s = 0; s < model.slots; ++s) {
    if (model.mass[s] > 0) p -= eigen(f[s]) * eigen(model.rest[s]).transpose();
  }
  return p / volume;
}

/// First Piola-Kirchhoff stress P = dW/dF of the textbook energy.
inline Matrix3d first_piola(const Matrix3d& f, const Material& m) { return kernel_test::piola_stress(m.law, f, m.parameters); }

inline double largest(const std::vector<Vec3d>& v) {
  double size = 0;
  for (const Vec3d& x : v) size = std::max(size, eigen(x).norm());
  return size;
}

/// Root of a growing or falling function by bisection, in double.
inline double root(double low, double high, const std::function<double(double)>& f) {
  const bool rising = f(low) < 0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    ((f(middle) < 0) == rising ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Advance until dynamic relaxation has found equilibrium.
inline void settle(Simulation& sim) {
  sim.advance(sim.scene().relaxation.max_steps);
  EXPECT_FALSE(sim.divergence().has_value()) << sim.divergence()->message();
  EXPECT_TRUE(sim.at_equilibrium()) << "residual " << sim.residual() << " after " << sim.step() << " steps";
}

}  // namespace pliant::physics
