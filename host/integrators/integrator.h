// The integrators of kernels/integrators.h: what each of them stores, and what it allows. A file per integrator, STEM.h, gives
// a struct with the constant `info`. Whoever reads node_w, changes the step or asks what a scene may hold asks here, never for
// an integrator by its name.
#pragma once
#include <limits>
#include <span>
#include <string>

#include "integrators.h"

namespace pliant {

/// A component of a node's motion at the start.
struct Start {
  double u, v, a;  ///< displacement [m], velocity [m/s], acceleration with damping [m/s^2]
  double h;        ///< the step [s]
};

/// The damping of what moves in a model, from its least to its most.
struct DampingRange {
  double least_rate, most_rate;  ///< of the mass [1/s]
  double least_time, most_time;  ///< of the stiffness: viscous over elastic force, Material::viscous_time [s]
};

/// What node_u and node_w mean. node_u holds the displacement u_n; h is the step, c the damping rate, k = c h / 2.
struct IntegratorInfo {
  const char* word;  ///< its name in a scene file
  const char* what;  ///< in words, for people
  const char* source;
  int order;  ///< of convergence, where the motion is smooth

  // What node_w holds: the first three numbers of a texel, and the decay in the fourth.
  double (*first)(const Start& s);          ///< at the start
  double (*increment)(double u, double w);  ///< h v [m], v the velocity that u and w stand for
  double (*decay)(double k);                ///< what the kernels get of the damping, per node
  /// v squared of the kinetic energy that belongs to u_n, from v, the acceleration a without damping, h and k. [m^2/s^2]
  double (*squared_velocity)(double v, double a, double h, double k);
  /// Longest stable step [s]; 0: none is. `central` = 2 / omega of the highest mode, the step that undamped central differences
  /// stand.
  double (*stable_step)(double central, const DampingRange& damping);

  // What may be done beside stepping.
  bool keeps_increment;  ///< `increment` is node_w as it is, whatever u; it scales with the step
  bool automatic;        ///< the step follows the state, and a run that burst goes on with a smaller one
  bool edits;            ///< cuts, tears, blades
  bool contact;          ///< with tools and of tissue
  bool matching;         ///< shape matching, alone and in hybrids
  bool relaxation;       ///< dynamic relaxation
};

const IntegratorInfo& integrator_info(Integrator integrator);
/// In the order of kernels/integrators.h.
std::span<const Integrator, integrator_count> all_integrators();
/// Those with a property, as "a, b or c".
std::string integrators_with(bool IntegratorInfo::*property);

}  // namespace pliant
