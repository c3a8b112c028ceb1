// The parts of RunState: clock, step limits, relaxation, edits, blades, tools.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cutting/blade/blade_trace.h"
#include "model/model.h"
#include "simulation/contact/contact_look.h"
#include "simulation/state/changed_parameters.h"
#include "simulation/state/pressed_blades.h"
#include "simulation/state/tool_state.h"

namespace pliant {

/// Number of steps done and step size. Times are computed from the last change of the step size.
struct Clock {
  std::int64_t step = 0;         ///< number of steps done
  std::int64_t origin_step = 0;  ///< the step at which dt changed last
  double origin_time = 0;        ///< the time at origin_step [s]
  double dt = 0;                 ///< [s]
  [[nodiscard]] double time_at(std::int64_t at) const { return origin_time + static_cast<double>(at - origin_step) * dt; }
  [[nodiscard]] double time() const { return time_at(step); }
};

/// Limits on an automatic step.
struct StepLimit {
  double stable_dt = 0;   ///< 2 / omega_max from the last estimate [s]; 0: no estimate was made
  double dt_ceiling = 0;  ///< upper bound of an automatic step [s]
  double dt_backoff = 1;  ///< fraction of the estimate that an automatic step uses
  std::int64_t hold = 0;  ///< the step does not grow before this step number
};

/// Dynamic relaxation: the damping rate, and the state at its last update for comparison.
struct RelaxationState {
  double damping = 0;               ///< damping rate [1/s], in addition to that of the materials
  bool equilibrium = false;         ///< true once equilibrium is reached
  double residual = 0;              ///< |R - F| over the larger of external and reaction force
  double time = 0;                  ///< time of the last update [s]
  std::vector<double> u, force, v;  ///< node_u, node_force and velocities [m/s] at the last update; empty: no update yet
  std::vector<double> middle;       ///< with shape matching: node_u halfway through the time over which `force` is averaged
  std::vector<double> steady;       ///< with shape matching: velocities sampled at its steps, see relaxation.cpp [m/s]
  double largest = 0;               ///< with shape matching: the largest such averaged force over all nodes [N]
};

/// Clock and damping of the good state that is stored in the last_... buffers.
struct KeptState {
  Clock clock;
  double damping = 0;
  std::map<std::string, PressedBlade> pressed;  ///< RunState::pressed
};

/// The edges of one body that one edit cut; the elements that it removed, each as a pair with itself (RemadeBody).
struct CutRecord {
  std::int32_t body = 0;
  CutEdges edges;
};

/// The broken faces of one element: bit f of `faces` is face f, bit kWaiting + f a face that a blade has passed and that waits
/// (TornBody::part).
struct TearRecord {
  static constexpr int kWaiting = 8;
  std::int32_t body = 0, tet = 0, faces = 0;
  [[nodiscard]] int broken() const { return faces & ((1 << kWaiting) - 1); }
};

/// What decomposition and removal have done so far.
struct RemadeElements {
  std::int64_t edits = 0;
  std::int64_t elements = 0;  ///< by how many there are more, negative: fewer
  double mass = 0;            ///< that went with removed elements [kg]
  double energy = 0;          ///< that went with them: kinetic, of strain, and the potential of dead loads [J]
  double first_step = 0;      ///< the step before the first edit [s]
  [[nodiscard]] bool empty() const { return edits == 0; }
};

/// The motion of a blade in one update: along straight lines to each of these segments. `key` is its key in
/// BladeState::traces.
struct BladeMove {
  std::string key;
  BladeSegment from{};
  std::vector<BladeSegment> to;
};

struct BladeState {
  std::optional<double> seen;                  ///< time up to which the scene's blades have been moved [s]
  std::map<std::string, BladeSegment> placed;  ///< last segments of the host's blades
  std::map<std::string, std::map<std::int32_t, BladeTrace>> traces;  ///< by key and body: the trace that the next cut continues
  std::vector<std::string> met;                                      ///< keys of the blades that have reached a body
};

/// Edits requested between two steps of shape matching; made when the next one begins.
struct PendingEdits {
  std::vector<std::array<Vec3d, 3>> triangles;
  std::vector<BladeMove> moves;
};

/// A force of the host on a node [N].
struct HostForce {
  std::size_t body = 0;
  std::int64_t node = 0;
  Vec3d force{};
  bool operator==(const HostForce&) const = default;
};

/// An operational region that has moved.
struct MovedRegion {
  Vec3d seed{};                     ///< [m]
  std::vector<std::int32_t> cells;  ///< cells of the uncut lattice, ascending
  bool waits = false;               ///< true if some cells were deformed too far to change their model
  bool operator==(const MovedRegion&) const = default;
};

// Visitors: v(name, member) for every member, in this order.
template <class V>
void visit(V& v, Clock& s) {
  v("step", s.step), v("origin_step", s.origin_step), v("origin_time", s.origin_time), v("dt", s.dt);
}
template <class V>
void visit(V& v, StepLimit& s) {
  v("stable_dt", s.stable_dt), v("dt_ceiling", s.dt_ceiling), v("dt_backoff", s.dt_backoff), v("hold", s.hold);
}
template <class V>
void visit(V& v, RelaxationState& s) {
  v("damping", s.damping), v("equilibrium", s.equilibrium), v("residual", s.residual), v("u", s.u), v("force", s.force);
  v("time", s.time), v("v", s.v), v("middle", s.middle), v("steady", s.steady), v("largest", s.largest);
}
template <class V>
void visit(V& v, KeptState& s) {
  v("clock", s.clock), v("damping", s.damping);
  v.last("pressed", s.pressed);
}
template <class V>
void visit(V& v, CutRecord& s) {
  v("body", s.body), v("edges", s.edges);
}
template <class V>
void visit(V& v, TearRecord& s) {
  v("body", s.body), v("tet", s.tet), v("faces", s.faces);
}
template <class V>
void visit(V& v, RemadeElements& s) {
  v("edits", s.edits), v("elements", s.elements), v("mass", s.mass), v("energy", s.energy), v("first_step", s.first_step);
}
template <class V>
void visit(V& v, BladeMove& s) {
  v("key", s.key), v("from", s.from), v("to", s.to);
}
template <class V>
void visit(V& v, MaterialPoint& s) {
  v("cell", s.cell), v("tet", s.tet), v("weight", s.weight), v("rest", s.rest);
}
template <class V>
void visit(V& v, TracePoint& s) {
  v("place", s.place), v("node", s.node), v("point", s.carried);
}
template <class V>
void visit(V& v, BladeTrace& s) {
  v("blade", s.blade), v("levels", s.levels), v("points", s.points);
}
template <class V>
void visit(V& v, BladeState& s) {
  v("seen", s.seen), v("placed", s.placed), v("traces", s.traces), v("met", s.met);
}
template <class V>
void visit(V& v, PendingEdits& s) {
  v("triangles", s.triangles), v("moves", s.moves);
}
template <class V>
void visit(V& v, HostForce& s) {
  v("body", s.body), v("node", s.node), v("force", s.force);
}
template <class V>
void visit(V& v, NodeInertia& s) {
  v("slot", s.slot), v("inertia", s.inertia);
}
template <class V>
void visit(V& v, MovedRegion& s) {
  v("seed", s.seed), v("cells", s.cells), v("waits", s.waits);
}

}  // namespace pliant
