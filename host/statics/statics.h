// Static equilibrium in double precision: the reference against which the engine's methods are measured, and the solver of a
// scene with "solver": {"type": "static"}. Newton-Raphson with line search and load stepping over consistent tangents
// and a sparse Cholesky factorisation. Shares no code with the kernels or their twins.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "geometry/vec.h"
#include "model/model.h"
#include "scene/scene.h"

namespace pliant::statics {

/// tet4: 1 point, 4 nodes. tet10: 4 points, corners, then the middles of the edges 01, 12, 02, 03, 13, 23 (VTK's order); edges
/// may be curved. hex8full: 2 x 2 x 2 points, corner a at bits (x, y, z) = (a & 1, a >> 1 & 1, a >> 2 & 1).
enum class Element { tet4, tet10, hex8full };
int corners_of(Element element);  ///< nodes per element: 4, 10, 8
const char* to_string(Element element);

struct Mesh {
  Element element = Element::tet10;
  std::vector<Vec3d> nodes;            ///< rest positions [m]
  std::vector<std::int32_t> corners;   ///< [elements][corners_of(element)]
  std::vector<std::int32_t> material;  ///< [elements] index into Problem::materials; empty: 0 everywhere
  std::vector<double> fill;            ///< [elements] share of the element that holds material, in (0, 1]; empty: 1 everywhere
  [[nodiscard]] std::int64_t elements() const { return static_cast<std::int64_t>(corners.size()) / corners_of(element); }
  [[nodiscard]] const std::int32_t* nodes_of(std::int64_t e) const { return corners.data() + e * corners_of(element); }
};

/// One component of one node is moved to a given displacement.
struct Prescribed {
  std::int32_t node = 0;
  int axis = 0;
  double displacement = 0;  ///< [m]
  std::int32_t set = 0;     ///< whose reaction it belongs to, see reactions()
};

/// A dead force on a node.
struct Force {
  std::int32_t node = 0;
  Vec3d force{};  ///< [N]
};

/// A point embedded in the nodes of the mesh by fixed weights; what follower pressures act on.
struct SurfacePoint {
  Vec3d rest{};  ///< [m]
  std::array<std::int32_t, 10> nodes{};
  std::array<double, 10> weights{};
};

/// Follower pressure on a triangle of surface points, which stays flat: against the normal of the deformed triangle (right-hand
/// rule).
struct Pressure {
  std::array<std::int32_t, 3> points{};
  double pressure = 0;  ///< [Pa]
};

/// Follower pressure on the face of an element that three of its corners name, or on half of a quadrilateral: against the
/// normal of the deformed, curved face, shared by its nodes as their shape functions say. Loads over the undeformed face if
/// linear.
struct FacePressure {
  std::int64_t element = 0;
  std::array<int, 3> corners{};  ///< local; counter-clockwise as seen from outside
  double pressure = 0;           ///< [Pa]
};

struct Problem {
  Mesh mesh;
  std::vector<Material> materials;  ///< density counts for gravity only
  Vec3d gravity{};                  ///< [m/s^2], acts on density times fill
  std::function<Vec3d(const Vec3d&)>
      body_force;                      ///< further dead force per rest volume at a rest position [N/m^3]; may be empty
  std::vector<Prescribed> prescribed;  ///< the last entry for a component wins
  std::vector<Force> forces;           ///< entries for the same node add up
  std::vector<SurfacePoint> surface;
  std::vector<Pressure> pressures;
  std::vector<FacePressure> face_pressures;
};

struct Settings {
  bool linear = false;  ///< one solve with the stiffness at rest; displacements are small by assumption
  int load_steps = 0;   ///< equal shares of all loads and prescribed displacements; 0: one, halved where Newton's method fails
  double tolerance =
      1e-10;  ///< |R - F| over free components <= tolerance * largest of |R|, |F| with reactions (Euclidean norms)
  int max_iterations = 40;  ///< per load step
  /// Called after every iteration with the load factor reached, iterations so far and the relative residual; may be empty.
  std::function<void(double, int, double)> progress;
};

/// One converged load step.
struct LoadStep {
  double load = 0;                ///< share of the loads, 1 at the end
  int iterations = 0;             ///< factorisations
  std::vector<double> residuals;  ///< relative residual before the first and after each iteration
};

struct Solution {
  bool converged = false;
  std::string failure;              ///< why not; empty when converged
  double load = 0;                  ///< share of the loads that was reached
  std::vector<Vec3d> displacement;  ///< [nodes] [m], the last converged state
  std::vector<Vec3d> reaction;      ///< [nodes] internal minus external force [N], zero to the tolerance at free components
  Vec3d applied{};                  ///< sum of the loads, which the reactions balance [N]
  double residual = 0;              ///< relative, at the end
  double strain_energy = 0;         ///< [J]
  std::vector<LoadStep> steps;
  std::int64_t unknowns = 0;
  [[nodiscard]] int iterations() const;
};

/// Throws Error for a problem that has no unique answer (a part that may move as a rigid body), an element without positive
/// volume, an index out of range. Failure to converge is reported in the Solution.
Solution solve(const Problem& problem, const Settings& settings = {});

/// Sum of the reactions over the nodes of each set of prescribed components [N]; the last entry for a component holds it.
std::vector<Vec3d> reactions(const Problem& problem, const Solution& solution);

/// The same nodes, and one in the middle of every edge behind them: nodes keep their numbers.
Mesh to_quadratic(const Mesh& tet4);

/// A problem over tet4 as one over tet10. A component of an edge's middle is prescribed where it is at both ends, to the mean,
/// and belongs to the later set of both. Node forces and surface points stay on their nodes: prefer add_traction, add_pressure
/// and body forces.
Problem to_quadratic(const Problem& tet4);

/// A box [0, size] of cells[0] x cells[1] x cells[2] cells; tetrahedra split each into six around the diagonal from corner 0
/// to 7.
Mesh box_mesh(Element element, const std::array<int, 3>& cells, const Vec3d& size, const Vec3d& origin = {});

/// Nodes for which `chosen` holds, ascending.
std::vector<std::int32_t> nodes_where(const Mesh& mesh, const std::function<bool(const Vec3d&)>& chosen);

/// Prescribe (displacement, or zero) the components in `axes` (bit mask of x, y, z) of the chosen nodes.
void prescribe(Problem& problem, const std::function<bool(const Vec3d&)>& chosen, int axes, const Vec3d& displacement = {});

/// Consistent node forces of a dead traction [Pa over rest area] on the boundary faces whose centre is chosen. Returns their
/// area [m^2].
double add_traction(Problem& problem, const std::function<bool(const Vec3d&)>& chosen, const Vec3d& traction);

/// Follower pressure [Pa] on the boundary faces whose centre is chosen.
void add_pressure(Problem& problem, const std::function<bool(const Vec3d&)>& chosen, double pressure);

/// One body of a model at the final values of its load curves, and the loads of the engine: gravity on lumped masses. Nodes are
/// those of the body. hex8 becomes hex8full. Sets of prescribed components: the entries of `fixed`, then those of `prescribed`.
/// Pressures act on the faces of a volume mesh, and on the triangles of a surface that is embedded in a lattice. Throws Error
/// for shape matching, and for tet4anp unless `quadratic`, which turns tetrahedra into tet10 with gravity on the density.
Problem problem_of(const Scene& scene, const Model& model, std::size_t body, bool quadratic = false);

/// Where a rest position lies in a mesh.
struct Place {
  std::int64_t element = -1;
  Vec3d local{};       ///< tets: weights of corners 1..3; hexes: [0, 1]^3
  double outside = 0;  ///< how far outside its element, in local units; 0 inside
};

/// Finds elements by rest position and interpolates node values there.
class Field {
 public:
  explicit Field(const Mesh& mesh);  ///< keeps a reference
  /// The element that holds the point, or the one it is least outside of.
  [[nodiscard]] Place locate(const Vec3d& rest) const;
  [[nodiscard]] std::vector<Place> locate(const std::vector<Vec3d>& rest) const;
  /// sum_a N_a(place) values[a]
  [[nodiscard]] Vec3d value(const Place& place, const std::vector<Vec3d>& values) const;
  /// d value_i / d X_j, row i, column j.
  [[nodiscard]] std::array<double, 9> gradient(const Place& place, const std::vector<Vec3d>& values) const;

 private:
  [[nodiscard]] Place place_in(std::int64_t element, const Vec3d& rest) const;
  const Mesh& mesh_;
  vec::Box bounds_;
  std::array<std::int32_t, 3> size_{};
  double cell_ = 1;
  std::vector<std::int64_t> first_;  ///< [cells + 1] into held_
  std::vector<std::int64_t> held_;   ///< elements whose box touches the cell
};

/// A quadrature point with its weight [m^3], fill counted.
struct Sample {
  Vec3d rest{};
  Place place;
  double weight = 0;
};
/// Points of a rule that is exact for degree 5 in local coordinates: for L2 norms, sum weight |u - u_ref|^2.
std::vector<Sample> samples(const Mesh& mesh);

}  // namespace pliant::statics
