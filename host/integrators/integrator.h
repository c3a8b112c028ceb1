// Properties of the integrators of kernels/integrators.h: their stored state and supported features. Each integrator has a
// file STEM.h with a struct that has the constant `info`. Code that reads node_w, changes the step or checks features uses
// this and never depends on a specific integrator.
#pragma once
#include <limits>
#include <span>
#include <string>

#include "integrators.h"

namespace pliant {

/// Initial motion of a component of a node.
struct Start {
  double u, v, a;  ///< displacement [m], velocity [m/s], acceleration with damping [m/s^2]
  double h;        ///< step size [s]
};

/// Minimum and maximum damping of the moving nodes of a model.
struct DampingRange {
  double least_rate, most_rate;  ///< mass-proportional [1/s]
  double least_time, most_time;  ///< stiffness-proportional: viscous over elastic force, Material::viscous_time [s]
};

/// Meaning of node_u and node_w. node_u holds the displacement u_n; h is the step, c the damping rate, k = c h / 2.
struct IntegratorInfo {
  const char* word;  ///< name in a scene file
  const char* what;  ///< description for users
  const char* source;
  int order;  ///< order of convergence for smooth motion

  // Contents of node_w: the first three numbers of a texel, and the decay in the fourth.
  double (*first)(const Start& s);          ///< initial value
  double (*increment)(double u, double w);  ///< h v [m] for the velocity v that u and w represent
  double (*decay)(double k);                ///< per-node damping factor for the kernels
  /// Squared velocity for the kinetic energy at u_n [m^2/s^2], from v, the acceleration a without damping, h and k.
  double (*squared_velocity)(double v, double a, double h, double k);
  /// Longest stable step [s]; 0: none is stable. `central` = 2 / omega of the highest mode, the stable step of undamped
  /// central differences.
  double (*stable_step)(double central, const DampingRange& damping);

  // Supported features.
  bool keeps_increment;  ///< `increment` is node_w for any u, and scales with the step
  bool automatic;        ///< automatic step size, with rollback to a smaller step after a burst
  bool edits;            ///< cuts, tears, blades
  bool contact;          ///< contact with tools and of tissue
  bool matching;         ///< shape matching, alone and in hybrids
  bool relaxation;       ///< dynamic relaxation
};

const IntegratorInfo& integrator_info(Integrator integrator);
/// In the order of kernels/integrators.h.
std::span<const Integrator, integrator_count> all_integrators();
/// Lists the integrators with a property, as "a, b or c".
std::string integrators_with(bool IntegratorInfo::*property);

}  // namespace pliant
