// What a World is told and what it tells: options, information, reports.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "pliant/frame.h"

namespace pliant {

/// How a World runs its scene.
struct WorldOptions {
  std::string backend = "auto";  ///< auto, cpu, cpu:double, cpu:check, opencl or opencl:N
  double dt = 0;                 ///< [s]; 0: what the scene says
  bool normals = true;           ///< frames have vertex normals
  bool interactive = false;      ///< reserve forces on all nodes of the surface, which the tools below need
  bool cutting = false;          ///< prepare for cuts at the start, so that the first one does not take longer than others
};

/// One body of a World.
struct BodyInfo {
  std::string name;           ///< as in the scene
  std::int64_t nodes = 0;     ///< of its mesh or lattice
  std::int64_t elements = 0;  ///< cells or elements of the mesh
  double mass = 0;            ///< [kg]
  IndexRange vertices;        ///< its part of a Frame, as of the start
  IndexRange triangles;       ///< likewise
};

/// What does not change while a World runs.
struct WorldInfo {
  std::string backend;               ///< "opencl:0"
  std::string device;                ///< the processor's own name
  std::string reason;                ///< why this backend
  bool bit_exact = false;            ///< the device passed the start-up probe
  std::int64_t nodes = 0;            ///< of all bodies
  std::int64_t elements = 0;         ///< of all bodies
  std::size_t vertices = 0;          ///< of the surface, as of the start
  std::size_t triangles = 0;         ///< likewise
  std::vector<BodyInfo> bodies;      ///< in the order of the scene
  std::vector<std::string> remarks;  ///< sentences that `pliant run` prints: holes, units, stiffness; empty: nothing to say
};

/// What a call of step did. A divergence is reported here and not thrown; the World then holds the last good state, and
/// stepping it again is an Error (diverged).
struct StepReport {
  std::int64_t done = 0;        ///< steps done by this call
  std::int64_t step = 0;        ///< steps since the start
  double time = 0;              ///< [s]
  double dt = 0;                ///< [s], of the step to come
  bool diverged = false;        ///< `message` says where
  bool at_equilibrium = false;  ///< dynamic relaxation has converged: there is nothing more to do
  std::string message;          ///< of the divergence: step, body, element, dt against the stable step
};

/// A handful of the surface on a spring.
struct GrabOptions {
  double radius = 0;     ///< nodes within this distance of the vertex at rest are held too [m]; the vertex's own cell always is
  double stiffness = 0;  ///< of the spring [N/m]; 0: of the order of the tissue's own
  double max_force = 0;  ///< the pull never exceeds this [N]; 0: a quarter of Young's modulus on the handful's area
};

using GrabId = std::uint64_t;  ///< names a grab of one World; 0 is none

/// What a cut did.
struct CutResult {
  bool pending = false;    ///< the worker's next batch of steps begins with it, and nothing else is known
  bool changed = false;    ///< elements were divided; the next frame shows it if the surface is another one
  std::int64_t edges = 0;  ///< edges between nodes that were cut now
  double seconds = 0;      ///< what it took [s]
};

}  // namespace pliant
