// The worlds that C callers hold. Handles are looked up, never followed.
#pragma once
#include <cstdint>
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
  std::mutex mutex;                        ///< protects the others from callers who forget to take turns
  std::map<std::uint64_t, FramePtr> seen;  ///< the last frame of each consumer, which its pointers point to
  std::set<std::string> tool_names;        ///< what names of tools point to
  std::vector<ProbeValue> probes;          ///< what pointers of probes point to
};

/// The only state that all users of the C API share: which handles are alive.
class Handles {
 public:
  static Handles& all();
  std::uint64_t add(std::shared_ptr<CWorld> world);
  /// Throws Error: usage for no handle (0), state for one that is not alive (any more).
  std::shared_ptr<CWorld> find(std::uint64_t id);
  void remove(std::uint64_t id);

 private:
  std::mutex mutex_;
  std::uint64_t last_ = 0;
  std::map<std::uint64_t, std::shared_ptr<CWorld>> alive_;
};

}  // namespace pliant::api
