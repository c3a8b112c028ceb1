// A running simulation for programs that embed Pliant: step it, pull at it, draw it.
//
// Threads. A World may be used from any thread, but by one at a time; two at once are an Error (state). Worlds share nothing,
// so each may have a thread of its own, and what one computes does not depend on the others. The first step_async or
// advance_async makes a worker thread. While it is busy these calls do not wait for it: busy, poll, frame, frame_since, info,
// the tools, cut, move_blade, lift_blade, step_async, advance_async. All others do. Any number of threads may read a Frame.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "pliant/error.h"
#include "pliant/export.h"
#include "pliant/frame.h"
#include "pliant/probe.h"
#include "pliant/scene.h"
#include "pliant/world_types.h"

namespace pliant {

/// A scene on a backend.
class PLIANT_API World {
 public:
  /// Builds the model and opens the backend. Throws Error: input (the scene; the message names the place), io (a mesh file),
  /// device (the backend).
  explicit World(const SceneSpec& scene, const WorldOptions& options = {});
  /// A scene file (docs/scene.md). Throws as above.
  static World open(const std::string& file, const WorldOptions& options = {});
  /// The text of a scene file; relative mesh paths start from `folder`. A body whose "surface" is "memory:N" takes surfaces[N].
  static World parse(const std::string& text, const std::string& folder = "", const WorldOptions& options = {},
                     const std::vector<SurfaceSpec>& surfaces = {});
  World(World&&) noexcept;             ///< leaves the other one empty
  World& operator=(World&&) noexcept;  ///< likewise
  ~World();                            ///< stops the worker after the batch it is at

  [[nodiscard]] const WorldInfo& info() const;     ///< holds as long as the World
  [[nodiscard]] double time() const;               ///< [s], of the newest state
  [[nodiscard]] std::int64_t step_number() const;  ///< steps since the start
  [[nodiscard]] double dt() const;                 ///< [s], of the next step
  [[nodiscard]] double stable_dt() const;          ///< 2 / omega_max as of the last estimate [s]; 0: none was made

  /// Advance by `steps` (>= 0) and wait for them; stops early at a divergence or an equilibrium. Throws Error: diverged (it had
  /// diverged before), device (lost while it worked: frame() still gives the last state that was read), usage.
  StepReport step(std::int64_t steps = 1);
  /// As many whole steps as `seconds` [s] hold, and what is left over is added to the next call.
  StepReport advance(double seconds);

  /// Ask the worker for `steps` steps and a frame. False, and nothing happens, while it is still busy. Throws like step, also
  /// for what went wrong in the steps asked for last.
  bool step_async(std::int64_t steps);
  /// The same for `seconds` [s], which count as in advance(): what is left of them below a whole step goes into the next call.
  bool advance_async(double seconds);
  /// Steps are counted by step_async(); an integer of seconds has to be written as a double.
  template <class Integer, class = std::enable_if_t<std::is_integral_v<Integer>>>
  bool advance_async(Integer) = delete;
  [[nodiscard]] bool busy() const;  ///< the worker has something to do

  /// True if frame() would give another frame than last time. Never waits, never throws.
  [[nodiscard]] bool poll() const noexcept;
  /// Wait for the worker; what its last work did. Throws what it met.
  StepReport wait();

  /// The newest frame there is: while the worker is busy, that of the steps before; otherwise the present state, read from the
  /// device if need be. After a divergence the last good state, after the loss of the device the last one read.
  FramePtr frame();
  /// The same for one of several consumers, with what differs from `seen`, the frame that this consumer got last (null: none
  /// yet, so everything does). The World remembers nothing of it: neither poll() nor the ranges of other consumers change.
  FrameChange frame_since(const FramePtr& seen);

  /// Displacements [m] of a body's nodes, shape [nodes]. Throws Error (usage) if there is no such body.
  [[nodiscard]] std::vector<Vec3d> displacements(std::size_t body) const;
  [[nodiscard]] std::vector<Vec3d> velocities(std::size_t body) const;      ///< [m/s]
  [[nodiscard]] std::vector<Vec3d> rest_positions(std::size_t body) const;  ///< [m]

  /// What the scene's probes say of the present state, probe by probe, their quantities in the scene's order. Changes nothing.
  [[nodiscard]] std::vector<ProbeValue> probes() const;
  [[nodiscard]] std::vector<std::string> remarks() const;  ///< WorldInfo::remarks, and what `pliant run` would say by now
  [[nodiscard]] std::uint64_t hash() const;                ///< over the state: equal for equal bits

  /// Handles: grabs, pushes and the focus. They need WorldOptions::interactive, otherwise they throw Error (state); a vertex or
  /// grab that does not exist is usage. They take effect at the next batch of steps and do not wait. Vertices are those of the
  /// frame handed out last. Hold the surface at a vertex and pull it to a point that begins where the vertex is now.
  GrabId grab(std::int32_t vertex, const GrabOptions& options = {});
  void move_grab(GrabId grab, const Vec3d& target);  ///< [m]
  void release(GrabId grab);                         ///< let go

  /// A force [N] on a vertex, handed to the nodes of its cell, until it is set again; zero takes it away.
  void push(std::int32_t vertex, const Vec3d& force);
  /// A force [N] on a node of a body, likewise. The node must belong to a cell of the surface.
  void push_node(std::size_t body, std::int64_t node, const Vec3d& force);
  void clear_handles();  ///< remove all grabs and pushes
  void move_focus(
      const Vec3d& position);  ///< put the focus, which operational regions can follow, at a point [m], where it stays
  [[deprecated("clear_handles()")]] void clear_tools() { clear_handles(); }
  [[deprecated("move_focus()")]] void move_tool(const Vec3d& position) { move_focus(position); }

  /// Rigid tools that touch (docs/contact.md): those of SceneSpec::tools, and those that are added here. They need no
  /// WorldOptions::interactive. After step_async() and advance_async() the worker makes these changes before its next batch,
  /// until wait() or another call has waited for it; what it refuses is thrown by the next call that tells what it met. Tools
  /// are part of checkpoints. Throw Error, with nothing changed: usage (a name that no tool has or another one has already, a
  /// pose that is none), input (a shape or number that is none, a tool that would begin deeper than a quarter of a cell inside
  /// a body), io (a mesh), and but for drive_tool() diverged, device and what the worker met.
  ///
  /// Add a tool where its path has it now, at most 30 that are not parked. Gives its name: "tool0", "tool1", ... if it has
  /// none. A mesh is read here, and again by load(); relative files start from the working folder.
  std::string add_tool(const ToolSpec& tool);
  /// The same for a text, an entry of `tools` of a scene file (docs/scene.md); relative files start from `folder`.
  std::string parse_tool(const std::string& text, const std::string& folder = "");
  /// Remove a tool; its name may be used again.
  void remove_tool(const std::string& name);
  /// Keep a tool that touches nothing and costs nothing, until unpark_tool(), place_tool() or drive_tool().
  void park_tool(const std::string& name);
  /// Let a parked tool touch again where it is, or where its path has it now.
  void unpark_tool(const std::string& name);
  /// Put a tool at a place [m] and turn (unit quaternion x, y, z, w) at once, where it stays; its path is over.
  void place_tool(const std::string& name, const Vec3d& position, const std::array<double, 4>& turn = {0, 0, 0, 1});
  /// A tool goes from where it is to this place and turn, gets there after `seconds`, and stays; its path is over. More than
  /// 100 cells per second are refused (input) where tissue is in the way.
  void drive_tool(const std::string& name, const Vec3d& position, const std::array<double, 4>& turn, double seconds = 1.0 / 60);
  [[nodiscard]] std::vector<ToolForce> tool_forces() const;  ///< of all tools; does not wait

  /// Cuts. They need no WorldOptions::interactive. A volume mesh of hexahedra and a scene with relaxation or the textbook
  /// integrator cannot be cut: Error (input), with nothing changed. After step_async() and advance_async() the worker makes
  /// them before its next batch, moves of a blade together (CutResult::pending), until wait() or another call has waited for
  /// it; what it refuses is thrown by the next call that tells what it met. Where shape matching has substeps, a cut waits for
  /// the next batch that begins with one of its steps. Throw Error: usage (numbers that are not finite), diverged, device.
  ///
  /// Cut all bodies where these triangles [m] cross them now. A triangle without area cuts nothing.
  CutResult cut(const std::vector<std::array<Vec3d, 3>>& triangles);
  /// Move a blade of any name to the segment from `a` to `b` [m], which must differ (usage); it cuts what it sweeps over since
  /// its last place, measured from where the tissue has moved that place. Its first call only puts it there.
  CutResult move_blade(const std::string& blade, const Vec3d& a, const Vec3d& b);
  /// Take it out of the tissue: the next move_blade puts it elsewhere without a cut. Throws Error (usage): no such blade.
  void lift_blade(const std::string& blade);
  /// Into how many pieces a body has come apart, by cuts and tears or from the start: sets of elements that share nodes. Waits
  /// for the worker. Throws Error (usage) if there is no such body.
  [[nodiscard]] std::int64_t pieces(std::size_t body) const;

  /// Write a checkpoint; `pliant run --resume` reads it too. Cuts and the places of blades are part of it. Grabs and
  /// pushes belong to a World: after load() they are those of the one that loads. Throws Error: io.
  void save(const std::string& file) const;
  /// Go to the state of a checkpoint of the same scene. Blades are lifted. Throws Error: io, input (of another scene).
  void load(const std::string& file);
  /// Back to the start, without cuts, also after a divergence or the loss of the device (the backend is opened anew). Tools are
  /// cleared and blades lifted.
  void reset();

  struct PLIANT_HIDDEN Impl;  ///< private

 private:
  friend struct WorldAccess;
  explicit World(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// The version of the library that runs, "0.1.0".
PLIANT_API const char* version();
/// What --backend takes on this machine, "cpu" first, one by one with their devices; the text says whether each is bit-exact.
PLIANT_API std::vector<std::string> backend_names();

}  // namespace pliant
