// A running simulation inside another program: stepping, interaction, cutting and drawing.
//
// Threads: a World may be used from any thread, but only by one at a time; concurrent calls throw Error (state). Worlds share
// no state: each may have its own thread, and results do not depend on other Worlds. The first step_async() or
// advance_async() starts a worker thread. These calls do not wait while it is busy: busy, poll, frame, frame_since, pick,
// info, time, step_number, dt, stable_dt, live_state, events, cut_attempts, force_trace, the tools, cut, the blades,
// step_async, advance_async, run_live. All others wait. Any number of threads may read a Frame.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "pliant/error.h"
#include "pliant/export.h"
#include "pliant/frame.h"
#include "pliant/live.h"
#include "pliant/probe.h"
#include "pliant/scene.h"
#include "pliant/world_types.h"

namespace pliant {

/// A scene that runs on a backend.
class PLIANT_API World {
 public:
  /// Builds the model of `scene` and opens the backend. Throws Error: input (invalid scene; the message names the key), io (a
  /// missing mesh file), device (the backend cannot be opened).
  explicit World(const SceneSpec& scene, const WorldOptions& options = {});
  /// Loads a scene file (docs/scene.md). Throws as above, and io if the file does not exist.
  static World open(const std::string& file, const WorldOptions& options = {});
  /// Parses the text of a scene file; relative mesh paths start from `folder`. A body whose "surface" is "memory:N" uses
  /// surfaces[N]. Throws as the constructor.
  static World parse(const std::string& text, const std::string& folder = "", const WorldOptions& options = {},
                     const std::vector<SurfaceSpec>& surfaces = {});
  World(World&&) noexcept;             ///< leaves the source empty; calls on it throw Error (state)
  World& operator=(World&&) noexcept;  ///< leaves the source empty
  ~World();                            ///< stops the worker after its current batch

  [[nodiscard]] const WorldInfo& info() const;     ///< valid as long as the World
  [[nodiscard]] double time() const;               ///< time of the newest state [s]
  [[nodiscard]] std::int64_t step_number() const;  ///< number of steps since the start
  [[nodiscard]] double dt() const;                 ///< size of the next step [s]
  [[nodiscard]] double stable_dt() const;          ///< 2 / omega_max from the last estimate [s]; 0: no estimate was made

  /// Performs `steps` (>= 0) steps and returns when they are done. Stops early at a divergence or at equilibrium. Throws
  /// Error: diverged (the World had diverged before this call), device (the backend failed; frame() still returns the last
  /// state read), usage.
  StepReport step(std::int64_t steps = 1);
  /// Performs the whole steps that fit into `seconds` [s]; the remainder is added to the next call. Throws as step().
  StepReport advance(double seconds);

  /// Starts `steps` steps and a frame on the worker thread. Returns false and does nothing if the worker is still busy.
  /// Throws as step(), including errors of the previous asynchronous call.
  bool step_async(std::int64_t steps);
  /// The same for `seconds` [s]. As in advance(), the remainder below a whole step is added to the next call.
  bool advance_async(double seconds);
  template <class Integer, class = std::enable_if_t<std::is_integral_v<Integer>>>
  bool advance_async(Integer) = delete;  ///< step_async() counts steps: pass seconds as a double
  [[nodiscard]] bool busy() const;       ///< true while the worker runs

  /// Lets the worker run freely, paced by the wall clock (LiveOptions). Until stop_live(), step(), advance() and their
  /// asynchronous forms are Error (state), calls that wait do so for the frame at work, and save(), load(), reset() and
  /// recover() return at once: the worker does them between two frames. Called again it changes the options.
  void run_live(const LiveOptions& options = {});
  StepReport stop_live();                      ///< ends it after the frame at work; returns and throws as wait()
  [[nodiscard]] LiveState live_state() const;  ///< also after stop_live()

  /// Returns the events since the last call, oldest first, at most 1024 events; older ones are forgotten.
  std::vector<Event> events();
  /// Returns the force on a tool or by-force blade of each of the last 4096 steps after `after`. Throws usage: unknown name.
  [[nodiscard]] std::vector<ForceSample> force_trace(const std::string& tool, std::int64_t after = -1) const;
  [[nodiscard]] std::vector<ForceSample> force_trace(GrabId grab, std::int64_t after = -1) const;  ///< per update, some 2 ms

  /// Returns true if frame() would return a different frame than the last time. Never waits, never throws.
  [[nodiscard]] bool poll() const noexcept;
  /// Waits for the worker and returns the report of its last call. Throws the error that the worker met, if any.
  StepReport wait();

  /// Returns the newest frame: the last completed one while the worker is busy, otherwise the current state, read from the
  /// device if necessary. After a divergence it is the last good state, after a device failure the last state read.
  FramePtr frame();
  /// Returns the newest frame for one of several consumers, with the ranges that differ from `seen`, the frame that this
  /// consumer received last (null: everything is dirty). The World keeps no record of consumers, so poll() and the ranges of
  /// other consumers are unaffected.
  FrameChange frame_since(const FramePtr& seen);
  /// Returns where the ray from `origin` [m] first meets the surface of the frame returned last, from either side; nothing if
  /// it misses, or before the first frame. The length of `direction` does not matter. A ray through an edge or a vertex does
  /// not slip through. Throws Error (usage) for a direction that is zero and for numbers that are not finite.
  [[nodiscard]] std::optional<PickedPoint> pick(const Vec3d& origin, const Vec3d& direction) const;
  /// Sets displacements [m] and velocities [m/s] of a body's nodes now; an empty list leaves what there is. Components that the
  /// scene holds or moves keep theirs. Throws Error: usage (length, not finite), diverged, device.
  void set_state(std::size_t body, const std::vector<Vec3d>& displacements, const std::vector<Vec3d>& velocities = {});
  /// Returns the displacements [m] of a body's nodes, shape [nodes]. An unknown body is Error (usage), also in the next two.
  [[nodiscard]] std::vector<Vec3d> displacements(std::size_t body) const;
  [[nodiscard]] std::vector<Vec3d> velocities(std::size_t body) const;      ///< [m/s], shape [nodes]
  [[nodiscard]] std::vector<Vec3d> rest_positions(std::size_t body) const;  ///< [m], shape [nodes]

  [[nodiscard]] std::vector<ProbeValue> probes() const;  ///< the scene's probes now, in scene order, one entry per quantity

  /// Measures the overlaps of tools and bodies, and of bodies and bodies, now (docs/contact.md), those of tools
  /// first. Parked tools and bodies without a closed surface are left out.
  [[nodiscard]] std::vector<Interpenetration> interpenetrations() const;
  [[nodiscard]] std::vector<std::string> remarks() const;  ///< WorldInfo::remarks, then remarks about the run so far
  [[nodiscard]] std::uint64_t hash() const;  ///< XXH3 of displacements and increments; equal hashes mean equal bits

  /// Interactive tools. All but move_tool() need WorldOptions::interactive, otherwise Error (state); an unknown vertex or grab
  /// is Error (usage). They do not wait and take effect at the next batch. Vertex numbers are those of the frame returned last.
  ///
  /// Attaches a spring between the surface around `vertex` and a target, initially its current position. Returns its id.
  GrabId grab(std::int32_t vertex, const GrabOptions& options = {});
  void move_grab(GrabId grab, const Vec3d& target);       ///< moves the spring's target [m]
  [[nodiscard]] GrabState grab_state(GrabId grab) const;  ///< force and gap
  void release(GrabId grab);                              ///< removes the grab

  void push(std::int32_t vertex, const Vec3d& force);  ///< a constant force [N] on the nodes of its cell, until it is set again
  void push_node(std::size_t body, std::int64_t node, const Vec3d& force);  ///< to a node of a cell that carries the surface
  void clear_handles();                    ///< removes all grabs and pushes, and drives that have not started
  void move_focus(const Vec3d& position);  ///< moves the focus, which operational regions can follow, to a point [m]

  [[deprecated("clear_handles()")]] void clear_tools() { clear_handles(); }                       ///< its name before 0.2.0
  [[deprecated("move_focus()")]] void move_tool(const Vec3d& position) { move_focus(position); }  ///< its name before 0.2.0

  /// Rigid tools; pliant/tool.h describes when they change and their errors. This one
  /// adds a tool at its path's current pose; at most 29 tools may be unparked. Returns its name: "tool0", "tool1", ... if it
  /// has none. Mesh files are read here and again by load(); relative paths start from the working folder.
  std::string add_tool(const ToolSpec& tool);
  /// Adds a tool from text, an entry of `tools` of a scene file (docs/scene.md); relative paths start from `folder`.
  std::string parse_tool(const std::string& text, const std::string& folder = "");
  void remove_tool(const std::string& name);  ///< its name may be reused
  void park_tool(const std::string& name);    ///< disables it, at no cost, until unpark_tool(), place_tool() or drive_tool()
  void unpark_tool(const std::string& name);  ///< enables it again, at its last pose or at its path's current pose
  void grip_tool(const std::string& name, bool on = true);  ///< holds the tissue that it touches (ToolSpec::grip), or lets go

  /// Moves a tool at once to a position [m] and orientation (unit quaternion x, y, z, w), where it stays. Its path ends.
  void place_tool(const std::string& name, const Vec3d& position, const std::array<double, 4>& turn = {0, 0, 0, 1});
  /// Moves a tool from its current pose to the given one within `seconds` [s], after which it stays. Its path ends. A speed
  /// of more than 100 cells per second is rejected (input) where tissue is in the way.
  void drive_tool(const std::string& name, const Vec3d& position, const std::array<double, 4>& turn, double seconds = 1.0 / 60);
  /// Changes the shape of a mesh tool without `edges`: at `time` [s] it has this closed surface, in the tool's frame [m], of
  /// any triangles; in between it is interpolated (docs/contact.md). Up to three may be to come, with times that rise (usage);
  /// one that comes too late for the worker is reached as much later. In checkpoints.
  void set_tool_mesh(const std::string& name, const SurfaceSpec& surface, double time);
  /// Returns the pose of all tools and the forces on them. Does not wait.
  [[nodiscard]] std::vector<ToolForce> tool_forces() const;
  /// Returns the surface of a tool at the current time, in its own frame, outward, for drawing at the pose of tool_forces(); of
  /// a half space the part of its plane around the bodies. Waits for the worker.
  [[nodiscard]] SurfaceSpec tool_surface(const std::string& name) const;
  /// Returns a value per vertex at the current time: "displacement" [m], "energy" (strain energy density) [J/m^3], "mises" (von
  /// Mises stress) or contact "pressure" [Pa], "green_strain", "almansi_strain" (equivalent), or "finite_elements" (1; 0 where
  /// shape matching moves the vertex). Throws Error (usage) for another field.
  [[nodiscard]] std::vector<float> vertex_values(const std::string& field) const;
  /// Changes gravity, materials, models, or the supports of a body (docs/scene.md, "changes"); ChangeSpec::time is not used.
  /// The motion, contact and cuts stay, the stable step is estimated again. With substeps of shape matching, all but gravity
  /// waits for a step at which subcycles begin. After step_async() or advance_async() the worker makes it before its next
  /// batch. In checkpoints; reset() returns to the scene's parameters. Throws Error: input (a value that no scene could have,
  /// what cannot change), and then changes nothing; diverged, device.
  void change(const ChangeSpec& change);
  void parse_change(const std::string& text);  ///< the same from text, an entry of `changes` of a scene file without its time

  /// Cuts, as CutResult and BladeSpec::method say. All throw Error: input, usage (non-finite numbers), diverged, device.
  ///
  /// Cuts all bodies where these triangles [m] intersect them now. Degenerate triangles cut nothing.
  CutResult cut(const std::vector<std::array<Vec3d, 3>>& triangles);
  /// Moves a named blade to the segment from `a` to `b` [m]; the ends must differ (usage). It cuts the surface that it sweeps
  /// since its last position, which is carried along with the tissue. The first call for a name only places the blade.
  CutResult move_blade(const std::string& blade, const Vec3d& a, const Vec3d& b);
  /// Lifts a blade: its next move_blade() places it without cutting; one by force is nowhere until driven. Throws usage.
  void lift_blade(const std::string& blade);
  /// Moves a blade that cuts by force (docs/cutting.md) to the segment from `a` to `b` [m] within `seconds`; one that is
  /// nowhere is there at once. Its path ends. Throws as drive_tool(); input: longer than on its path, or too fast.
  void drive_blade(const std::string& blade, const Vec3d& a, const Vec3d& b, double seconds = 1.0 / 60);
  [[nodiscard]] std::vector<BladeForce> blade_forces() const;  ///< those blades, in scene order; does not wait
  std::vector<CutAttempt> cut_attempts();  ///< since the last call, oldest first, 1024 at most; does not wait
  [[nodiscard]] std::int64_t pieces(std::size_t body) const;  ///< number of sets of elements of a body that share nodes

  /// Writes a checkpoint, which `pliant run --resume` can read too. It includes cuts and the positions of blades, but not
  /// grabs and pushes, which belong to the World. Throws Error: io.
  void save(const std::string& file) const;
  /// Restores a checkpoint of the same scene. Lifts all blades; grabs and pushes of this World remain. Throws Error: io,
  /// input (a checkpoint of a different scene).
  void load(const std::string& file);
  /// Returns to the initial state without cuts, also after a divergence or a device failure (the backend is reopened). Clears
  /// grabs and pushes and lifts all blades.
  void reset();
  /// After a divergence, continues from the last good state, at rest and with tools, grabs and pushes as they are: move first
  /// what drove it apart. Does nothing otherwise.
  void recover();

  struct PLIANT_HIDDEN Impl;  ///< implementation

 private:
  friend struct WorldAccess;
  explicit World(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace pliant
