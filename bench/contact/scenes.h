// Bodies and tools of `pliant bench contact`, made in memory.
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <string>

#include "bench/common/dice.h"
#include "geometry/mesh.h"
#include "simulation/simulation.h"

namespace pliant::bench::contact {

/// Elements that can be cut from a lattice.
inline constexpr std::array kElements{ElementKind::hex8, ElementKind::hex8full, ElementKind::tet4, ElementKind::tet4anp};

/// The surface of a union of cells from `lower`; each square of it is split into fine x fine ones.
TriangleMesh cells_surface(const std::array<int, 3>& cells, double edge, const Vec3d& lower, int fine = 1,
                           const std::function<bool(int, int, int)>& filled = nullptr);
/// A ball whose triangles are about as large as those of a cube of `cells` to the side.
TriangleMesh ball_surface(double radius, const Vec3d& centre, int cells);

Material tissue(double young, double poisson, double damping);
Body body_of(const std::string& name, const TriangleMesh& surface, double spacing, ElementKind element,
             const Material& material);

/// All nodes within a micrometre of the plane x_axis = value, or beyond it.
Selection face(int axis, double value);
Selection beyond(int axis, double value, bool above);

std::unique_ptr<Simulation> simulate(const Scene& scene, const std::string& backend, double dt = 0);
/// Advance to a time in batches of at most `batch` steps, calling `after` with the time [s] that each took. Throws Error when
/// it diverges.
void until(Simulation& s, double time, const std::function<void(double)>& after = nullptr, std::int64_t batch = 16);

struct Energy {
  double kinetic = 0, elastic = 0, external = 0;  ///< [J]
};
Energy energy_of(Simulation& s);

/// A tool without a path, its lowest point, and how far it reaches to the side when it is turned by `turn`.
struct DrawnTool {
  ContactTool tool;
  std::array<double, 4> turn{0, 0, 0, 1};
  double low = 0, aside = 0;  ///< [m]
  std::string words;
};
std::array<double, 4> turn_about(const Vec3d& axis, double angle);
/// A sphere, a rod along the surface, or a box, flat or askew, of one to three cells.
DrawnTool draw_blunt(Dice& dice, double cell);
/// A capsule of 1 mm radius, upright or lying, or a plate of 0.5 mm whose edge comes first.
DrawnTool draw_thin(Dice& dice);
/// A rod that lies, a needle that leans, a plate whose rim comes first, or a ball, of 0.5 to 1.5 mm, all met along their edges.
DrawnTool draw_edged(Dice& dice);
/// Its tool on a way from one place to another [s], [m].
ContactTool moved(const DrawnTool& drawn, double start, const Vec3d& from, double end, const Vec3d& to);

}  // namespace pliant::bench::contact
