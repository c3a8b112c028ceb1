// The worlds of C callers. Handles are looked up in a table and never dereferenced.
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "pliant/world.h"

namespace pliant::api {

struct CWorld {
  explicit CWorld(World w) : world(std::move(w)) {}
  World world;
  std::mutex mutex;                        ///< protects the following members against concurrent calls
  std::map<std::uint64_t, FramePtr> seen;  ///< last frame of each consumer, which keeps its pointers valid
  std::set<std::string> names;             ///< storage of returned names of tools and bodies
  std::vector<ProbeValue> probes;          ///< storage of returned probe values
  std::deque<Event> waiting_events;        ///< not returned yet
  std::vector<Event> events;               ///< storage of returned events
};

/// The table of valid handles, the only state shared by all users of the C API.
class Handles {
 public:
  static Handles& all();
  std::uint64_t add(std::shared_ptr<CWorld> world);
  /// Throws Error: usage for handle 0, state for a handle that is not valid.
  std::shared_ptr<CWorld> find(std::uint64_t id);
  void remove(std::uint64_t id);

 private:
  std::mutex mutex_;
  std::uint64_t last_ = 0;
  std::map<std::uint64_t, std::shared_ptr<CWorld>> alive_;
};

}  // namespace pliant::api
