// Rigid tools in contact with the bodies of a scene (docs/contact.md): their description and the forces on them.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pliant/scene_conditions.h"
#include "pliant/wrench.h"

namespace pliant {

/// A tool that can hold tissue: while it grips, it holds the surface that its own meets (docs/contact.md).
struct GripSpec {
  double strength = 0;                       ///< traction at which tissue slips out [Pa]; 0: none does
  std::vector<std::array<double, 2>> times;  ///< intervals [from, to) in which it grips [s], ascending; or World::grip_tool()
};
/// Returns true if both are the same.
inline bool operator==(const GripSpec& a, const GripSpec& b) { return a.strength == b.strength && a.times == b.times; }

/// A rigid tool, at rest or on a prescribed path. Only the members that belong to `shape` are used.
///
/// The tools of a World are those of SceneSpec::tools and those added while it runs; they need no WorldOptions::interactive and
/// are part of checkpoints. After step_async() or advance_async(), the worker makes changes to them before its next batch,
/// until wait() or another waiting call returns; if it rejects one, the next call that reports the worker's errors throws. The
/// World's functions for tools throw Error and then change nothing: usage (unknown or duplicate name, invalid pose), input
/// (invalid shape or number, or the tool would start deeper than a quarter of a cell inside a body), io (mesh file); and,
/// except drive_tool(), diverged, device and errors of the worker.
struct ToolSpec {
  std::string name;               ///< unique; empty: tool0, tool1, ...
  std::string shape = "sphere";   ///< sphere, capsule, box, half_space, mesh or sequence, in the tool's own frame
  double radius = 0.01;           ///< radius of a sphere about the origin, or of a capsule [m]
  Vec3d first{};                  ///< one end of a capsule, or a point on the plane of a half space [m]
  Vec3d second{0, 0.1, 0};        ///< other end of a capsule [m], or outward normal of a half space
  Vec3d size{0.1, 0.1, 0.1};      ///< edge lengths of a box about the origin [m]
  std::string mesh;               ///< file of a closed surface, or for a sequence the folder of such files
  double scale = 1;               ///< factor on the mesh coordinates
  double frames_per_second = 30;  ///< rate of a sequence [1/s]; the first mesh is used at time 0
  std::vector<std::array<double, 8>>
      path;              ///< (time [s], origin [m], unit quaternion x, y, z, w), times ascending; empty: at rest at the origin
  double friction = 0;   ///< Coulomb friction coefficient
  double stiffness = 0;  ///< contact stiffness per area [Pa/m^exponent]; 0: "auto", rigid contact
  double exponent = 1;   ///< 1 or 1.5; needs a stiffness
  double alpha = 0;      ///< slope of the coefficient of restitution [s/m]; needs a stiffness
  bool edges = false;    ///< contact along the tool's edges, for parts thinner than half a cell (docs/contact.md)
  std::optional<GripSpec> grip;  ///< absent: it cannot hold tissue
};

/// Contact between bodies, of bodies with themselves, and between the faces of a cut (docs/contact.md).
struct ContactSpec {
  double friction = 0;  ///< Coulomb friction coefficient
};

/// Pose of a tool and the contact load on it in the newest batch of steps. Force and torque (about its origin) are means over
/// the batch; area and penetration are those of its last step with contact.
struct ToolForce : Wrench {
  std::string name;                        ///< name in the scene, or as added
  Vec3d position{};                        ///< position of its origin [m]
  std::array<double, 4> turn{0, 0, 0, 1};  ///< orientation, unit quaternion x, y, z, w
  double area = 0;                         ///< undeformed area of the tissue in contact [m^2]
  double penetration = 0;                  ///< greatest depth of a point inside the tool [m]
  bool parked = false;                     ///< true if the tool is parked and has no contact (World::park_tool)
};

/// Place of a blade that cuts by force (docs/cutting.md), the force and the torque (about the middle of its edge) on it in the
/// last step, and its history. Of a blade with faces they are those on edge and faces together.
struct BladeForce : Wrench {
  std::string name;        ///< name in the scene
  Vec3d a{};               ///< one end of its edge [m]
  Vec3d b{};               ///< the other end [m]
  double max_force = 0;    ///< largest force so far [N]
  double work = 0;         ///< done on tissue so far [J]
  double fracture = 0;     ///< of it, what cutting took [J]
  double gave_way = -1;    ///< time at which tissue first gave way [s]; -1: not yet
  bool present = false;    ///< false: its path has not begun or has ended, or it is lifted
  bool pressing = false;   ///< a part of its edge is in contact
  Vec3d face_force{};      ///< of the force, that on its two faces [N]
  double face_normal = 0;  ///< sum of the forces that press on its two sides, across it [N]
  double face_work = 0;    ///< of the work, that of its faces [J]
};

/// A potential cutting attempt: the surface vertex in contact with the edge of a blade that cuts by force has changed
/// (docs/cutting.md). Vertices are those of frames before any cut (BodyInfo::vertices).
struct CutAttempt {
  std::string blade;        ///< name in the scene
  std::string body;         ///< name in the scene
  std::int64_t stroke = 0;  ///< of the blade, counted from 0; a new one begins where the blade comes to the surface
  std::int32_t from = 0;    ///< vertex that was in contact
  std::int32_t to = 0;      ///< vertex that is
  double time = 0;          ///< [s]
  Vec3d position{};         ///< of the point of contact [m]
  Vec3d rest{};             ///< the same place on the undeformed surface [m]
  bool gave_way = false;    ///< true if tissue had given way there, false if the blade pressed on it
};

/// The overlap of a tool and a body, or of two bodies (docs/contact.md).
struct Interpenetration {
  std::string first;   ///< name of a tool or a body
  std::string second;  ///< name of a body
  bool tool = false;   ///< true if the first is a tool
  double volume = 0;   ///< [m^3]
  Vec3d centroid{};    ///< of this volume [m]
  std::array<double, 2>
      area{};        ///< of the first one's surface inside the second, and of the second one's inside the first [m^2]
  double depth = 0;  ///< greatest distance of a vertex inside the other from the other's surface [m]
  Vec3d deepest{};   ///< this vertex [m]; meaningless if the depth is 0: no vertex is inside
};

}  // namespace pliant
