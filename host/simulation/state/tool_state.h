// Parts of the run state that belong to tools.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "model/contact/given_surfaces.h"
#include "scene/contact_tool.h"
#include "simulation/state/drive_history.h"

namespace pliant {

/// Motion of a tool between two poses at constant speed, requested by the host; immediate if `end` equals `start`.
struct ToolDrive {
  Pose from{}, to{};
  double start = 0, end = 0;  ///< [s]
  [[nodiscard]] Pose at(double time) const { return time >= end ? to : between(from, to, (time - start) / (end - start)); }
};

/// Changes of the host to the scene's tools. Empty: the tools are those of the scene.
struct ToolChanges {
  std::vector<ContactTool> added;              ///< in the order in which they were added
  std::vector<std::string> removed;            ///< names of removed tools of the scene, ascending
  std::vector<std::string> parked;             ///< names of parked tools, ascending
  std::map<std::string, GivenSurfaces> given;  ///< surfaces of tools (World::set_tool_mesh)
  /// `given` is a member of the run state of its own.
  [[nodiscard]] bool empty() const { return added.empty() && removed.empty() && parked.empty(); }
};

// Visitors: v(name, member) for every member, in this order.
template <class V>
void visit(V& v, Pose& s) {
  v("position", s.position), v("turn", s.turn);
}
template <class V>
void visit(V& v, ToolDrive& s) {
  v("from", s.from), v("to", s.to), v("start", s.start), v("end", s.end);
}
template <class V>
void visit(V& v, GripSpec& s) {
  v("strength", s.strength), v("times", s.times);
}

template <class V>
void visit(V& v, ContactTool& s) {
  v("name", s.name), v("shape", s.shape), v("radius", s.radius), v("first", s.first), v("second", s.second), v("size", s.size);
  v("mesh", s.mesh), v("scale", s.scale), v("frames_per_second", s.frames_per_second), v("path", s.path);
  v("friction", s.friction), v("stiffness", s.stiffness), v("exponent", s.exponent), v("alpha", s.alpha);
  v.last("edges", s.edges);
  v.last("grip", s.grip);
}
template <class V>
void visit(V& v, TriangleMesh& s) {
  v("vertices", s.vertices), v("triangles", s.triangles);
}
template <class V>
void visit(V& v, NodeGrid& s) {
  v("origin", s.origin), v("spacing", s.spacing), v("size", s.size);
}
template <class V>
void visit(V& v, GivenSurface& s) {
  v("time", s.time), v("begin", s.begin), v("pose", s.pose), v("surface", s.surface);
}
template <class V>
void visit(V& v, GivenSurfaces& s) {
  v("grid", s.grid), v("surfaces", s.surfaces);
}
template <class V>
void visit(V& v, ToolChanges& s) {
  v("added", s.added), v("removed", s.removed), v("parked", s.parked);
}

}  // namespace pliant
