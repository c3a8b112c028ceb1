// The parts of host/plan/plan.cpp: the reference of a scene at rest, and one configuration measured against it.
#pragma once
#include <vector>

#include "model/model.h"
#include "plan/plan.h"

namespace pliant::planning {

/// Square root of the sum of the squares, differences, and the length of the longest.
double norm_of(const std::vector<Vec3d>& u);
std::vector<Vec3d> difference(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b);
double largest(const std::vector<Vec3d>& u);

/// Volume V and area A of the body. A lattice of spacing h has about V / h^3 + A / (2 h^2) nodes, from which the spacing for a
/// wanted number follows.
struct Size {
  double volume = 0;  ///< [m^3]
  double area = 0;    ///< [m^2]
  Vec3d extent{};     ///< along the axes [m]
  /// A selection by a thin box or a plane at a face is empty in most lattices. Then an axis along which whole cells fill the
  /// body, so that the faces across it are nodes; -1: not needed, or of no use.
  int fitted = -1;
};
Size size_of(const Scene& scene);

/// The scene at rest: the mean of three fine lattices. The selection of a plane or a sphere changes with the lattice by a share
/// of its spacing, and that is most of the difference between two fine lattices.
struct Reference {
  std::vector<Vec3d> u;        ///< displacements of the surface's vertices [m]; of a scene with tools at kSamples times
  std::vector<Vec3d> force{};  ///< of its tools at these times [N]
  double norm = 0;             ///< square root of the sum of their squares [m]
  double frequency = 0;        ///< of the slowest motion towards rest, by Rayleigh's quotient of the displacements [rad/s]
  double uncertainty = 0;      ///< standard deviation of the three from their mean, relative
  std::int64_t nodes = 0;      ///< of the finest
  double seconds = 0;
};
/// Twice as many nodes again until the reference is known to half the tolerance, or the time is up.
Reference make_reference(const Scene& scene, const Size& size, const PlanOptions& options);

/// One configuration. Its scene is the base scene with another lattice, element and model.
struct Trial {
  Scene scene;
  std::string what;  ///< for display, e.g. the element and its nodes
  std::string element, model;
  std::int64_t nodes = 0, wanted_nodes = 0;
  double spacing = 0, dt = 0;
  double ms_per_step = 0, ms_per_frame = 0;
  double error = -1, error_max = -1;               ///< relative to the reference; -1: not measured or not at rest
  double error_force = -1;                         ///< of the tools' forces, relative L2; -1: there are none
  double predicted_error = -1, predicted_ms = -1;  ///< made before the measurement, -1: none was
  std::string remark;
};

/// The base scene with this element and about this many nodes.
Scene configured(const Scene& scene, const Size& size, ElementKind element, std::int64_t nodes);

/// The same with the element of references.
Scene reference_scene(const Scene& scene, const Size& size, std::int64_t nodes);

/// The last time at which a load of the body may change [s].
double end_of_curves(const Scene& scene);

/// Steps of the loaded body, timed.
void measure_time(Trial& trial, const PlanOptions& options);
/// The body brought to rest, compared at the surface's vertices.
void measure_error(Trial& trial, const Reference& reference, const PlanOptions& options);

}  // namespace pliant::planning
