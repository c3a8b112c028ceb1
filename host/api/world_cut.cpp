// Cuts of a World, made by the stepping thread between two batches.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "api/world_call.h"
#include "cutting/topology/cut_topology.h"
#include "geometry/vec.h"
#include "model/pieces.h"

namespace pliant {
namespace {

void check_finite(const Vec3d& p, const char* what) {
  if (std::all_of(p.begin(), p.end(), [](double x) { return std::isfinite(x); })) return;
  throw Error(ErrorCode::usage, fmt::format("{}: got the point [{}] m; allowed are finite numbers", what, fmt::join(p, ", ")));
}

/// What an event says about a cut.
std::string text_of(const CutReport& done, BladeMethod method) {
  const char* what = "edges were cut";
  if (method == BladeMethod::separation) what = "faces were opened";
  if (method == BladeMethod::removal) what = "elements were removed";
  std::string text = fmt::format("{} {} in {:.3g} s", done.edges, what, done.seconds());
  if (method == BladeMethod::removal) text += fmt::format("; {:.4g} kg went with them", done.mass_lost);
  if (method == BladeMethod::decomposition) text += fmt::format("; {} more elements", done.elements);
  if (done.step_after < done.step_before)
    text += fmt::format("; the step fell from {:.4g} s to {:.4g} s", done.step_before, done.step_after);
  if (done.in_part > 0) text += fmt::format("; {} elements were cut in part and hold together", done.in_part);
  return text;
}

void tell_cut(World::Impl& world, const CutReport& done) {
  const Simulation& simulation = *world.simulation;
  world.handles->follow(simulation.shared_model());
  const std::string text = text_of(done, blade_method(simulation.scene()));
  world.events.add(simulation, api::event_of("cut", {}, static_cast<double>(done.edges), text, simulation.edited_at()));
  const std::lock_guard lock(world.mutex);
  world.cut_since_read = true;
}

}  // namespace

/// Makes one cut: along triangles, or by all pending blade moves. Errors of Simulation are the caller's; all others are
/// device errors.
CutReport World::Impl::cut_now(std::span<const api::CutRequest> requests) {
  try {
    CutReport done;
    std::vector<BladePose> poses;
    for (const api::CutRequest& r : requests) {
      if (!r.lifted.empty()) simulation->lift_blade(r.lifted);
      if (!r.triangles.empty()) done = simulation->cut(r.triangles);
      poses.insert(poses.end(), r.pose.begin(), r.pose.end());
    }
    if (!poses.empty()) done = simulation->move_blades(poses);
    if (done.changed) tell_cut(*this, done);
    return done;
  } catch (const Error& error) {
    if (error.code() == ErrorCode::internal || error.code() == ErrorCode::device) throw;
    throw api::Refused(error);
  }
}

void World::Impl::take_up_edit(bool wait) {
  TopologyEdits& edits = simulation->edits();
  try {
    do {
      while (const std::optional<CutReport> done = edits.take_built(wait)) {
        if (done->changed && done->asked) tell_cut(*this, *done);
      }
      if (wait && edits.building()) seconds_left -= simulation->dt() * static_cast<double>(simulation->advance(1));
    } while (wait && edits.building() && !simulation->divergence());
  } catch (const Error& error) {
    if (error.code() == ErrorCode::internal || error.code() == ErrorCode::device) throw;
    throw api::Refused(error);
  }
}

void World::Impl::end_edit() {
  simulation->edits().build_beside(false);  // until make_changes() decides again
  try {
    take_up_edit(true);
  } catch (const api::Refused& refused) {
    events.add(*simulation, api::event_of("refused", refused.subject, 0, refused.what()));
  } catch (const std::exception& error) {
    const Error failure_now = as_device_error(error);
    lost = failure_now.what();
    throw failure_now;
  }
  publish_clock();
}

/// Combines all blade moves between two batches into one cut; otherwise cuts that take longer than a frame would accumulate.
void World::Impl::cut_pending() {
  std::vector<api::CutRequest> requests;
  {
    const std::lock_guard lock(mutex);
    if (simulation->edits().building()) return;  // they come after that edit
    requests = pending_cuts.take();
  }
  std::exception_ptr refused;  // the others are made nevertheless
  const auto moves = [&](std::size_t r) { return !requests[r].pose.empty(); };
  for (std::size_t first = 0, last = 0; first < requests.size(); first = last) {
    if (simulation->edits().building()) {  // those that are left come after that edit, too
      const std::lock_guard lock(mutex);
      const auto left = requests.begin() + static_cast<std::ptrdiff_t>(first);
      pending_cuts.put_back(left, requests.end());
      break;
    }
    last = first + 1;
    while (moves(first) && last < requests.size() && moves(last) && requests[last].lifted.empty()) ++last;
    try {
      cut_now(std::span(requests).subspan(first, last - first));
    } catch (const api::Refused&) {
      if (refused == nullptr) refused = std::current_exception();
    }
  }
  if (refused != nullptr) std::rethrow_exception(refused);
}

CutResult World::Impl::cut(api::CutRequest request) {
  CutResult result;
  {
    const std::lock_guard lock(mutex);
    result.pending = job != nullptr || pace.running();
    if (result.pending) pending_cuts.push(std::move(request));
  }
  if (result.pending) return result;
  throw_failure();
  check_can_step();
  if (beside) {
    const std::lock_guard lock(mutex);
    pending_cuts.push(std::move(request));
    result.pending = true;
    return result;
  }
  try {
    cut_pending();
    const CutReport done = cut_now({&request, 1});
    publish_clock();
    return {false, done.changed, done.edges, done.seconds(), done.in_part, done.elements, done.mass_lost};
  } catch (const api::Refused& refused) {
    throw Error(refused.code(), refused.what());
  } catch (const std::exception& error) {
    const Error failure_now = as_device_error(error);
    lost = failure_now.what();
    throw failure_now;
  }
}

/// Converts a vertex number of the frame that the user received last.
api::SurfaceVertex World::Impl::vertex_of(std::int32_t vertex) const {
  std::shared_ptr<const api::Topology> seen;
  {
    const std::lock_guard lock(mutex);
    seen = (frames.seen() != nullptr ? frames.seen() : frames.newest())->topology;
  }
  for (std::size_t b = 0; b < seen->body_vertices.size(); ++b) {
    const IndexRange& part = seen->body_vertices[b];
    const std::int64_t local = vertex - static_cast<std::int64_t>(part.first);
    if (local >= 0 && local < static_cast<std::int64_t>(part.count)) return {b, static_cast<std::int32_t>(local)};
  }
  throw Error(ErrorCode::usage, fmt::format("there is no vertex {}; the surface has {}", vertex, seen->rest.size()));
}

CutResult World::cut(const std::vector<std::array<Vec3d, 3>>& triangles) {
  const api::Call call(impl_, false);
  for (const auto& t : triangles) {
    for (const Vec3d& p : t) check_finite(p, "cut");
  }
  return impl_->cut({triangles, {}, {}});
}

CutResult World::move_blade(const std::string& blade, const Vec3d& a, const Vec3d& b) {
  const api::Call call(impl_, false);
  const std::string what = fmt::format("blade '{}'", blade);
  if (impl_->force_blades.knows(blade))
    throw Error(ErrorCode::usage, fmt::format("{} cuts by force: drive_blade() moves it in time", what));
  check_finite(a, what.c_str());
  check_finite(b, what.c_str());
  if (a == b) {
    throw Error(ErrorCode::usage, fmt::format("{}: got a segment from [{}] m to itself; allowed are two different points", what,
                                              fmt::join(a, ", ")));
  }
  // Every stroke has a unique name, so that no data of an earlier stroke are reused.
  const auto [key, fresh] = impl_->blade_key.try_emplace(blade);
  if (fresh) key->second = fmt::format("{}#{}", blade, impl_->strokes++);
  return impl_->cut({{}, {{key->second, {a, b}}}, fresh ? key->second : std::string()});
}

void World::lift_blade(const std::string& blade) {
  const api::Call call(impl_, false);
  if (impl_->force_blades.knows(blade)) {
    impl_->force_blades.lift(blade);
    impl_->settle_tools();
    return;
  }
  const auto key = impl_->blade_key.find(blade);
  if (key == impl_->blade_key.end()) {
    throw Error(ErrorCode::usage, fmt::format("there is no blade '{}' to lift: move_blade makes it", blade));
  }
  const std::string name = key->second;
  impl_->blade_key.erase(key);
  const std::lock_guard lock(impl_->mutex);
  impl_->pending_cuts.push({{}, {}, name});
}

void World::drive_blade(const std::string& blade, const Vec3d& a, const Vec3d& b, double seconds) {
  const api::Call call(impl_, false);
  impl_->force_blades.drive(blade, {a, b}, seconds);
  impl_->settle_tools();
}

std::vector<BladeForce> World::blade_forces() const {
  const api::Call call(impl_, false);
  return impl_->force_blades.forces();
}

std::vector<CutAttempt> World::cut_attempts() {
  const api::Call call(impl_, false);
  return impl_->events.take_attempts();
}

std::int64_t World::pieces(std::size_t body) const {
  const api::Call call(impl_);
  return pieces_of(impl_->simulation->model().bodies[api::check_body(*impl_, body)]);
}

}  // namespace pliant
