// Changes of a World's parameters: made at once if the caller steps, otherwise before the worker's next batch.
#include <nlohmann/json.hpp>

#include "api/world_call.h"
#include "scene/change.h"
#include "scene/parts.h"

namespace pliant {
namespace {

using api::Call;

}  // namespace

void World::Impl::change_pending() {
  std::vector<std::string> changes;
  {
    const std::lock_guard lock(mutex);
    changes = pending_changes.take();
  }
  if (changes.empty()) return;
  std::exception_ptr refused;  // the others are made nevertheless
  for (const std::string& text : changes) {
    try {
      simulation->change(text);
    } catch (const Error& error) {
      if (error.code() == ErrorCode::internal || error.code() == ErrorCode::device) throw;
      if (refused == nullptr) refused = std::make_exception_ptr(api::Refused(error));
    }
  }
  handles->follow(simulation->shared_model());
  if (refused != nullptr) std::rethrow_exception(refused);
}

void World::Impl::change(const std::string& text) {
  check_can_change_tools();
  {
    const std::lock_guard lock(mutex);
    if (loaded_parameters) asked_parameters = *std::exchange(loaded_parameters, std::nullopt);
  }
  asked_parameters = changed_parameters(scene, asked_parameters, text, "change");
  bool now = false;
  {
    const std::lock_guard lock(mutex);
    pending_changes.push(text);
    now = !job && !beside && !report.diverged && lost.empty();
  }
  if (!now) return;
  try {
    change_pending();
    publish_clock();
  } catch (const api::Refused& refused) {
    asked_parameters = simulation->state().changed.parameters;
    throw Error(refused.code(), refused.what());
  } catch (const std::exception& error) {
    const Error failure_now = as_device_error(error);
    lost = failure_now.what();
    throw failure_now;
  }
}

void World::set_state(std::size_t body, const std::vector<Vec3d>& displacements, const std::vector<Vec3d>& velocities) {
  const Call call(impl_);
  api::check_device(*impl_);
  impl_->check_can_step();
  api::check_body(*impl_, body);
  try {
    impl_->make_changes(true);  // what was asked for before it
    impl_->simulation->set_nodes(body, displacements, velocities);
  } catch (const api::Refused& refused) {
    impl_->publish_clock();
    throw Error(refused.code(), refused.what());
  } catch (const std::exception& error) {
    const auto* const known = dynamic_cast<const Error*>(&error);
    if (known != nullptr && known->code() == ErrorCode::usage) throw;
    const Error failure_now = impl_->as_device_error(error);
    impl_->lost = failure_now.what();
    throw failure_now;
  }
  impl_->publish_clock();
  impl_->read_frame(true);
}

void World::change(const ChangeSpec& change) {
  const Call call(impl_, false);
  impl_->change(change_json(change).dump());
}

void World::parse_change(const std::string& text) {
  const Call call(impl_, false);
  impl_->change(text);
}

}  // namespace pliant
