// Small bodies and short runs: what every sweep of `pliant bench stability` is made of.
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "simulation/simulation.h"

namespace pliant::bench::stability {

enum class Method { tet4, tet4anp, hex8, hex8full, flsm, hybrid };
inline constexpr std::array kMethods{Method::tet4,     Method::tet4anp, Method::hex8,
                                     Method::hex8full, Method::flsm,    Method::hybrid};
inline constexpr std::array kElements{Method::tet4, Method::tet4anp, Method::hex8, Method::hex8full};
const char* name_of(Method method);
inline bool has_elements(Method method) { return method != Method::flsm; }

/// A box of cells from `origin`; tetrahedra are six to a cell. Cells of equal edges of hex8, hex8full, FLSM and hybrids are a
/// lattice, others a volume mesh.
struct Box {
  std::array<int, 3> cells{2, 2, 2};
  Vec3d edge{0.01, 0.01, 0.01};  ///< [m]
  Vec3d origin{};                ///< [m]
  [[nodiscard]] Vec3d size() const { return {cells[0] * edge[0], cells[1] * edge[1], cells[2] * edge[2]}; }
};

Material material(double young, double poisson, double density = 1000, Law law = Law::neo_hookean);

/// A body without its mesh. A hybrid's operational cells are those with their centre below x = `split` [m].
Body body_of(Method method, const Material& material, double split = 0);

/// What lies within a micrometre of the plane x_axis = value.
Selection face(int axis, double value);
Fixed held(int axis, double value);    ///< all three components
Fixed roller(int axis, double value);  ///< the component along the axis

/// A scene and its model; no file of it remains.
struct Specimen {
  Scene scene;
  std::shared_ptr<const Model> model;
};

/// Builds the model; body b becomes boxes[b]. Elements with their centre beyond x = `thin_beyond` [m] hold `fill` of their
/// volume.
Specimen make_specimen(Scene scene, const std::vector<Box>& boxes, double fill = 1, double thin_beyond = 0);
/// One body, one face x = 0 held, no gravity.
Specimen clamped(Method method, const Box& box, const Material& material);

/// Displacements by slot [m]; empty: the rest shape.
using State = std::vector<Vec3d>;
State state_of(const Model& model, const std::function<Vec3d(const Vec3d&)>& u);

/// The floats that `pliant run` computes, or doubles, on the caller's thread.
std::unique_ptr<Simulation> simulate(const Specimen& specimen, double dt, bool in_double = false, bool estimate = false);

/// Put the nodes there, at rest, with noise of that size in each free component [m].
void place(Simulation& simulation, const State& u, double noise = 0);

/// The engine's estimate of the stable step there [s].
double estimated_step(const Specimen& specimen, const State& u = {});

/// The longest step of which small noise about a state of equilibrium does not grow.
struct Limit {
  double value = 0;
  bool reached = false;  ///< false: nothing grew up to `value`
};
/// By bisection between 0.5 and 1.7 times `guess`, to one part in 2000, over `steps` steps in double without gravity.
Limit measured_step(const Specimen& specimen, double guess, const State& u = {}, int steps = 400);

/// How a run in float ended.
struct Ending {
  bool diverged = false, finite = true;
  std::int64_t steps = 0;    ///< done, or the step of the divergence
  std::int64_t latency = 0;  ///< steps from the last good state to the divergence
  double largest = 0;        ///< displacement over the body's largest extent, at the end
  std::string message;
  [[nodiscard]] int exit_code() const { return diverged ? 4 : 0; }
  /// In words: "stopped in step N", "went on for N steps", ...
  [[nodiscard]] std::string words() const;
};
Ending run(Simulation& simulation, std::int64_t steps);

/// A step beyond the limit on a scene as `pliant run` would take it: from `u` with noise of a thousandth of an edge.
Ending run_past(const Specimen& specimen, double dt, std::int64_t steps, const State& u = {});

/// Neighbouring values of a parameter, one that is still good and one that is not.
struct Bracket {
  double good = 0, bad = 0;
  bool reached = false;  ///< false: all were good up to `good`
};
/// The first bad value above `low` on a grid of `factor`, made finer by bisection to `tolerance`: near a limit good and bad
/// values may alternate.
Bracket first_bad(double low, double high, double factor, double tolerance, const std::function<bool(double)>& good);

/// The last value of a parameter that `good` accepts, by bisection between a good `low` and a bad `high`.
double bisect(double low, double high, double tolerance, const std::function<bool(double)>& good, bool logarithmic = false);

}  // namespace pliant::bench::stability
