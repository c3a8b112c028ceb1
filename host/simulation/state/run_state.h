// Everything that decides the next step of a run and is neither in the Model nor in the Program nor in a state buffer. One
// visitor names every member: checkpoints, the deep hash and comparisons see what it visits. What is not in here does not exist
// for a run.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "simulation/state/run_state_parts.h"

namespace pliant {

struct RunState {
  Clock clock;
  StepLimit limit;
  RelaxationState relaxation;
  std::optional<KeptState> kept;
  std::vector<CutRecord> cuts;  ///< in the order in which they were made
  std::vector<TearRecord> tears;
  std::vector<MovedRegion> regions;  ///< [bodies], once one has moved; empty: as in the scene
  std::int32_t most_substeps = 0;    ///< of hybrids, since more of them burst; 0: as in the scene
  BladeState blades;
  PendingEdits pending;
  std::vector<HostForce> forces;
  std::vector<double> offset;        ///< [slots][3] of the displacement, what node_u leaves out (drift.h) [m]; empty: nothing
  std::vector<NodeInertia> ballast;  ///< what elements got so that they stand the step (model/nodes/ballast.h)
  std::optional<Vec3d> tool;         ///< where the host put the tool [m]; nothing: on its path
  std::map<std::string, ToolDrive> driven;  ///< tools that the host has driven off their paths
  ContactLook look;
  std::int64_t opened = 0;            ///< edges that parted because they were stretched too far
  std::int64_t topology_version = 0;  ///< edits that changed elements
  ToolChanges tools;                  ///< tools that the host added, removed or parked
};

// The visitor, as that of the parts: v(name, member) for every member, in this order. v.last() has nothing to say where there
// is nothing.
template <class V>
void visit(V& v, RunState& s) {
  v("clock", s.clock), v("limit", s.limit), v("relaxation", s.relaxation), v("kept", s.kept), v("cuts", s.cuts);
  v("tears", s.tears), v("regions", s.regions), v("most_substeps", s.most_substeps), v("blades", s.blades),
      v("pending", s.pending), v("forces", s.forces);
  v("offset", s.offset), v("ballast", s.ballast), v("tool", s.tool), v("driven", s.driven), v("look", s.look),
      v("opened", s.opened), v("topology_version", s.topology_version);
  v.last("tools", s.tools);
}

/// Its bytes, the same on every machine: names, then values of eight little-endian bytes.
std::string write_state(const RunState& state);
/// Throws Error (bad_input) that names the first member that is not there as it should be.
RunState read_state(const std::string& bytes);

}  // namespace pliant
