// Checkpoints of a World, its return to the start, and its recovery: now, or between two frames of a freely running World.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "api/world_call.h"
#include "io/save.h"

namespace pliant {

using api::FileRequest;

namespace {

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

void World::Impl::save(const std::string& file) {
  const Checkpoint checkpoint = take_checkpoint(*simulation);
  try {
    write_checkpoint(file, checkpoint);
  } catch (const Error& error) {
    throw Error(ErrorCode::io, error.what());
  }
}

void World::Impl::load(const std::string& file, bool live) {
  const Checkpoint checkpoint = read_checkpoint(file);
  auto fresh = make_simulation(nullptr);
  restore_checkpoint(*fresh, checkpoint, file);
  restart(std::move(fresh), live);
}

void World::Impl::reset(bool live) {
  auto fresh = make_simulation(nullptr);
  if (!live) handles->clear();
  restart(std::move(fresh), live);
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
    if (request.what == FileRequest::What::load || request.what == FileRequest::What::reset) {
      replacing = true;  // what the caller asked for before this is void, and what it asks for from now on is for the next
      pending_cuts.clear();
      pending_changes.clear();
      rigid_tools.hold_back();
      force_blades.hold_back();
      blade_key.clear();
    }
    files.push_back(std::move(request));
  }
  changed.notify_all();
  return true;
}

void World::Impl::serve_file(const FileRequest& request) {
  switch (request.what) {
    case FileRequest::What::save:
      api::check_device(*this);
      for (const bool built : {false, true}) {  // what was asked for before it
        if (!report.diverged) make_changes(built);
      }
      return save(request.file);
    case FileRequest::What::load:
      return load(request.file, true);
    case FileRequest::What::reset:
      return reset(true);
    case FileRequest::What::recover:
      api::check_device(*this);
      if (report.diverged) recover();
      return;
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
  for (const FileRequest& r : requests) {
    static constexpr const char* words[] = {"saved", "loaded", "reset", "recovered"};
    Event event = api::event_of(words[static_cast<int>(r.what)], r.file, 0, {});
    try {
      serve_file(r);
    } catch (const std::exception& error) {
      event.kind = "refused";
      event.text = error.what();
      const std::lock_guard lock(mutex);
      loaded_parameters = simulation->state().changed.parameters;  // the caller may have counted on others
    }
    events.add(*simulation, std::move(event));
  }
  {
    const std::lock_guard lock(mutex);
    files.erase(files.begin(), files.begin() + static_cast<std::ptrdiff_t>(requests.size()));
    halted = report.diverged || !lost.empty();
    replacing = std::any_of(files.begin(), files.end(), [](const FileRequest& r) {
      return r.what == FileRequest::What::load || r.what == FileRequest::What::reset;
    });
    if (!replacing) {
      rigid_tools.go_on();
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
  impl_->load(file);
}

void World::reset() {
  const api::Call call(impl_, false);
  if (impl_->is_live()) {
    impl_->handles->clear();
    impl_->asked_parameters.clear();
  }
  if (impl_->leave_to_worker({FileRequest::What::reset, {}})) return;
  const api::Hold hold(*impl_);
  impl_->reset();
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
