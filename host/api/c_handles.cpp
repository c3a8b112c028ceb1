#include "api/c_handles.h"

#include <fmt/format.h>

namespace pliant::api {

Handles& Handles::all() {
  static Handles handles;
  return handles;
}

std::uint64_t Handles::add(std::shared_ptr<CWorld> world) {
  const std::lock_guard lock(mutex_);
  alive_.emplace(++last_, std::move(world));
  return last_;
}

std::shared_ptr<CWorld> Handles::find(std::uint64_t id) {
  if (id == 0) throw Error(ErrorCode::usage, "the handle names no world (its id is 0)");
  const std::lock_guard lock(mutex_);
  const auto found = alive_.find(id);
  if (found != alive_.end()) return found->second;
  throw Error(ErrorCode::state, fmt::format("there is no world with the handle {}: {}", id,
                                            id <= last_ ? "it was destroyed" : "it was never made"));
}

void Handles::remove(std::uint64_t id) {
  std::shared_ptr<CWorld> last = find(id);  // destroyed outside of the lock, after concurrent users have released it
  const std::lock_guard lock(mutex_);
  alive_.erase(id);
}

}  // namespace pliant::api
