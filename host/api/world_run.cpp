// Stepping a World and reading its frames, on either thread.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "api/world_impl.h"
#include "model/unit_remarks.h"

namespace pliant {
namespace {

/// Missing mesh files are io errors; all other errors of a scene are input errors.
ErrorCode code_of_model(const Scene& scene, const Error& error) {
  std::error_code ignored;
  for (const Body& b : scene.bodies) {
    const auto& file = b.mesh.empty() ? b.surface : b.mesh;
    if (b.surface_in_memory == nullptr && !std::filesystem::exists(file, ignored)) return ErrorCode::io;
  }
  return error.code();
}

std::shared_ptr<const Model> model_of(const Scene& scene, std::vector<std::string>& remarks) {
  try {
    std::vector<SurfaceCheck> checks;
    auto model = std::make_shared<const Model>(build_model(scene, checks));
    remarks = model_remarks(checks, *model, scene);
    return model;
  } catch (const Error& error) {
    throw Error(code_of_model(scene, error), error.what());
  }
}

std::shared_ptr<const api::Topology> topology_of(std::shared_ptr<const Model> model, std::uint64_t version) {
  auto topology = std::make_shared<api::Topology>();
  topology->version = version;
  for (const Vec3d& x : model->surface.rest) {
    topology->rest.push_back({static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2]), 0});
  }
  const std::vector<char>& cut = model->surface.triangle_cut;
  if (std::find(cut.begin(), cut.end(), 1) != cut.end()) topology->cut_faces.assign(cut.begin(), cut.end());
  for (const ModelBody& b : model->bodies) {
    topology->body_vertices.push_back({static_cast<std::size_t>(b.first_vertex), static_cast<std::size_t>(b.vertices)});
    topology->body_triangles.push_back({static_cast<std::size_t>(b.first_triangle), static_cast<std::size_t>(b.triangles)});
  }
  topology->model = std::move(model);
  return topology;
}

WorldInfo info_of(const Model& model, const BackendInfo& backend, std::string reason) {
  WorldInfo info{
      backend.name, backend.device, std::move(reason), backend.bit_exact, model.nodes(), model.elements(), 0, 0, {}, {}};
  info.vertices = model.surface.rest.size();
  info.triangles = model.surface.triangles.size();
  for (const ModelBody& b : model.bodies) {
    info.bodies.push_back({b.name,
                           static_cast<std::int64_t>(b.slot.size()),
                           b.elements(),
                           b.mass,
                           {static_cast<std::size_t>(b.first_vertex), static_cast<std::size_t>(b.vertices)},
                           {static_cast<std::size_t>(b.first_triangle), static_cast<std::size_t>(b.triangles)}});
  }
  return info;
}

}  // namespace

World::Impl::Impl(Scene scene_, OpenBackend open, const WorldOptions& options_)
    : options(options_), scene(std::move(scene_)), open_backend(std::move(open)), model(model_of(scene, info.remarks)) {
  if (scene.probes != nullptr) probes = PlacedProbes(scene.probes->list, *model);
  std::string reason;
  simulation = make_simulation({}, &reason);
  std::vector<std::string> remarks = std::move(info.remarks);
  for (std::string& remark : simulation->remarks()) remarks.push_back(std::move(remark));
  info = info_of(*model, simulation->backend().info(), reason);
  info.remarks = std::move(remarks);
  handles = std::make_unique<api::SurfaceHandles>(model, scene);
  topology = topology_of(model, 1);
  seen_model = model;
  trust.renew(*simulation);
  rigid_tools.renew(*simulation);
  events.renew(*simulation);
  publish_clock();
  read_frame();
}

std::shared_ptr<Simulation> World::Impl::make_simulation(const TopologyEdits::Shared& like, std::string* reason) {
  std::unique_ptr<Backend> backend;
  try {
    backend = open_backend(reason, model->nodes());
  } catch (const Error& error) {
    throw Error(ErrorCode::device, error.what());
  }
  SimulationOptions same;
  same.like = like;
  auto fresh = std::make_shared<Simulation>(scene, model, std::move(backend), same);
  try {
    if (options.cutting) fresh->prepare_cuts();
  } catch (const Error& error) {  // for a scene that cannot be cut, the first actual cut throws
    if (error.code() == ErrorCode::internal || error.code() == ErrorCode::device) throw;
  }
  return fresh;
}

/// An error on the device during the run. Scenes are checked earlier, so any exception of a step is a device error.
Error World::Impl::as_device_error(const std::exception& error) const {
  return {ErrorCode::device, fmt::format("the backend {} failed at step {}: {}", info.backend, report.step, error.what())};
}

void World::Impl::check_can_step() const {
  if (!lost.empty()) throw Error(ErrorCode::device, lost + "; reset() opens it again");
  if (report.diverged)
    throw Error(
        ErrorCode::diverged,
        report.message + "; reset() or load() goes back to a state that can be stepped, recover() to the one that was kept");
}

void World::Impl::publish_clock() {
  if (trust.given()) {
    rigid_tools.note(*simulation);
    force_blades.note(*simulation);
  }
  const std::lock_guard lock(mutex);
  report.step = simulation->step();
  report.time = simulation->time();
  report.dt = simulation->dt();
  report.at_equilibrium = simulation->at_equilibrium();
  report.diverged = simulation->divergence().has_value();
  report.message = report.diverged ? simulation->divergence()->message() : "";
  stable_dt = simulation->stable_dt();
}

StepReport World::Impl::run(std::int64_t steps) {
  const std::int64_t first = simulation->step();
  try {
    if (simulation->at_equilibrium()) static_cast<void>(handles->apply(*simulation));  // driving a tool ends the equilibrium
    if (steps == 0) make_changes();                                                    // even without steps
    while (simulation->step() - first < steps && !simulation->divergence() && !simulation->at_equilibrium()) {
      make_changes();
      const std::int64_t left = std::min<std::int64_t>(steps - (simulation->step() - first), handles->apply(*simulation));
      simulation->advance(simulation->next_batch(left));
      rigid_tools.record(*simulation);
      note_batch();
      const std::lock_guard lock(mutex);
      if (stop) break;
    }
  } catch (const api::Refused& refused) {
    publish_clock();
    throw Error(refused.code(), refused.what());
  } catch (const std::exception& error) {
    const Error failure_now = as_device_error(error);
    lost = failure_now.what();
    throw failure_now;
  }
  publish_clock();
  const std::lock_guard lock(mutex);
  report.done = std::max<std::int64_t>(0, simulation->step() - first);  // a rollback may go behind this call
  return report;
}

/// Performs the whole steps that fit, counted from where the previous calls ended.
StepReport World::Impl::advance(double seconds) {
  const double end = simulation->time() + seconds_left + seconds;
  const std::int64_t first = simulation->step();
  try {
    run(0);
    // An automatic step may change, so recompute the remaining steps after every batch.
    while (!simulation->divergence() && !simulation->at_equilibrium()) {
      const double fit = std::floor((end - simulation->time()) / simulation->dt() + 1e-6);
      if (fit < 1) break;
      run(simulation->next_batch(static_cast<std::int64_t>(std::min(fit, 1e15))));
      const std::lock_guard lock(mutex);
      if (stop) break;
    }
  } catch (...) {
    seconds_left = end - simulation->time();
    throw;
  }
  const bool ends = simulation->divergence() || simulation->at_equilibrium();  // time that passes then is not owed
  seconds_left = ends ? 0 : end - simulation->time();
  const std::lock_guard lock(mutex);
  report.done = std::max<std::int64_t>(0, simulation->step() - first);
  return report;
}

/// A cut makes a model with other vertices and triangles; a moved operational region makes one with the same.
void World::Impl::follow_topology() {
  std::shared_ptr<const Model> now = simulation->shared_model();
  if (now == seen_model) return;
  seen_model = now;
  const ModelSurface &a = now->surface, &b = topology->model->surface;
  if (a.triangles != b.triangles || a.rest != b.rest || a.triangle_cut != b.triangle_cut)
    topology = topology_of(std::move(now), topology->version + 1);
}

/// Reads the surface into an unused frame and makes it the newest, once it is due. `again`: at once, also if it has been read.
void World::Impl::read_frame(bool again) {
  follow_topology();
  if (!again && last_read != nullptr && last_read->frame.step == simulation->step() && last_read->topology == topology) return;
  const std::size_t count = topology->rest.size();
  auto data = pool->take();
  data->topology = topology;
  const std::size_t bytes = simulation->surface_bytes();
  const bool is_double = simulation->backend().info().name == "cpu:double";
  data->positions.resize(bytes / (is_double ? 2 : 1) / sizeof(Vec4f));
  try {
    if (is_double) {
      std::vector<std::array<double, 4>> wide(data->positions.size());
      simulation->read_surface_into(wide.data());
      for (std::size_t v = 0; v < wide.size(); ++v) {
        for (std::size_t c = 0; c < 4; ++c) data->positions[v][c] = static_cast<float>(wide[v][c]);
      }
    } else {
      simulation->read_surface_into(data->positions.data());
    }
  } catch (const std::exception& error) {
    const Error failure_now = as_device_error(error);
    lost = failure_now.what();
    throw failure_now;
  }
  const auto& triangles = topology->model->surface.triangles;
  Frame& f = data->frame;
  f = Frame{};
  f.step = simulation->step();
  f.time = simulation->time();
  f.positions = {data->positions.data(), count};
  f.rest = {topology->rest.data(), count};
  f.triangles = {triangles.data(), triangles.size()};
  f.cut_faces = {topology->cut_faces.data(), topology->cut_faces.size()};
  f.body_vertices = {topology->body_vertices.data(), topology->body_vertices.size()};
  f.body_triangles = {topology->body_triangles.data(), topology->body_triangles.size()};
  f.topology_version = topology->version;
  if (options.normals) {
    api::vertex_normals(data->positions, count, f.triangles, f.cut_faces, data->normals);
    f.normals = {data->normals.data(), count};
  }
  IndexRange vertices{0, count}, faces{0, triangles.size()};
  if (last_read != nullptr) {
    vertices = api::changed_vertices(last_read->frame, f);
    faces = api::changed_triangles(last_read->frame, f);
  }
  last_read = data;
  const std::lock_guard lock(mutex);
  cut_since_read = false;
  frames.add(std::move(data), vertices, faces, again ? api::kLongAgo : pace.due());
  show_frames(pace.running() ? api::wall_time() : api::kAtLast);
}

void World::Impl::show_frames(double now) {
  for (int unseen = frames.show(now); unseen > 0; --unseen) pace.drop();
}

/// Returns the last completed frame while the worker is busy, otherwise the current state. Its topology defines the vertex
/// numbers for tools from now on, and pick() looks at it. `to_poll`: restart poll() and the frame's own dirty ranges here.
FramePtr World::Impl::hand_out(bool to_poll) {
  bool idle = false;
  {
    const std::lock_guard lock(mutex);
    idle = !job && !pace.running();
  }
  if (idle && lost.empty()) read_frame();
  const std::lock_guard lock(mutex);
  const double now = api::wall_time();
  show_frames(now);
  if (frames.seen() == frames.newest()) {
    pace.looked(now);
  } else if (pace.fetched(now)) {
    changed.notify_all();
  }
  if (to_poll) return {frames.give(), &frames.newest()->polled};
  return {frames.see(), &frames.newest()->frame};
}

/// Continues with another simulation of the same scene.
void World::Impl::restart(std::shared_ptr<Simulation> fresh, bool keep_requests) {
  simulation = std::move(fresh);
  trust.renew(*simulation);
  handles->renew();
  rigid_tools.renew(*simulation, keep_requests);
  force_blades.renew(*simulation, keep_requests);
  events.renew(*simulation);
  lost.clear();
  seconds_left = 0;
  if (keep_requests) {
    const std::lock_guard lock(mutex);
    failure = nullptr;
    loaded_parameters = simulation->state().changed.parameters;
  } else {
    blade_key.clear();
    asked_parameters = simulation->state().changed.parameters;
    const std::lock_guard lock(mutex);
    failure = nullptr;
    loaded_parameters.reset();
    pending_cuts = {};
    pending_changes = {};
  }
  publish_clock();
  read_frame(true);
}

}  // namespace pliant
