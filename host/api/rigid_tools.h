// The rigid tools of a World: requests of the caller, executed by the stepping thread, and the forces on the tools.
#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "api/force_trace.h"
#include "api/requests.h"
#include "pliant/tool.h"
#include "simulation/simulation.h"

namespace pliant::api {

/// The caller's thread queues requests; the stepping thread executes them in order between two batches. Neither blocks the
/// other for longer than it takes to copy a few numbers.
class RigidTools {
 public:
  // For the caller's thread. These check names, numbers and files: Error (usage, input). Conflicts with tissue are found
  // later.

  /// Reads the tool's meshes. Returns its name, generated if it has none.
  std::string add(ContactTool tool);
  void remove(const std::string& name);
  void park(const std::string& name);
  void unpark(const std::string& name);
  void grip(const std::string& name, bool on);
  void place(const std::string& name, const Pose& at);
  void drive(const std::string& name, const Pose& to, double seconds);
  /// Gives a tool a surface to come, and computes its distances.
  void set_mesh(const std::string& name, TriangleMesh mesh, double time);
  /// Discards drives that are not executed yet.
  void drop_drives();
  void hold_back();  ///< as all of these: Requests
  void go_on();
  void add_save_point();
  void remove_save_point();
  [[nodiscard]] std::vector<ToolForce> forces();
  /// The force in each of the last steps after step `after`. Throws Error (usage) for an unknown tool.
  [[nodiscard]] std::vector<ForceSample> trace(const std::string& name, std::int64_t after);

  // For the stepping thread.

  /// The first of some drives in succession that take more time than was asked for.
  struct Slowed {
    std::string name;
    double asked = 0, seconds = 0;
  };
  /// Executes the requests. All are attempted; then the first Error is rethrown. `slowed`: drives through tissue that are too
  /// fast for contact take more time and are noted there; nullptr: they are refused.
  void apply(Simulation& simulation, std::vector<Slowed>* slowed = nullptr);
  /// The tool of the Error that apply() has thrown; empty: it has thrown none.
  [[nodiscard]] const std::string& refused() const { return refused_; }
  /// Call after a batch: stores the forces of its steps for trace().
  void record(const Simulation& simulation);
  /// Stores the forces on the tools for forces().
  void note(const Simulation& simulation);
  /// Call after the simulation was replaced: discards all requests, unless they were made for it.
  void renew(const Simulation& simulation, bool keep_requests = false);

 private:
  [[nodiscard]] std::int64_t still_valid(const Simulation& simulation);
  void record_blades(const Simulation& simulation, std::int64_t valid);
  enum class What { add, remove, park, unpark, place, drive, mesh, grip, let_go };
  struct Request {
    What what = What::add;
    std::string name;
    ContactTool tool;                                         ///< add
    std::shared_ptr<const ToolForm> form;                     ///< add
    Pose to;                                                  ///< place, drive
    double seconds = 0;                                       ///< drive
    std::shared_ptr<const GivenSurfaces> surfaces = nullptr;  ///< mesh
  };

  // Require the mutex.
  [[nodiscard]] const ContactTool* find(const std::string& name) const;
  [[nodiscard]] bool knows(const std::string& name) const { return find(name) != nullptr; }
  void check_known(const std::string& name) const;

  void ask(Request request);
  static void make(Simulation& simulation, const Request& request);
  void drive_in_time(Simulation& simulation, const Request& request, std::vector<Slowed>& slowed);
  void settle(const Simulation& simulation);
  void renew_given(const Simulation& simulation, const std::string& name);

  std::mutex mutex_;
  std::map<std::string, ContactTool> tools_;                           ///< those of the simulation after the last apply()
  std::map<std::string, std::shared_ptr<const GivenSurfaces>> given_;  ///< the last surfaces of tools that set_mesh() changes
  std::vector<Request> doing_;                                         ///< being executed
  Requests<Request> asked_;                                            ///< queued after these
  std::set<std::string> slow_;  ///< tools whose last drive took more time; used by the stepping thread
  std::string refused_;
  std::int64_t made_again_ = 0;  ///< RunReport::made_again at the last record()
  std::vector<ToolForce> forces_;
  std::map<std::string, ForceTrace> traces_;
  std::map<std::string, ForceTrace> blades_;  ///< of blades that cut by force
};

}  // namespace pliant::api
