// Implementation of World. Private to host/api and its tests.
#pragma once
#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "api/event_log.h"
#include "api/force_blades.h"
#include "api/frame_queue.h"
#include "api/pace.h"
#include "api/requests.h"
#include "api/rigid_tools.h"
#include "api/surface_handles.h"
#include "api/trust.h"
#include "haptics/instrument.h"
#include "pliant/world.h"
#include "simulation/measure/probing.h"
#include "simulation/simulation.h"

namespace pliant {

/// Opens a backend for a scene with this number of nodes; `reason` receives the reason for the choice.
using OpenBackend = std::function<std::unique_ptr<Backend>(std::string* reason, std::int64_t nodes)>;

namespace api {
/// A rejected cut or tool change; the simulation is unchanged.
struct Refused : Error {
  using Error::Error;
  explicit Refused(const Error& error, std::string what_of = {}) : Error(error), subject(std::move(what_of)) {}
  std::string subject;  ///< tool; empty: a blade, a cut or a change
};

/// A requested cut: along triangles, by a move of a blade, or preceded by lifting a blade.
struct CutRequest {
  std::vector<SweepTriangle> triangles;
  std::vector<BladePose> pose;  ///< at most one
  std::string lifted;           ///< blade to lift before the rest
};

/// Work on the whole simulation that a freely running World does between two frames.
struct FileRequest {
  enum class What { save, load, reset, recover };
  What what = What::save;
  std::string file;  ///< of save and load
};

}  // namespace api

/// One thread at a time steps the simulation: the caller's in step(), the worker in advance_async(). `mutex` protects the
/// members that both use.
struct World::Impl {
  Impl(Scene scene, OpenBackend open, const WorldOptions& options);
  ~Impl();

  // world_run.cpp
  StepReport run(std::int64_t steps);
  StepReport advance(double seconds);
  void read_frame(bool again = false);
  FramePtr hand_out(bool to_poll);
  void show_frames(double now);  ///< requires the mutex: FrameQueue::show()
  void follow_topology();
  void publish_clock();
  [[nodiscard]] std::shared_ptr<Simulation> make_simulation(const TopologyEdits::Shared& like, std::string* reason = nullptr);
  /// `keep_requests`: those made since belong to the fresh simulation.
  void restart(std::shared_ptr<Simulation> fresh, bool keep_requests = false);
  [[nodiscard]] Error as_device_error(const std::exception& error) const;
  void check_can_step() const;

  // world_cut.cpp
  CutResult cut(api::CutRequest request);
  CutReport cut_now(std::span<const api::CutRequest> requests);
  void cut_pending();
  /// Takes up an edit that was built beside the steps; `wait`: makes steps until it can be. Throws api::Refused.
  void take_up_edit(bool wait);
  void end_edit();  ///< the same with `wait`; a refusal becomes an event
  [[nodiscard]] api::SurfaceVertex vertex_of(std::int32_t vertex) const;

  // world_instruments.cpp
  /// As run() and advance(): tools go where their devices are before it, and the devices learn the state of tissue after it.
  StepReport step_frame(std::int64_t steps);
  StepReport advance_frame(double seconds);
  Pose attach(std::shared_ptr<haptics::Instrument> instrument);
  void move_instruments(double seconds);
  void tell_instruments();

  // world_tools.cpp
  /// Throws if the World cannot continue, unless the worker is running (it reports errors itself).
  void check_can_change_tools();
  void settle_tools();  ///< applies changes of tools and blades now, unless a worker will
  void change_tools_now();
  std::string add_tool(ContactTool tool);

  // world_changes.cpp
  /// Checks a change of parameters, an entry of "changes" as text, and makes it now or leaves it to the worker.
  void change(const std::string& text);
  void change_pending();

  // world_files.cpp
  void save(const std::string& file);
  /// Makes the simulation that a load (empty: a reset) continues with. Any thread may do it.
  [[nodiscard]] std::shared_ptr<Simulation> replacement(const std::string& file, const TopologyEdits::Shared& like);
  void recover();
  /// Leaves it to the worker if the World runs freely; returns false otherwise.
  bool leave_to_worker(api::FileRequest request);
  void serve_files();
  bool serve_file(const api::FileRequest& request);

  // world_live.cpp
  void run_live(const LiveOptions& live);
  void stop_live();
  [[nodiscard]] bool is_live() const;
  void check_not_live(const char* call) const;
  /// Makes the caller's cuts and changes. While the World runs freely, a rejected change becomes an event. `wait`: take_up_edit
  void make_changes(bool wait = false);
  void look_for_events();
  void tell_failure(const std::exception_ptr& met);
  void live_frame();
  void note_batch();  ///< notes what the last batch has told, if its state may be shown
  /// Requires the mutex: true if the worker may begin a frame or serve files now.
  [[nodiscard]] bool may_begin() const;

  // world_worker.cpp
  bool start_job(std::function<void()> work);
  void hold();
  void let_go();
  void wait_for_work(std::unique_lock<std::mutex>& lock);
  void throw_failure();
  void serve();

  const WorldOptions options;
  const Scene scene;  ///< initial scene
  const OpenBackend open_backend;
  WorldInfo info;
  std::shared_ptr<const Model> model;  ///< initial model
  PlacedProbes probes;
  Interpenetrations interpenetrations;
  ToolShapes tool_shapes{kToolSides};
  std::shared_ptr<Simulation> simulation;
  std::unique_ptr<api::SurfaceHandles> handles;
  api::RigidTools rigid_tools;
  api::ForceBlades force_blades{scene};
  api::EventLog events;
  api::Trust trust;
  std::string lost;         ///< message of the device failure
  double editing = 0;       ///< wall time of make_changes() in this frame [s]; used by the stepping thread
  double seconds_left = 0;  ///< remainder of advance() below a whole step; used by the stepping thread
  std::atomic<bool> in_use{false};
  std::int64_t strokes = 0;                      ///< number of blade strokes so far
  std::map<std::string, std::string> blade_key;  ///< internal names of the blades in use

  std::shared_ptr<api::FramePool> pool = std::make_shared<api::FramePool>();
  std::shared_ptr<const Model> seen_model;  ///< the simulation's model at the last topology check
  std::shared_ptr<const api::Topology> topology;
  std::shared_ptr<api::FrameData> last_read;  ///< used by the stepping thread

  mutable std::mutex mutex;
  std::condition_variable changed;
  std::thread worker;
  bool stop = false;
  std::function<void()> job;                    ///< work for the worker; empty: idle
  api::Requests<api::CutRequest> pending_cuts;  ///< made before the worker's next batch
  api::Requests<std::string> pending_changes;   ///< likewise, after them
  std::string asked_parameters;                 ///< used by the caller: parameters after all changes (scene/change.h)
  bool beside = false;                          ///< used by the caller: asynchronous steps were started and not waited for
  bool cut_since_read = false;                  ///< the newest frame does not include the last cut
  std::vector<std::shared_ptr<haptics::Instrument>> instruments;
  api::Pace pace;
  bool held = false;                              ///< a call that waits is at work; no frame may begin
  bool halted = false;                            ///< diverged, or the device is lost: only files are served
  std::vector<api::FileRequest> files;            ///< for the worker
  std::future<std::shared_ptr<Simulation>> next;  ///< used by the worker: replacement() for the first of them, made beside it
  bool replacing = false;                         ///< one of them, to come or at work, replaces the simulation
  std::optional<std::string> loaded_parameters;   ///< asked_parameters from the next change on
  std::exception_ptr failure;
  StepReport report;  ///< of the last stepping call
  double stable_dt = 0;
  api::FrameQueue frames;
};

/// Access to a World for Pliant's own code and tests.
struct WorldAccess {
  /// Creates a World on a given backend.
  static World make(Scene scene, OpenBackend open, const WorldOptions& options = {});
  /// Returns the simulation, once the worker is idle. reset() and load() replace it.
  static Simulation& simulation(World& world);
  /// Lets an instrument drive its tool. Returns where the tool is. Throws Error (usage) for a tool that is unknown, parked or
  /// driven by another instrument.
  static Pose attach(World& world, std::shared_ptr<haptics::Instrument> instrument);
};

}  // namespace pliant
