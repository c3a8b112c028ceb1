// Everything that determines the next step of a run and is neither in the Model, the Program nor a state buffer. One visitor
// names every member; checkpoints, the deep hash and comparisons use it. State outside of this struct is lost when a run is
// resumed.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "simulation/state/pressed_blades.h"
#include "simulation/state/run_state_parts.h"

namespace pliant {

struct RunState {
  Clock clock;
  StepLimit limit;
  RelaxationState relaxation;
  std::optional<KeptState> kept;
  std::vector<CutRecord> cuts;  ///< in the order of the cuts
  std::vector<TearRecord> tears;
  std::vector<MovedRegion> regions;  ///< per body; empty until a region has moved
  std::int32_t most_substeps = 0;    ///< limit for hybrids, lowered after they burst; 0: none
  BladeState blades;
  PendingEdits pending;
  std::vector<HostForce> forces;
  std::vector<double> offset;  ///< part of the displacement that node_u omits (drift.h), shape [slots][3] [m]; empty: none
  std::vector<NodeInertia> ballast;  ///< inertia added so that elements are stable at the step (model/nodes/ballast.h)
  std::optional<Vec3d>
      focus;  ///< position of the focus set by the host [m], "tool" in checkpoints and hashes; empty: on its path
  DriveHistory<ToolDrive> driven;  ///< tools that the host moves off their paths
  ContactLook look;
  std::int64_t opened = 0;                        ///< number of edges split because they were overstretched
  std::int64_t topology_version = 0;              ///< number of edits that changed elements
  ToolChanges tools;                              ///< tools added, removed or parked by the host
  ChangedParameters changed;                      ///< parameters that have changed
  std::vector<std::vector<std::int32_t>> broken;  ///< per entry of Scene::joins its broken springs, ascending; empty: none
  std::map<std::string, PressedBlade> pressed;    ///< by name: the blades that cut by force
  std::map<std::string, bool> gripping;           ///< tools that the host told to grip or to let go, whatever their times say
  BladeDrives driven_blades;                      ///< those of them that the host moves off their paths
  RemadeElements remade;
};

// Visitor: calls v(name, member) for every member in this order, as the visitors of the parts do. v.last() writes nothing for
// an empty or false member, which keeps checkpoints compatible.
template <class V>
void visit(V& v, RunState& s) {
  v("clock", s.clock), v("limit", s.limit), v("relaxation", s.relaxation), v("kept", s.kept), v("cuts", s.cuts);
  v("tears", s.tears), v("regions", s.regions), v("most_substeps", s.most_substeps), v("blades", s.blades),
      v("pending", s.pending), v("forces", s.forces);
  v("offset", s.offset), v("ballast", s.ballast), v("tool", s.focus), v("driven", s.driven), v("look", s.look),
      v("opened", s.opened), v("topology_version", s.topology_version);
  v.last("tools", s.tools);
  v.last("given", s.tools.given);
  v.last("changed", s.changed);
  v.last("broken", s.broken);
  v.last("pressed", s.pressed);
  v.last("driven_blades", s.driven_blades);
  v.last("gripping", s.gripping);
  v.last("remade", s.remade);
}

/// Serializes the state, identically on every machine: names, and values as eight little-endian bytes.
std::string write_state(const RunState& state);
/// Throws Error (bad_input) that names the first missing or malformed member.
RunState read_state(const std::string& bytes);

}  // namespace pliant
