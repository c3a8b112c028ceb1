// Options, information and reports of a World.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pliant/export.h"
#include "pliant/frame.h"

namespace pliant {

/// Options for running a scene.
struct WorldOptions {
  std::string backend = "auto";  ///< auto, cpu, cpu:double, cpu:check, opencl or opencl:N
  double dt = 0;                 ///< time step [s]; 0: as in the scene
  bool normals = true;           ///< compute vertex normals for frames
  bool interactive = false;      ///< reserve forces on all surface nodes; required by grab(), push() and push_node()
  bool cutting = false;          ///< prepare for cuts at the start, so that the first cut takes no longer than later ones
};

/// One body of a World.
struct BodyInfo {
  std::string name;           ///< name in the scene
  std::int64_t nodes = 0;     ///< number of nodes of its mesh or lattice
  std::int64_t elements = 0;  ///< number of cells or mesh elements
  double mass = 0;            ///< [kg]
  IndexRange vertices;        ///< its vertices in a Frame, before any cut
  IndexRange triangles;       ///< its triangles in a Frame, before any cut
};

/// Properties of a World that do not change while it runs.
struct WorldInfo {
  std::string backend;               ///< backend name, for example "opencl:0"
  std::string device;                ///< name of the GPU or processor
  std::string reason;                ///< why this backend was chosen
  bool bit_exact = false;            ///< true if the device passed the start-up probe
  std::int64_t nodes = 0;            ///< number of nodes of all bodies
  std::int64_t elements = 0;         ///< number of elements of all bodies
  std::size_t vertices = 0;          ///< number of surface vertices, before any cut
  std::size_t triangles = 0;         ///< number of surface triangles, before any cut
  std::vector<BodyInfo> bodies;      ///< in scene order
  std::vector<std::string> remarks;  ///< the remarks that `pliant run` prints about holes, units and stiffness; empty: none
};

/// Result of a stepping call. A divergence is reported here and not thrown. The World then holds the last good state, and
/// further stepping throws Error (diverged).
struct StepReport {
  std::int64_t done = 0;        ///< number of steps performed by this call
  std::int64_t step = 0;        ///< number of steps since the start
  double time = 0;              ///< simulated time [s]
  double dt = 0;                ///< size of the next step [s]
  bool diverged = false;        ///< true if the simulation diverged; `message` says where
  bool at_equilibrium = false;  ///< true if dynamic relaxation has converged; further steps do nothing
  std::string message;          ///< describes the divergence: step, body, element, dt and the stable step
};

/// Where a ray meets the surface. Numbers of vertices and triangles are those of the frame that World::pick() used.
struct PickedPoint {
  std::size_t body = 0;             ///< index of the body
  std::size_t triangle = 0;         ///< number of the triangle
  std::int32_t vertex = 0;          ///< the vertex of the triangle nearest to the point, for World::grab() and push()
  std::array<double, 3> weights{};  ///< of the triangle's vertices; the point is their weighted mean (barycentric coordinates)
  Vec3d point{};                    ///< [m]
  Vec3d normal{};                   ///< outward normal of the triangle, unit length
  double distance = 0;              ///< from the origin of the ray to the point [m], whatever the length of its direction
};

/// Parameters of a grab: a patch of nodes held by a spring.
struct GrabOptions {
  double radius = 0;  ///< nodes within this rest distance of the vertex are held [m], and its own cell; 0: two edges of a cell
  double stiffness = 0;  ///< spring stiffness [N/m]; 0: comparable to the tissue's own stiffness
  double max_force = 0;  ///< upper bound of the force [N]; 0: three times Young's modulus times the square of the radius
};

/// State of a grab after its last update.
struct GrabState {
  Vec3d force{};         ///< force on the tissue [N]; zero before the first steps
  Vec3d gap{};           ///< from the vertex to the target [m]
  bool limited = false;  ///< the force is at its limit, and the vertex may not arrive
};

using GrabId = std::uint64_t;  ///< identifies a grab within one World; 0: none

/// Result of a cut. Cuts need no WorldOptions::interactive. Hexahedral volume meshes (unless the blades of
/// the scene have the method "separation" or "removal") and scenes with relaxation or the textbook integrator cannot be cut:
/// Error (input), and nothing changes. After step_async() or advance_async(), the worker cuts before its next batch, moves of
/// blades together, until wait() or another waiting call returns; if it rejects a cut, the next call that reports the worker's
/// errors throws. With substeps of shape matching, a cut waits for the next batch that begins with a shape-matching step.
struct CutResult {
  bool pending = false;  ///< true if the worker will cut, before its next batch or, while the World runs freely, beside its
                         ///< steps (event "cut"); the other members are then not set
  bool changed = false;  ///< true if elements were split, parted or removed; the next frame differs only if the surface changed
  std::int64_t edges = 0;     ///< number of edges between nodes cut by this call, of faces that it passed (separation), or of
                              ///< elements that it removed (removal)
  double seconds = 0;         ///< duration [s]
  std::int64_t in_part = 0;   ///< elements that still hold together where edges of theirs were cut: the blade ended in them
  std::int64_t elements = 0;  ///< by how many there are more (decomposition); negative: fewer (removal)
  double mass_lost = 0;       ///< with the elements that were removed [kg]
};

/// Version of the library, for example "0.1.0".
PLIANT_API const char* version();
/// Names of the backends available on this machine, "cpu" first.
PLIANT_API std::vector<std::string> backend_names();

}  // namespace pliant
