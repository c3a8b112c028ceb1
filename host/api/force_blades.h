// The blades of a World that cut by force: requests of the caller, executed by the stepping thread, and what blades feel.
#pragma once
#include <mutex>
#include <string>
#include <vector>

#include "api/requests.h"
#include "pliant/tool.h"
#include "simulation/simulation.h"

namespace pliant::api {

/// As RigidTools: the caller's thread queues requests, the stepping thread executes them in order between two batches.
class ForceBlades {
 public:
  explicit ForceBlades(const Scene& scene);

  // For the caller's thread. They check names and numbers: Error (usage).

  [[nodiscard]] bool knows(const std::string& name) const;
  void drive(const std::string& name, const BladeSegment& to, double seconds);
  void lift(const std::string& name);
  void hold_back();  ///< as all of these: Requests
  void go_on();
  void add_save_point();
  void remove_save_point();
  [[nodiscard]] std::vector<BladeForce> forces() const;

  // For the stepping thread.

  /// Executes the requests. All are attempted; then the first Error is rethrown.
  void apply(Simulation& simulation);
  /// Stores what the blades feel for forces().
  void note(const Simulation& simulation);
  /// Call after the simulation was replaced: discards all requests, unless they were made for it.
  void renew(const Simulation& simulation, bool keep_requests = false);

 private:
  struct Request {
    std::string name;
    BladeSegment to{};
    double seconds = -1;  ///< negative: lift it
  };

  const std::vector<std::string> names_;
  mutable std::mutex mutex_;
  Requests<Request> asked_;
  std::vector<BladeForce> forces_;
};

}  // namespace pliant::api
