// The public class: checks arguments, waits where documented, and delegates.
#include "pliant/world.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "api/surfaces.h"
#include "api/world_call.h"
#include "backends/choice/backends.h"
#include "pliant/version.h"
#include "scene/keys.h"
#include "scene/spec.h"
#include "simulation/measure/run_remarks.h"
#include "simulation/measure/surface_fields.h"

#define PLIANT_TEXT_OF(x) #x
#define PLIANT_TEXT(x) PLIANT_TEXT_OF(x)

namespace pliant {
namespace {

using api::Call;
using api::check_body;
using api::check_device;

void check_steps(std::int64_t steps) {
  if (steps < 0) throw Error(ErrorCode::usage, fmt::format("the number of steps is {}; 0 or more are allowed", steps));
}

void check_seconds(double seconds) {
  if (seconds >= 0 && std::isfinite(seconds)) return;
  throw Error(ErrorCode::usage, fmt::format("the time to advance is {} s; 0 or more is allowed", seconds));
}

void check_interactive(const World::Impl& impl) {
  if (!impl.scene.interactive) {
    throw Error(ErrorCode::state,
                "grabs, pushes and the focus need forces reserved for them: create the World with WorldOptions::interactive");
  }
}

std::unique_ptr<World::Impl> make_impl(Scene scene, const WorldOptions& options) {
  if (options.dt < 0 || !std::isfinite(options.dt)) {
    throw Error(ErrorCode::usage,
                fmt::format("WorldOptions::dt is {} s; 0 (as the scene says) or more is allowed", options.dt));
  }
  if (options.dt > 0) scene.dt = options.dt;
  scene.interactive = options.interactive;
  scene.cuttable = options.cutting;
  const OpenBackend open = [spec = options.backend](std::string* why, std::int64_t nodes) {
    return open_backend(spec, why, nodes, BackendUse::live);
  };
  return std::make_unique<World::Impl>(std::move(scene), open, options);
}

}  // namespace

World::World(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

World::World(const SceneSpec& spec, const WorldOptions& options) { impl_ = make_impl(scene_of(spec), options); }

World World::open(const std::string& file, const WorldOptions& options) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    throw Error(ErrorCode::io, fmt::format("{}: no such file, expected a scene file", file));
  }
  return World(make_impl(load_scene(file), options));
}

World World::parse(const std::string& text, const std::string& folder, const WorldOptions& options,
                   const std::vector<SurfaceSpec>& surfaces) {
  const std::string file = folder.empty() ? "" : (std::filesystem::path(folder) / "scene.json").string();
  Scene scene = parse_scene(text, file);
  api::set_surfaces(scene, surfaces);
  return World(make_impl(std::move(scene), options));
}

World WorldAccess::make(Scene scene, OpenBackend open, const WorldOptions& options) {
  scene.interactive = options.interactive;
  scene.cuttable = options.cutting;
  return World(std::make_unique<World::Impl>(std::move(scene), std::move(open), options));
}

Simulation& WorldAccess::simulation(World& world) {
  const Call call(world.impl_);
  return *world.impl_->simulation;
}

const WorldInfo& World::info() const {
  if (impl_ == nullptr) throw Error(ErrorCode::state, "this World was moved from and holds nothing");
  return impl_->info;
}

double World::time() const {
  const Call call(impl_, false);
  const std::lock_guard lock(impl_->mutex);
  return impl_->report.time;
}

std::int64_t World::step_number() const {
  const Call call(impl_, false);
  const std::lock_guard lock(impl_->mutex);
  return impl_->report.step;
}

double World::dt() const {
  const Call call(impl_, false);
  const std::lock_guard lock(impl_->mutex);
  return impl_->report.dt;
}

double World::stable_dt() const {
  const Call call(impl_, false);
  const std::lock_guard lock(impl_->mutex);
  return impl_->stable_dt;
}

StepReport World::step(std::int64_t steps) {
  const Call call(impl_);
  impl_->check_not_live("step");
  check_steps(steps);
  impl_->throw_failure();
  impl_->check_can_step();
  return impl_->step_frame(steps);
}

StepReport World::advance(double seconds) {
  const Call call(impl_);
  impl_->check_not_live("advance");
  check_seconds(seconds);
  impl_->throw_failure();
  impl_->check_can_step();
  return impl_->advance_frame(seconds);
}

bool World::step_async(std::int64_t steps) {
  const Call call(impl_, false);
  impl_->check_not_live("step_async");
  check_steps(steps);
  return impl_->start_job([impl = impl_.get(), steps] { impl->step_frame(steps); });
}

bool World::advance_async(double seconds) {
  const Call call(impl_, false);
  impl_->check_not_live("advance_async");
  check_seconds(seconds);
  return impl_->start_job([impl = impl_.get(), seconds] { impl->advance_frame(seconds); });
}

bool World::busy() const {
  const Call call(impl_, false);
  const std::lock_guard lock(impl_->mutex);
  return impl_->job != nullptr || impl_->pace.running();
}

bool World::poll() const noexcept {
  if (impl_ == nullptr) return false;
  const std::lock_guard lock(impl_->mutex);
  const double now = api::wall_time();
  impl_->show_frames(now);
  if (impl_->frames.seen() == impl_->frames.newest()) impl_->pace.looked(now);
  if (impl_->frames.has_more_than_given() || (impl_->cut_since_read && !impl_->pace.running())) return true;
  return !impl_->job && !impl_->pace.running() && impl_->frames.newest() != nullptr &&
         impl_->frames.newest()->frame.step != impl_->report.step;
}

StepReport World::wait() {
  const Call call(impl_);
  impl_->throw_failure();
  const std::lock_guard lock(impl_->mutex);
  return impl_->report;
}

FramePtr World::frame() {
  const Call call(impl_, false);
  return impl_->hand_out(true);
}

FrameChange World::frame_since(const FramePtr& seen) {
  const Call call(impl_, false);
  return api::change_since(seen.get(), impl_->hand_out(false));
}

std::vector<Vec3d> World::displacements(std::size_t body) const {
  const Call call(impl_);
  check_device(*impl_);
  return impl_->simulation->displacements(check_body(*impl_, body));
}

std::vector<Vec3d> World::velocities(std::size_t body) const {
  const Call call(impl_);
  check_device(*impl_);
  return impl_->simulation->velocities(check_body(*impl_, body));
}

std::vector<Vec3d> World::rest_positions(std::size_t body) const {
  const Call call(impl_);
  return impl_->simulation->model().bodies[check_body(*impl_, body)].rest;
}

std::vector<ProbeValue> World::probes() const {
  const Call call(impl_);
  check_device(*impl_);
  impl_->end_edit();
  const std::vector<ProbeState> states = impl_->probes.states(*impl_->simulation);
  std::vector<ProbeValue> values;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const SceneProbe& probe = impl_->probes.probe(i);
    for (const Quantity q : probe.quantities)
      values.push_back({probe.name, word_of(quantity_words(), q), states[i].numbers(q)});
  }
  return values;
}

std::vector<Interpenetration> World::interpenetrations() const {
  const Call call(impl_);
  check_device(*impl_);
  return impl_->interpenetrations.now(*impl_->simulation);
}

std::vector<float> World::vertex_values(const std::string& field) const {
  const Call call(impl_);
  check_device(*impl_);
  const Simulation& simulation = *impl_->simulation;
  if (field == "finite_elements") {
    const std::vector<float> kinds = vertex_kinds(simulation.model());
    std::vector<float> share;
    for (std::size_t v = 0; v < kinds.size(); v += 3) share.push_back(kinds[v]);
    return share;
  }
  const auto has_values = [](const ColorInfo& info) { return *info.title != 0; };
  if (const auto by = color_by(field); by && has_values(color_info(*by))) return pliant::vertex_values(simulation, *by);
  std::string allowed;
  for (const ColorInfo& info : colors()) allowed += has_values(info) ? fmt::format("\"{}\", ", info.word) : "";
  throw Error(ErrorCode::usage, fmt::format("there is no field \"{}\", expected {}or \"finite_elements\"", field, allowed));
}

std::vector<std::string> World::remarks() const {
  const Call call(impl_);
  check_device(*impl_);
  std::vector<std::string> remarks = impl_->info.remarks;
  for (std::string& remark : run_remarks(*impl_->simulation)) remarks.push_back(std::move(remark));
  return remarks;
}

std::uint64_t World::hash() const {
  const Call call(impl_);
  check_device(*impl_);
  return impl_->simulation->hash();
}

GrabId World::grab(std::int32_t vertex, const GrabOptions& options) {
  const Call call(impl_, false);
  check_interactive(*impl_);
  return impl_->handles->grab(impl_->vertex_of(vertex), options);
}

void World::move_grab(GrabId grab, const Vec3d& target) {
  const Call call(impl_, false);
  check_interactive(*impl_);
  impl_->handles->move(grab, target);
}

GrabState World::grab_state(GrabId grab) const {
  const Call call(impl_, false);
  check_interactive(*impl_);
  return impl_->handles->state(grab);
}

void World::release(GrabId grab) {
  const Call call(impl_, false);
  check_interactive(*impl_);
  impl_->handles->release(grab);
}

void World::push(std::int32_t vertex, const Vec3d& force) {
  const Call call(impl_, false);
  check_interactive(*impl_);
  impl_->handles->push(impl_->vertex_of(vertex), force);
}

void World::push_node(std::size_t body, std::int64_t node, const Vec3d& force) {
  const Call call(impl_, false);
  check_interactive(*impl_);
  impl_->handles->push_node(body, node, force);
}

void World::clear_handles() {
  const Call call(impl_, false);
  check_interactive(*impl_);
  impl_->handles->clear();
  impl_->rigid_tools.drop_drives();
}

void World::move_focus(const Vec3d& position) {
  const Call call(impl_, false);
  impl_->handles->move_focus(position);
}

const char* version() {
  return PLIANT_TEXT(PLIANT_VERSION_MAJOR) "." PLIANT_TEXT(PLIANT_VERSION_MINOR) "." PLIANT_TEXT(PLIANT_VERSION_PATCH);
}

std::vector<std::string> backend_names() {
  std::vector<std::string> names;
  for (const BackendInfo& b : list_backends()) names.push_back(b.name);
  return names;
}

}  // namespace pliant
