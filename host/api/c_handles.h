// The worlds, devices and loops of C callers. Handles are looked up in a table and never dereferenced.
#pragma once
#include <fmt/format.h>

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "pliant/haptics.h"
#include "pliant/world.h"

namespace pliant::api {

struct CWorld {
  explicit CWorld(World w) : world(std::move(w)) {}
  World world;
  std::mutex mutex;                         ///< protects the following members against concurrent calls
  std::map<std::uint64_t, FramePtr> seen;   ///< last frame of each consumer, which keeps its pointers valid
  std::set<std::string> names;              ///< storage of returned names of tools and bodies
  std::vector<ProbeValue> probes;           ///< storage of returned probe values
  std::deque<Event> waiting_events;         ///< not returned yet
  std::vector<Event> events;                ///< storage of returned events
  std::deque<CutAttempt> waiting_attempts;  ///< not returned yet

  void forget_attempts() {
    const std::lock_guard lock(mutex);
    waiting_attempts.clear();
  }
};

struct CDevice {
  explicit CDevice(std::shared_ptr<HapticDevice> d) : device(std::move(d)) {}
  std::shared_ptr<HapticDevice> device;
  std::mutex mutex;             ///< protects the following member
  std::set<std::string> texts;  ///< storage of returned texts
};

struct CLoop {
  CLoop(World& world, const std::string& tool, std::shared_ptr<HapticDevice> device, const HapticOptions& options)
      : loop(world, tool, std::move(device), options) {}
  HapticLoop loop;
  std::mutex mutex;                  ///< protects the following members
  std::set<std::string> models;      ///< storage of returned names
  std::deque<HapticSample> waiting;  ///< not returned yet
};

/// A table of valid handles of one kind. Numbers are never reused.
template <class T>
class HandleTable {
 public:
  /// `noun` is what messages call what a handle names.
  explicit HandleTable(const char* noun) : noun_(noun) {}
  std::uint64_t add(std::shared_ptr<T> made) {
    const std::lock_guard lock(mutex_);
    alive_.emplace(++last_, std::move(made));
    return last_;
  }
  /// Throws Error: usage for handle 0, state for a handle that is not valid.
  std::shared_ptr<T> find(std::uint64_t id) {
    if (id == 0) throw Error(ErrorCode::usage, fmt::format("the handle names no {} (its id is 0)", noun_));
    const std::lock_guard lock(mutex_);
    const auto found = alive_.find(id);
    if (found != alive_.end()) return found->second;
    throw Error(ErrorCode::state, fmt::format("there is no {} with the handle {}: {}", noun_, id,
                                              id <= last_ ? "it was destroyed" : "it was never made"));
  }
  void remove(std::uint64_t id) {
    std::shared_ptr<T> last = find(id);  // destroyed outside of the lock, after concurrent users have released it
    const std::lock_guard lock(mutex_);
    alive_.erase(id);
  }

 private:
  const char* noun_;
  std::mutex mutex_;
  std::uint64_t last_ = 0;
  std::map<std::uint64_t, std::shared_ptr<T>> alive_;
};

/// The tables, the only state shared by all users of the C API.
struct Handles {
  static HandleTable<CWorld>& all();
  static HandleTable<CDevice>& devices();
  static HandleTable<CLoop>& loops();
};

}  // namespace pliant::api
