// Checkpoints of a World, its return to the start, and its recovery: now, or between two frames of a freely running World.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>

#include "api/world_call.h"
#include "io/save.h"

namespace pliant {

using api::FileRequest;

namespace {

/// Returns true if a request replaces the simulation.
bool replaces(const FileRequest& r) { return r.what == FileRequest::What::load || r.what == FileRequest::What::reset; }

/// What an event says about a request that was served.
std::string text_of(const FileRequest& r, double time) {
  switch (r.what) {
    case FileRequest::What::save:
      return fmt::format("the state at {:.4g} s is in {}", time, r.file);
    case FileRequest::What::load:
      return fmt::format("the World goes on at {:.4g} s from {}", time, r.file);
    case FileRequest::What::reset:
      return "the World is back at its start";
    case FileRequest::What::recover:
      return fmt::format("the World goes on at {:.4g} s from the last good state, at rest", time);
  }
  return {};
}

void check_there(const std::string& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    throw Error(ErrorCode::io, fmt::format("{}: no such file, expected a checkpoint", file));
}

/// Stops the motion in the bytes of node_w, whose records are three numbers and the decay, which stays.
template <class Real>
void stop_motion(std::vector<std::uint8_t>& w, const std::vector<std::uint8_t>& u, bool keeps_increment) {
  for (std::size_t at = 0; at + 4 * sizeof(Real) <= w.size(); at += 4 * sizeof(Real)) {
    if (keeps_increment) {
      std::memset(w.data() + at, 0, 3 * sizeof(Real));
    } else {
      std::memcpy(w.data() + at, u.data() + at, 3 * sizeof(Real));  // the displacement of the step before
    }
  }
}

}  // namespace

namespace {

/// Saves what the World has with all that was asked of it before, and nothing that was asked since.
void save_in_turn(World::Impl& world, const std::string& file) {
  const auto end = [&world] {
    const std::lock_guard lock(world.mutex);
    world.pending_cuts.remove_save_point();
    world.pending_changes.remove_save_point();
    world.rigid_tools.remove_save_point();
    world.force_blades.remove_save_point();
  };
  try {
    api::check_device(world);
    if (!world.report.diverged) world.make_changes(true);
    world.save(file);
  } catch (...) {
    end();
    throw;
  }
  end();
}

}  // namespace

void World::Impl::save(const std::string& file) {
  const Checkpoint checkpoint = take_checkpoint(*simulation);
  try {
    write_checkpoint(file, checkpoint);
  } catch (const Error& error) {
    throw Error(ErrorCode::io, error.what());
  }
}

std::shared_ptr<Simulation> World::Impl::replacement(const std::string& file, const TopologyEdits::Shared& like) {
  std::optional<Checkpoint> checkpoint;
  if (!file.empty()) checkpoint = read_checkpoint(file);
  auto fresh = make_simulation(like);
  if (checkpoint) restore_checkpoint(*fresh, *checkpoint, file);
  return fresh;
}

/// Goes on from the last good state, at rest: its motion was on the way to the divergence.
void World::Impl::recover() {
  end_edit();
  Snapshot snapshot = simulation->snapshot();
  const auto bytes_of = [&](const char* name) -> std::vector<std::uint8_t>& {
    return std::find_if(snapshot.buffers.begin(), snapshot.buffers.end(), [&](const NamedBytes& b) { return b.name == name; })
        ->bytes;
  };
  const bool keeps_increment = integrator_info(simulation->scene().integrator).keeps_increment;
  if (snapshot.real_type == "double") {
    stop_motion<double>(bytes_of("node_w"), bytes_of("node_u"), keeps_increment);
  } else {
    stop_motion<float>(bytes_of("node_w"), bytes_of("node_u"), keeps_increment);
  }
  simulation->restore(snapshot);
  events.renew(*simulation);
  seconds_left = 0;
  publish_clock();
  read_frame(true);
}

bool World::Impl::leave_to_worker(FileRequest request) {
  {
    const std::lock_guard lock(mutex);
    if (!pace.running()) return false;
    if (replaces(request)) {
      replacing = true;  // what the caller asked for before this is void, and what it asks for from now on is for the next
      pending_cuts.hold_back();
      pending_changes.hold_back();
      rigid_tools.hold_back();
      handles->hold_back();
      force_blades.hold_back();
      blade_key.clear();
    }
    if (request.what == FileRequest::What::save) {
      pending_cuts.add_save_point();
      pending_changes.add_save_point();
      rigid_tools.add_save_point();
      force_blades.add_save_point();
    }
    files.push_back(std::move(request));
  }
  changed.notify_all();
  return true;
}

/// Returns false for a request that waits for replacement(); frames go on meanwhile, unless a call waits for the worker.
bool World::Impl::serve_file(const FileRequest& request) {
  if (replaces(request)) {
    if (!next.valid()) {
      const auto make = [this, file = request.file, like = simulation->edits().shared()] { return replacement(file, like); };
      next = std::async(std::launch::async, make);
    }
    std::unique_lock lock(mutex);
    const bool waits = held || !pace.running();  // for it, rather than for the next frame
    lock.unlock();
    if (!waits && next.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    restart(next.get(), true);
    return true;
  }
  switch (request.what) {
    case FileRequest::What::save:
      save_in_turn(*this, request.file);
      return true;
    case FileRequest::What::recover:
      api::check_device(*this);
      if (report.diverged) recover();
      return true;
    default:
      return true;
  }
}

/// The time that this takes is not one that frames have to catch up with.
void World::Impl::serve_files() {
  const double start = api::wall_time();
  std::vector<FileRequest> requests;
  {
    const std::lock_guard lock(mutex);
    requests = files;  // they stay there until they are served: load() looks for a save() under way
  }
  if (requests.empty()) return;
  std::ptrdiff_t served = 0;
  for (const FileRequest& r : requests) {
    static constexpr const char* words[] = {"saved", "loaded", "reset", "recovered"};
    Event event = api::event_of(words[static_cast<int>(r.what)], r.file, 0, {});
    try {
      if (!serve_file(r)) break;
      event.text = text_of(r, simulation->time());
    } catch (const std::exception& error) {
      event.kind = "refused";
      event.text = error.what();
      const std::lock_guard lock(mutex);
      loaded_parameters = simulation->state().changed.parameters;  // the caller may have counted on others
    }
    events.add(*simulation, std::move(event));
    ++served;
  }
  {
    const std::lock_guard lock(mutex);
    files.erase(files.begin(), files.begin() + served);
    halted = report.diverged || !lost.empty();
    replacing = std::any_of(files.begin(), files.end(), replaces);
    if (!replacing) {
      pending_cuts.go_on();
      pending_changes.go_on();
      rigid_tools.go_on();
      handles->go_on();
      force_blades.go_on();
    }
    pace.skip(api::wall_time() - start);
  }
  changed.notify_all();
}

void World::save(const std::string& file) const {
  const api::Call call(impl_, false);
  if (impl_->leave_to_worker({FileRequest::What::save, file})) return;
  const api::Hold hold(*impl_);
  api::check_device(*impl_);
  impl_->save(file);
}

void World::load(const std::string& file) {
  const api::Call call(impl_, false);
  const auto writes_it = [&](const FileRequest& r) { return r.what == FileRequest::What::save && r.file == file; };
  std::unique_lock lock(impl_->mutex);
  const bool about_to_come = std::any_of(impl_->files.begin(), impl_->files.end(), writes_it);
  lock.unlock();
  if (!about_to_come) check_there(file);
  if (impl_->leave_to_worker({FileRequest::What::load, file})) return;
  const api::Hold hold(*impl_);
  impl_->restart(impl_->replacement(file, impl_->simulation->edits().shared()));
}

void World::reset() {
  const api::Call call(impl_, false);
  if (impl_->is_live()) {
    impl_->handles->clear();
    impl_->asked_parameters.clear();
  }
  if (impl_->leave_to_worker({FileRequest::What::reset, {}})) return;
  const api::Hold hold(*impl_);
  auto fresh = impl_->replacement({}, impl_->simulation->edits().shared());
  impl_->handles->clear();
  impl_->restart(std::move(fresh));
}

void World::recover() {
  const api::Call call(impl_, false);
  {
    const std::lock_guard lock(impl_->mutex);
    if (impl_->pace.running() && !impl_->report.diverged) return;
  }
  if (impl_->leave_to_worker({FileRequest::What::recover, {}})) return;
  const api::Hold hold(*impl_);
  if (!impl_->report.diverged) return;
  api::check_device(*impl_);
  impl_->recover();
}

}  // namespace pliant
