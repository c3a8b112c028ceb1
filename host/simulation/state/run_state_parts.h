// The parts of RunState: clock, limits of the step, relaxation, edits, blades, tools.
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

namespace pliant {

/// Steps done and their length. The time of a step counts from where the length changed last.
struct Clock {
  std::int64_t step = 0;         ///< steps done
  std::int64_t origin_step = 0;  ///< the step in which dt changed last
  double origin_time = 0;        ///< [s] then
  double dt = 0;                 ///< [s]
  [[nodiscard]] double time_at(std::int64_t at) const { return origin_time + static_cast<double>(at - origin_step) * dt; }
  [[nodiscard]] double time() const { return time_at(step); }
};

/// How long an automatic step may be.
struct StepLimit {
  double stable_dt = 0;   ///< 2 / omega_max as of the last estimate [s]; 0: none
  double dt_ceiling = 0;  ///< an automatic step never grows beyond this [s]
  double dt_backoff = 1;  ///< share of the estimate that an automatic step still trusts
  std::int64_t hold = 0;  ///< it does not grow before this step
};

/// Dynamic relaxation: its damping rate, and what its next change is measured against.
struct RelaxationState {
  double damping = 0;               ///< [1/s], beside that of the materials
  bool equilibrium = false;         ///< reached: nothing is left to do
  double residual = 0;              ///< |R - F| over the largest of external and reaction force
  double time = 0;                  ///< of the last change [s]
  std::vector<double> u, force, v;  ///< node_u, node_force and velocities [m/s] at the last change; empty: there was none
  std::vector<double> middle;       ///< with shape matching: node_u halfway through the time that `force` is the mean of
  std::vector<double> steady;       ///< with shape matching: velocities in the rhythm of its steps, see relaxation.cpp [m/s]
  double largest = 0;               ///< with shape matching: of such means over all nodes [N]
};

/// The good state that last_u and last_w hold.
struct KeptState {
  Clock clock;
  double damping = 0;
};

/// The edges that one edit cut of one body.
struct CutRecord {
  std::int32_t body = 0;
  CutEdges edges;
};

/// The broken faces of one tetrahedron: bit f of `faces` is face f.
struct TearRecord {
  std::int32_t body = 0, tet = 0, faces = 0;
};

/// Where a blade goes in one update: along straight lines to each of these places. `key` names it in BladeState::traces.
struct BladeMove {
  std::string key;
  BladeSegment from{};
  std::vector<BladeSegment> to;
};

struct BladeState {
  std::optional<double> seen;                                        ///< time up to which the scene's blades have moved [s]
  std::map<std::string, BladeSegment> placed;                        ///< where the host put its own blades
  std::map<std::string, std::map<std::int32_t, BladeTrace>> traces;  ///< by key and body: the trace that it goes on from
  std::vector<std::string> met;                                      ///< keys of those that have come upon a body
};

/// Edits asked for inside a step of shape matching, made when the next one begins.
struct PendingEdits {
  std::vector<std::array<Vec3d, 3>> triangles;
  std::vector<BladeMove> moves;
};

/// A force that the host puts on a node [N].
struct HostForce {
  std::size_t body = 0;
  std::int64_t node = 0;
  Vec3d force{};
};

/// An operational region that has moved.
struct MovedRegion {
  Vec3d seed{};                     ///< [m]
  std::vector<std::int32_t> cells;  ///< of the uncut lattice, in order
  bool waits = false;               ///< some of them were deformed too far to change their model
  bool operator==(const MovedRegion&) const = default;
};

/// A tool that the host drives from one pose to another, at constant speed; at once if `end` is `start`.
struct ToolDrive {
  Pose from{}, to{};
  double start = 0, end = 0;  ///< [s]
};

/// What the host has made of the scene's tools. Nothing by itself: the tools are those of the scene.
struct ToolChanges {
  std::vector<ContactTool> added;    ///< in the order in which they came
  std::vector<std::string> removed;  ///< tools of the scene that are no more, ascending
  std::vector<std::string> parked;   ///< tools that are known and touch nothing, ascending
  [[nodiscard]] bool empty() const { return added.empty() && removed.empty() && parked.empty(); }
  bool operator==(const ToolChanges&) const = default;
};

// The visitor: v(name, member) for every member, in this order.
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
template <class V>
void visit(V& v, Pose& s) {
  v("position", s.position), v("turn", s.turn);
}
template <class V>
void visit(V& v, ToolDrive& s) {
  v("from", s.from), v("to", s.to), v("start", s.start), v("end", s.end);
}

template <class V>
void visit(V& v, ContactTool& s) {
  v("name", s.name), v("shape", s.shape), v("radius", s.radius), v("first", s.first), v("second", s.second), v("size", s.size);
  v("mesh", s.mesh), v("scale", s.scale), v("frames_per_second", s.frames_per_second), v("path", s.path);
  v("friction", s.friction), v("stiffness", s.stiffness), v("exponent", s.exponent), v("alpha", s.alpha);
}
template <class V>
void visit(V& v, ToolChanges& s) {
  v("added", s.added), v("removed", s.removed), v("parked", s.parked);
}

}  // namespace pliant
