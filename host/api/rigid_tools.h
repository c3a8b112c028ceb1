// The rigid tools of a World: what the caller wants of them, until the thread that steps has done it, and what they feel.
#pragma once
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "pliant/tool.h"
#include "simulation/simulation.h"

namespace pliant::api {

/// The caller's thread asks, the thread that steps does it between two batches, in the order in which it was asked; neither
/// waits for the other longer than it takes to copy a few numbers.
class RigidTools {
 public:
  // The caller's. Names, numbers and files are checked here: Error (usage, input). What the tissue forbids is found later.

  /// Reads the tool's meshes. Its name, which is a new one if it has none.
  std::string add(ContactTool tool);
  void remove(const std::string& name);
  void park(const std::string& name);
  void unpark(const std::string& name);
  void place(const std::string& name, const Pose& at);
  void drive(const std::string& name, const Pose& to, double seconds);
  /// Drives that were not done yet are forgotten.
  void drop_drives();
  [[nodiscard]] std::vector<ToolForce> forces();

  // The stepping thread's.

  /// Do what was asked. Throws the first Error there was, when all is done that can be.
  void apply(Simulation& simulation);
  /// What the tools have felt, for whoever asks.
  void note(const Simulation& simulation);
  /// The simulation is another one: nothing is asked of it yet.
  void renew(const Simulation& simulation);

 private:
  enum class What { add, remove, park, unpark, place, drive };
  struct Request {
    What what = What::add;
    std::string name;
    ContactTool tool;                      ///< add
    std::shared_ptr<const ToolForm> form;  ///< add
    Pose to;                               ///< place, drive
    double seconds = 0;                    ///< drive
  };

  // With the mutex held.
  [[nodiscard]] bool knows(const std::string& name) const;
  void check_known(const std::string& name) const;

  void ask(Request request);
  static void make(Simulation& simulation, const Request& request);
  void settle(const Simulation& simulation);

  std::mutex mutex_;
  std::set<std::string> names_;  ///< of the simulation, as of the last look
  std::vector<Request> doing_;   ///< on their way
  std::vector<Request> asked_;   ///< after these
  std::vector<ToolForce> forces_;
};

}  // namespace pliant::api
