// Common start of every World call. Private to host/api.
#pragma once
#include <optional>
#include <string>

#include "api/world_impl.h"

namespace pliant::api {

/// Waits until the worker is idle, and keeps it so.
class Hold {
 public:
  explicit Hold(World::Impl& impl) : impl_(impl) { impl_.hold(); }
  ~Hold() { impl_.let_go(); }
  Hold(const Hold&) = delete;
  Hold& operator=(const Hold&) = delete;

 private:
  World::Impl& impl_;
};

/// Guards a call against concurrent calls, and optionally waits until the worker is idle.
class Call {
 public:
  explicit Call(const std::unique_ptr<World::Impl>& impl, bool wait = true) : in_use_(flag_of(impl)) {
    if (in_use_.exchange(true)) {
      throw Error(ErrorCode::state, "two threads use the same World at once; give each its own, or let them take turns");
    }
    if (wait) hold_.emplace(*impl);
  }
  ~Call() {
    hold_.reset();
    in_use_.store(false);
  }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

 private:
  static std::atomic<bool>& flag_of(const std::unique_ptr<World::Impl>& impl) {
    if (impl == nullptr) throw Error(ErrorCode::state, "this World was moved from and holds nothing");
    return impl->in_use;
  }
  std::atomic<bool>& in_use_;
  std::optional<Hold> hold_;
};

inline void check_device(const World::Impl& impl) {
  if (!impl.lost.empty()) throw Error(ErrorCode::device, impl.lost + "; only frame() can still be read");
}

/// Throws Error (usage) if there is no such body.
inline std::size_t check_body(const World::Impl& impl, std::size_t body) {
  if (body < impl.info.bodies.size()) return body;
  throw Error(ErrorCode::usage,
              "there is no body " + std::to_string(body) + "; the scene has " + std::to_string(impl.info.bodies.size()));
}

}  // namespace pliant::api
