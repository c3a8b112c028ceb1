#include "simulation/contact/tool_contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/vec.h"
#include "pliant/error.h"
#include "scene/blade_face.h"
#include "schedule/contact/contact_data.h"
#include "schedule/program_layout.h"
#include "simulation/contact/body_overlap.h"
#include "simulation/contact/present_tissue.h"
#include "simulation/contact/sunken_tool.h"
#include "simulation/contact/tool_changes.h"

namespace pliant {

void check_pose(const std::string& name, const Pose& pose) {
  if (good_pose(pose)) return;
  throw Error(ErrorCode::usage,
              fmt::format("tool \"{}\": the pose needs finite numbers and a unit quaternion x, y, z, w", name));
}

void check_drive(const std::string& name, const Pose& to, double seconds) {
  check_pose(name, to);
  if (seconds > 0 && seconds < 1e30) return;
  throw Error(ErrorCode::usage, fmt::format("tool \"{}\": {} seconds on the way, expected a number > 0", name, seconds));
}

bool ToolContact::active() const { return run_.model().contact != nullptr && run_.model().contact->size() > 0; }

Pose ToolContact::pose(std::size_t tool, double time) const { return tool_pose(tools_[tool], run_.state, time); }

std::optional<std::size_t> ToolContact::find(const std::string& name) const {
  const auto own = std::find_if(tools_.begin(), tools_.end(), [&](const ContactTool& t) { return t.name == name; });
  if (own == tools_.end()) return {};
  return static_cast<std::size_t>(own - tools_.begin());
}

std::optional<Wrench> ToolContact::last_force(std::size_t tool) const {
  if (felt_.batch_end != run_.state.clock.step || felt_.step_forces.size() < tools_.size()) return {};
  return felt_.step_forces[felt_.step_forces.size() - tools_.size() + tool];
}

void ToolContact::drive(std::size_t tool, const Pose& to, double seconds) {
  const double now = run_.state.clock.time();
  const ToolDrive drive{seconds > 0 ? pose(tool, now) : to, to, now, now + seconds};
  add_drive(run_.state.driven, tools_[tool].name, drive);
  run_.state.relaxation.equilibrium = false;  // relaxation restarts
  if (!active()) return;
  run_.state.look.tools = -1;  // force a new search
}

void ToolContact::follow() {
  felt_.step_forces.clear();  // of the tools before
  felt_.batch_end = -1;
  const std::vector<ContactTool> before = std::exchange(tools_, present_tools(run_.scene, run_.state.tools));
  const std::vector<ToolHistory> felt = std::exchange(report_.tools, std::vector<ToolHistory>(tools_.size()));
  for (std::size_t t = 0; t < tools_.size(); ++t) {
    const auto same = std::find(before.begin(), before.end(), tools_[t]);
    if (same != before.end()) report_.tools[t] = felt[static_cast<std::size_t>(same - before.begin())];
  }
}

void ToolContact::start() {
  tools_ = run_.scene.tools;
  report_.tools.resize(tools_.size());
  if (!active()) return;
  const Model& model = run_.model();
  if (run_.scene.contact) refuse_overlap(model, tool_start_depth * model.contact->spacing);
  if (tools_.empty()) return;
  const PresentTissue tissue(model, run_.u());
  for (std::size_t t = 0; t < tools_.size(); ++t) {
    if (is_face(tools_[t])) continue;  // tissue around a blade is spread
    const double now = run_.state.clock.time();
    try {
      tissue.refuse_inside(tools_[t].name, (*model.tools)[t], pose(t, now), now);
    } catch (const Error& error) {
      throw Error(error.code(), fmt::format("{}: {}", tools_[t].pointer, error.what()));
    }
  }
}

/// Least modulus of a material [Pa]; of a field, that of its softest element.
static double least_young(const Material& material) {
  double least = material.moduli.young();
  if (material.young_field == nullptr) return least;
  for (const double young : material.young_field->values) least = young > 0 ? std::min(least, young) : least;
  return least;
}

/// Longest time in which a wave along a bar, of speed sqrt(E / density), crosses a cell of the coarsest body [s]; 0 without
/// elements.
static double slowest_crossing(const Model& model) {
  double slowest = 0;
  const auto look_at = [&](const Material& material) {
    const double young = least_young(material);
    if (young > 0) slowest = std::max(slowest, model.contact->spacing * std::sqrt(material.density / young));
  };
  for (const ElementBatch& batch : model.batches) look_at(batch.material);
  for (const BrickBatch& batch : model.brick_batches) look_at(batch.material);
  return slowest;
}

/// Each search reduces the initial depth of a pair by kEase; searches come after a number of steps. At steps far below the
/// stable one, this would be an unlimited speed in m/s, which threw the faces of a cut apart (touch_test.cpp,
/// SmallStepsPartBodiesNoFaster). There the rate is limited to that at half the stable step. Viscosity, or one stiff part,
/// makes the stable step itself short: then the rate is limited to that at kCrossing of the time in which a wave crosses a
/// cell.
double ToolContact::touch_ease() const {
  constexpr double kEase = 0.04, kCrossing = 0.25;
  const double stable = run_.state.limit.stable_dt, dt = run_.state.clock.dt, crossing = slowest_crossing(run_.model());
  double share = 1;
  if (stable > 0) share = std::min(share, 2 * dt / stable);
  if (crossing > 0) share = std::min(share, dt / (kCrossing * crossing));
  return kEase * share;
}

double ToolContact::went_from(std::size_t tool, double step_ago) const {
  const ContactTool& own = tools_[tool];
  const double now = run_.state.clock.time();
  if (is_face(own)) {
    const Blade& blade = *own.blade;
    return since_jump(run_.state.driven_blades, blade.name, step_ago, now, [&](double t) { return blade.at(t); });
  }
  return since_jump(run_.state.driven, own.name, step_ago, now, [&](double t) { return own.at(t); });
}

void ToolContact::begin_batch(std::int32_t steps) {
  if (!active()) return;
  const std::size_t tools = tools_.size(), rows = static_cast<std::size_t>(run_.settings.batch_steps) + 1;
  std::vector<double> poses;
  poses.reserve(rows * tools * contact_pose_numbers);
  arms_.assign(rows * tools, {});
  poses_.clear();
  for (std::size_t tool = 0; tool < tools; ++tool) {
    const double step_ago = run_.state.clock.time() - run_.state.clock.dt, before = went_from(tool, step_ago);
    const ToolHistory& h = report_.tools[tool];
    poses_.push_back(h.step == run_.state.clock.step && before == step_ago
                         ? h.before
                         : compose(pose(tool, before), tool_moment((*run_.model().tools)[tool], before).pose));
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const double t =
        run_.state.clock.time_at(run_.state.clock.step + std::min<std::int64_t>(static_cast<std::int64_t>(row), steps));
    for (std::size_t tool = 0; tool < tools; ++tool) {
      const ToolMoment moment = tool_moment((*run_.model().tools)[tool], t);
      const Pose whole = pose(tool, t), at = compose(whole, moment.pose);
      for (const Vec3d& r : rotation_matrix(at.turn)) poses.insert(poses.end(), r.begin(), r.end());
      poses.insert(poses.end(), at.position.begin(), at.position.end());
      const double frame = is_face(tools_[tool]) ? (is_away(tools_[tool], run_.state, t) ? 0 : 1) : moment.frame;
      poses.insert(poses.end(), {frame, moment.share, tool_grip(tools_[tool], run_.state, t)});
      arms_[row * tools + tool] = vec::sub(at.position, whole.position);
      poses_.push_back(at);
    }
  }
  begin_faces();
  const Program& program = run_.loaded.program();
  Backend& backend = run_.backend();
  if (tools > 0) backend.write_reals(program.find("tool_pose"), poses);
  if (extent_of_ != run_.loaded.shared_model()) {
    extent_of_ = run_.loaded.shared_model();
    extent_ = contact_extent(*extent_of_);
  }
  last_units_ = std::exchange(units_, contact_units(extent_, run_.state.clock.dt));
  parting_.drop();
  const std::array<double, 9> numbers =
      contact_numbers(run_.model(), units_, run_.scene.contact ? run_.scene.contact->friction : 0, touch_ease());
  backend.write_reals(program.find("contact_params"), {numbers.begin(), numbers.end()});
  summed_.assign(static_cast<std::size_t>(steps), 0);
}

/// What runs without a check of its energy pays nothing.
void ToolContact::count_parting(std::int32_t step_in_batch, bool before) {
  if (!report_.energy.least) return;
  if (!before) {
    parting_.after_search(units_.force);
    return;
  }
  double quantum = 0;
  if (step_in_batch > 0) {
    if (summed_.at(static_cast<std::size_t>(step_in_batch) - 1) != 0) quantum = units_.force;
  } else if (known_at_ == run_.state.clock.step && known_changes_ == run_.loaded.changes()) {
    quantum = last_units_.force;
  }
  report_.tissue.work += parting_.before_search(quantum);
}

/// Tissue that stands where a blade appears is spread as what its edge opens, not in one step.
void ToolContact::begin_faces() {
  bool appears = false;
  for (const ContactTool& tool : tools_) {
    if (!is_face(tool)) continue;
    const auto own = run_.state.pressed.find(tool.blade->name);
    if (own == run_.state.pressed.end()) continue;
    const bool here = !is_away(tool, run_.state, run_.state.clock.time());
    appears = appears || (here && !own->second.here);
    if (tool.side < 0) own->second.here = here;  // the second one
  }
  if (!appears) return;
  const BufferId id = run_.loaded.program().find("contact_start");
  std::vector<double> start = run_.backend().read_reals(id);
  for (std::size_t i = 0; i < run_.model().contact->size(); ++i) {
    const std::size_t base = tile_base(i, 2);
    if (start[base + PLIANT_TILE] == 0) start[base] = -1;
  }
  run_.backend().write_reals(id, start);
}

std::int32_t ToolContact::before_step(std::int32_t step_in_batch, std::int32_t steps) {
  if (!active()) return steps;
  report_.tissue.work += parting_.after_step();
  if (run_.scene.contact) lists_.follow_searches([=, this](bool before) { count_parting(step_in_batch, before); });
  lists_.update(step_in_batch, [this](std::size_t tool, double from, double to) { return motion(tool, from, to); });
  known_at_ = -1;  // also where the batch is taken back
  const std::int64_t step = run_.state.clock.step + step_in_batch;
  auto n = static_cast<std::int32_t>(std::min(std::int64_t{steps}, contact_look_every - step % contact_look_every));
  if (parting_.pending()) n = 1;
  if (*run_.loaded.program().near_points > 0) {
    for (std::int32_t k = 0; k < n; ++k) summed_.at(static_cast<std::size_t>(step_in_batch + k)) = 1;
  }
  return n;
}

double ToolContact::motion(std::size_t tool, double from, double to) const {
  const ToolForm& form = (*run_.model().tools)[tool];
  if (form.frames.size() > 1) {  // the surface deforms within its frame
    const ToolMoment a = tool_moment(form, from), b = tool_moment(form, to);
    if (form.times.empty() || a.frame != b.frame || a.share != b.share) return 1e30;
  }
  if (is_away(tools_[tool], run_.state, from) != is_away(tools_[tool], run_.state, to)) return 1e30;
  const Pose a = pose(tool, from), b = pose(tool, to);
  const std::array<Vec3d, 3> ra = rotation_matrix(a.turn), rb = rotation_matrix(b.turn);
  double turn = 0;  // upper bound of |R_b - R_a|, the largest change of a unit vector
  for (std::size_t r = 0; r < 3; ++r) turn += vec::dot(vec::sub(rb[r], ra[r]), vec::sub(rb[r], ra[r]));
  const double reach = form.shape == ToolShape::half_space ? 1e3 * contact_margin(run_.model()) : form.reach;
  return vec::norm(vec::sub(b.position, a.position)) + std::sqrt(turn) * reach;
}

/// Reads and resets touch_depth, which accumulates the depths of a batch.
void ToolContact::read_touch() {
  const BufferId id = run_.loaded.program().find("touch_depth");
  const std::vector<double> depth = run_.backend().read_reals(id);
  for (const double d : depth) {
    if (!(d > 0)) continue;
    ++report_.tissue.points;
    report_.tissue.max_depth = std::max(report_.tissue.max_depth, d);
  }
  if (report_.tissue.points > 0) run_.backend().write_reals(id, std::vector<double>(depth.size(), 0.0));
}

/// A force acts from the middle of the previous step to that of the next one (central differences).
double ToolContact::work(std::size_t tool, std::int32_t step, const Wrench& on_tool) const {
  const std::size_t before = static_cast<std::size_t>(step) * tools_.size() + tool;
  const Pose &from = poses_[before], &to = poses_[before + 2 * tools_.size()];
  return -0.5 *
         (vec::dot(on_tool.force, vec::sub(to.position, from.position)) + vec::dot(on_tool.torque, turn_between(from, to)));
}

void ToolContact::end_batch(std::int32_t steps) {
  if (!active() || steps <= 0) return;
  report_.tissue.work += parting_.after_step();
  const bool ran_last = summed_[static_cast<std::size_t>(steps) - 1] != 0;
  known_at_ = ran_last ? run_.state.clock.step : -1;
  known_changes_ = run_.loaded.changes();
  const bool ran = std::count(summed_.begin(), summed_.end(), 1) > 0;
  report_.tissue.points = 0;
  if (run_.scene.contact && ran) read_touch();
  if (report_.tools.empty()) return;
  felt_.step_forces.assign(static_cast<std::size_t>(steps) * tools_.size(), {});
  felt_.batch_end = run_.state.clock.step;
  felt_.batch_clock = run_.state.clock;
  for (ToolHistory& h : report_.tools) h.now = {};
  look_for_sunken(steps);  // also where nothing is near: a tool may be in the middle of tissue
  if (!ran) return;
  const std::vector<std::int32_t> sums = run_.backend().read_ints(run_.loaded.program().find("tool_sum"));
  const std::size_t tools = tools_.size();
  for (std::size_t t = 0; t < tools; ++t) {
    ToolHistory& h = report_.tools[t];
    h.now = {};
    h.before = poses_[static_cast<std::size_t>(steps) * tools + t];
    h.step = run_.state.clock.step;
    for (std::int32_t step = 0; step < steps; ++step) {
      if (summed_[static_cast<std::size_t>(step)] == 0) continue;  // nothing was near
      const ContactSum sum =
          contact_sum(&sums[(static_cast<std::size_t>(step) * tools + t) * contact_sum_parts * contact_sum_numbers]);
      if (sum.points == 0) continue;
      ++h.touched;
      Wrench& on_tool = felt_.step_forces[static_cast<std::size_t>(step) * tools + t];
      for (std::size_t c = 0; c < 3; ++c) {
        on_tool.force[c] = sum.quanta[c] * units_.force;
        on_tool.torque[c] = sum.quanta[3 + c] * units_.torque;
      }
      h.work += work(t, step, on_tool) + sum.spread * units_.force * contact_margin(run_.model()) / contact_spread_parts;
      on_tool.torque =
          vec::add(on_tool.torque, vec::cross(arms_[(static_cast<std::size_t>(step) + 1) * tools + t], on_tool.force));
      for (std::size_t c = 0; c < 3; ++c) {
        h.now.force[c] += on_tool.force[c] / steps;
        h.now.torque[c] += on_tool.torque[c] / steps;
      }
      h.now.area = sum.quanta[6] * units_.area;
      h.now.points = sum.points;
      h.now.depth = sum.depth;
      h.max_depth = std::max(h.max_depth, h.now.depth);
    }
    h.max_force = std::max(h.max_force, vec::norm(h.now.force));
  }
}

std::vector<SunkenTool> ToolContact::sunken_now() const {
  std::vector<SunkenTool> out(tools_.size());
  const double now = run_.state.clock.time();
  const BodySurfaces surfaces(run_.model(), run_.u());
  for (std::size_t t = 0; t < tools_.size(); ++t) {
    if (!is_face(tools_[t])) out[t] = surfaces.deepest((*run_.model().tools)[t], pose(t, now), now);
  }
  return out;
}

void ToolContact::look_for_sunken(std::int32_t steps) {
  const double now = run_.state.clock.time(), before = now - steps * run_.state.clock.dt;
  if (std::floor(now / sunken_look_every) == std::floor(before / sunken_look_every)) return;
  const std::vector<SunkenTool> sunken = sunken_now();
  for (std::size_t t = 0; t < tools_.size(); ++t) {
    ToolHistory& h = report_.tools[t];
    h.sunk = sunken[t];
    if (h.sunk.cells() > h.deepest.cells()) h.deepest = h.sunk;
  }
}

}  // namespace pliant
