// Checkpoints of a World, its return to the start, and its recovery: now, or between two frames of a freely running World.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "api/world_call.h"
#include "io/save.h"

namespace pliant {

using api::FileRequest;

void World::Impl::save(const std::string& file) {
  const Checkpoint checkpoint = take_checkpoint(*simulation);
  try {
    write_checkpoint(file, checkpoint);
  } catch (const Error& error) {
    throw Error(ErrorCode::io, error.what());
  }
}

void World::Impl::load(const std::string& file, bool live) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    throw Error(ErrorCode::io, fmt::format("{}: no such file, expected a checkpoint", file));
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
  Snapshot snapshot = simulation->snapshot();
  for (NamedBytes& buffer : snapshot.buffers) {
    if (buffer.name == "node_w") std::fill(buffer.bytes.begin(), buffer.bytes.end(), std::uint8_t{0});
  }
  simulation->restore(snapshot);
  events.renew(*simulation);
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
      rigid_tools.drop_requests();
      blade_key.clear();
    }
    files.push_back(std::move(request));
  }
  changed.notify_all();
  return true;
}

/// The time that this takes is not one that frames have to catch up with.
void World::Impl::serve_files() {
  std::vector<FileRequest> requests;
  {
    const std::lock_guard lock(mutex);
    requests.swap(files);
  }
  if (requests.empty()) return;
  for (const FileRequest& r : requests) {
    static constexpr const char* words[] = {"saved", "loaded", "reset", "recovered"};
    Event event = api::event_of(words[static_cast<int>(r.what)], r.file, 0, {});
    try {
      switch (r.what) {
        case FileRequest::What::save:
          save(r.file);
          break;
        case FileRequest::What::load:
          load(r.file, true);
          break;
        case FileRequest::What::reset:
          reset(true);
          break;
        case FileRequest::What::recover:
          if (report.diverged) recover();
          break;
      }
    } catch (const std::exception& error) {
      event.kind = "refused";
      event.text = error.what();
    }
    events.add(*simulation, std::move(event));
  }
  {
    const std::lock_guard lock(mutex);
    halted = report.diverged || !lost.empty();
    replacing = std::any_of(files.begin(), files.end(), [](const FileRequest& r) {
      return r.what == FileRequest::What::load || r.what == FileRequest::What::reset;
    });
    pace.skip(api::wall_time());
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
  if (impl_->leave_to_worker({FileRequest::What::recover, {}})) return;
  const api::Hold hold(*impl_);
  if (!impl_->report.diverged) return;
  api::check_device(*impl_);
  impl_->recover();
}

}  // namespace pliant
