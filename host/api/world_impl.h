// The inside of a World. Private to host/api and its tests.
#pragma once
#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "api/frame_pool.h"
#include "api/rigid_tools.h"
#include "api/tools.h"
#include "pliant/world.h"
#include "simulation/measure/probing.h"
#include "simulation/simulation.h"

namespace pliant {

namespace api {

/// A cut that could not be made, or a tool that could not be put somewhere; the simulation is as it was before.
struct Refused : Error {
  using Error::Error;
  explicit Refused(const Error& error) : Error(error) {}
};

}  // namespace api

/// Opens a backend for a scene of so many nodes; `reason` receives the reason.
using OpenBackend = std::function<std::unique_ptr<Backend>(std::string* reason, std::int64_t nodes)>;

namespace api {

/// A cut that was asked for: along triangles, by a move of a blade, or one that a blade is lifted from.
struct CutRequest {
  std::vector<SweepTriangle> triangles;
  std::vector<BladePose> pose;  ///< at most one
  std::string lifted;           ///< no cut; before what else there is
};

}  // namespace api

/// One thread at a time steps the simulation: the caller's in step(), the worker in advance_async(). `mutex` protects what both
/// touch.
struct World::Impl {
  Impl(Scene scene, OpenBackend open, const WorldOptions& options);
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  // world_run.cpp
  StepReport run(std::int64_t steps);
  StepReport advance(double seconds);
  void read_frame(bool again = false);
  FramePtr hand_out(bool to_poll);
  void follow_topology();
  void publish_clock();
  [[nodiscard]] std::shared_ptr<Simulation> make_simulation(std::string* reason);
  void restart(std::shared_ptr<Simulation> fresh);
  [[nodiscard]] Error as_device_error(const std::exception& error) const;
  void check_can_step() const;

  // world_cut.cpp
  CutResult cut(api::CutRequest request);
  CutReport cut_now(std::span<const api::CutRequest> requests);
  void cut_pending();
  [[nodiscard]] api::SurfaceVertex vertex_of(std::int32_t vertex) const;

  // world_tools.cpp
  /// What is asked of the rigid tools is refused where the World cannot go on, unless the worker is at it.
  void check_can_change_tools();
  /// Do it now, unless there is a worker that will.
  void settle_tools();
  void change_tools_now();
  std::string add_tool(ContactTool tool);

  // world_worker.cpp
  bool start_job(std::function<void()> work);
  void wait_until_idle();
  void throw_failure();
  void serve();

  const WorldOptions options;
  const Scene scene;  ///< as of the start
  const OpenBackend open_backend;
  WorldInfo info;
  std::shared_ptr<const Model> model;  ///< as of the start
  PlacedProbes probes;
  std::shared_ptr<Simulation> simulation;
  std::unique_ptr<api::Tools> tools;
  api::RigidTools rigid_tools;
  std::string lost;         ///< message of the device's loss; empty: it works
  double seconds_left = 0;  ///< asked of advance() and not yet a whole step; of the thread that steps
  std::atomic<bool> in_use{false};
  std::int64_t strokes = 0;                      ///< blades put somewhere so far
  std::map<std::string, std::string> blade_key;  ///< what the simulation calls the blades that are in use

  std::shared_ptr<api::FramePool> pool = std::make_shared<api::FramePool>();
  std::shared_ptr<const Model> seen_model;  ///< the simulation's, when the topology was looked at last
  std::shared_ptr<const api::Topology> topology;
  std::shared_ptr<api::FrameData> last_read;  ///< of the thread that steps

  mutable std::mutex mutex;
  std::condition_variable changed;
  std::thread worker;
  bool stop = false;
  std::function<void()> job;                  ///< asked of the worker; empty: nothing
  std::vector<api::CutRequest> pending_cuts;  ///< for the worker's next batch
  bool beside = false;                        ///< the caller's: steps were asked of the worker, and nobody has waited since
  bool cut_since_read = false;                ///< `newest` does not show the last cut
  std::exception_ptr failure;
  StepReport report;  ///< of the last work
  double stable_dt = 0;
  std::shared_ptr<api::FrameData> newest;      ///< the last frame that was read
  std::shared_ptr<api::FrameData> given;       ///< what frame() gave last
  IndexRange dirty_vertices, dirty_triangles;  ///< from `given` to `newest`
  std::shared_ptr<const api::Topology>
      shown;  ///< of the frame that the user got last, by whichever call: what its vertices name
};

/// What the rooms of Pliant and its tests may do with a World that its users may not.
struct WorldAccess {
  /// A World on a backend of the caller's.
  static World make(Scene scene, OpenBackend open, const WorldOptions& options = {});
  /// The simulation inside, once the worker is idle. It is replaced by reset() and load().
  static Simulation& simulation(World& world);
};

}  // namespace pliant
