#include "simulation/tool_contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "geometry/vec.h"
#include "pliant/error.h"
#include "schedule/contact_data.h"
#include "simulation/body_overlap.h"

namespace pliant {
namespace {

/// A point is looked after when it is nearer than this share of a cell, beside what it moves until the next look.
constexpr double kMargin = 0.25;
/// Depth inside a tool at the start that is pushed out, as a share of a cell; more is refused.
constexpr double kStartDepth = 0.25;
/// Quanta of force are this share of what moves the heaviest node one cell in a step.
constexpr int kForceBits = 26;
constexpr int kAreaBits = 26;

double power_of_two(double x) { return std::ldexp(1.0, static_cast<int>(std::ceil(std::log2(x)))); }

/// Of a step and a tool: force, torque and area in quanta, largest depth [m].
struct StepSum {
  std::array<double, 7> quanta{};
  double depth = 0;
  std::int64_t points = 0;
};

StepSum sum_of_parts(const std::int32_t* part) {
  StepSum sum;
  for (std::size_t p = 0; p < contact_sum_parts; ++p, part += contact_sum_numbers) {
    for (std::size_t c = 0; c < 7; ++c) sum.quanta[c] += 32768.0 * part[2 * c] + part[2 * c + 1];  // exact below 2^53
    sum.depth = std::max(sum.depth, static_cast<double>(std::bit_cast<float>(part[14])));
    sum.points += part[15];
  }
  return sum;
}

}  // namespace

std::size_t check_drive(const Scene& scene, const std::string& name, const Pose& to, double seconds) {
  std::size_t tool = 0;
  while (tool < scene.tools.size() && scene.tools[tool].name != name) ++tool;
  if (tool == scene.tools.size()) throw Error(ErrorCode::usage, fmt::format("the scene has no tool \"{}\"", name));
  if (!good_pose(to)) {
    throw Error(ErrorCode::usage,
                fmt::format("tool \"{}\": the pose needs finite numbers and a unit quaternion x, y, z, w", name));
  }
  if (!(seconds > 0 && seconds < 1e30)) {
    throw Error(ErrorCode::usage, fmt::format("tool \"{}\": {} seconds on the way, expected a number > 0", name, seconds));
  }
  return tool;
}

bool ToolContact::active() const { return run_.model().contact != nullptr && run_.model().contact->size() > 0; }

Pose ToolContact::pose(std::size_t tool, double time) const {
  const ContactTool& own = run_.scene.tools[tool];
  const auto driven = run_.state.driven.find(own.name);
  if (driven == run_.state.driven.end()) return own.at(time);
  const ToolDrive& d = driven->second;
  if (time >= d.end) return d.to;
  return between(d.from, d.to, std::clamp((time - d.start) / (d.end - d.start), 0.0, 1.0));
}

void ToolContact::drive(const std::string& name, const Pose& to, double seconds) {
  const std::size_t tool = check_drive(run_.scene, name, to, seconds);
  const double now = run_.state.clock.time();
  const ToolDrive drive{pose(tool, now), to, now, now + seconds};
  run_.state.driven[name] = drive;
  if (!active()) return;
  // It may meet anything before the next look for what is near.
  const BufferId near = run_.loaded.program().find("contact_near");
  std::vector<std::int32_t> bits = run_.backend().read_ints(near);
  for (std::int32_t& b : bits) b |= std::int32_t{1} << tool;
  run_.backend().write_ints(near, bits);
}

void ToolContact::start() {
  history_.assign(run_.scene.tools.size(), {});
  keep();
  touch_ = {};
  if (!active()) return;
  const Model& model = run_.model();
  const ContactPoints& points = *model.contact;
  if (run_.scene.contact) refuse_overlap(model, kStartDepth * points.spacing);
  for (std::size_t t = 0; t < run_.scene.tools.size(); ++t) {
    const ContactTool& tool = run_.scene.tools[t];
    const ToolMoment moment = tool_moment((*model.tools)[t], run_.state.clock.time());
    const Pose at = compose(pose(t, run_.state.clock.time()), moment.pose);
    double deepest = 0;
    std::size_t where = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      Vec3d x = points.rest[i];
      for (std::size_t a = 0; a < 8 && !model.displacement.empty(); ++a)
        x = vec::add(x, vec::mul(model.displacement[points.nodes[i][a]], double(points.weights[i][a]) / contact_weight_unit));
      const double depth = -tool_distance((*model.tools)[t], place_back(at, x), moment);
      if (depth > deepest) {
        deepest = depth;
        where = i;
      }
    }
    if (deepest <= kStartDepth * points.spacing) continue;
    throw Error(
        ErrorCode::bad_input,
        fmt::format("{}: tool '{}' begins inside body '{}', {:.3g} m deep at [{:.4g}, {:.4g}, {:.4g}]; expected at most "
                    "{:.3g} m (a quarter of a cell), which contact pushes out",
                    tool.pointer, tool.name, model.bodies[points.body[where]].name, deepest, points.rest[where][0],
                    points.rest[where][1], points.rest[where][2], kStartDepth * points.spacing));
  }
}

/// Powers of two, so that nothing is rounded but the quanta.
ToolContact::Units ToolContact::units() const {
  const Model& model = run_.model();
  const double h = run_.state.clock.dt;
  double heaviest = 0, area = 0, longest = 0;
  for (const auto& nodes : model.contact->nodes) {
    for (const std::int32_t n : nodes) heaviest = std::max(heaviest, model.mass[n]);
  }
  for (const double a : model.contact->area) area += a;
  vec::Box box;
  for (const Vec3d& x : model.contact->rest) box.extend(x);
  longest = vec::norm(vec::sub(box.upper, box.lower));
  for (const ToolForm& form : *model.tools) longest = std::max(longest, form.reach);
  Units u;
  u.force = power_of_two(heaviest * model.contact->spacing / (h * h)) * std::ldexp(1.0, -kForceBits);
  u.torque = u.force * power_of_two(longest);
  u.area = power_of_two(area) * std::ldexp(1.0, -kAreaBits);
  return u;
}

void ToolContact::begin_batch(std::int32_t steps) {
  if (!active()) return;
  const std::size_t tools = run_.scene.tools.size(), rows = static_cast<std::size_t>(run_.settings.batch_steps) + 1;
  std::vector<double> poses;
  poses.reserve(rows * tools * contact_pose_numbers);
  arms_.assign(rows * tools, {});
  poses_.clear();
  if (last_step_ == run_.state.clock.step) poses_ = last_;
  for (std::size_t tool = poses_.size(); tool < tools; ++tool) {
    const double before = run_.state.clock.time() - run_.state.clock.dt;
    poses_.push_back(compose(pose(tool, before), tool_moment((*run_.model().tools)[tool], before).pose));
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const double t =
        run_.state.clock.time_at(run_.state.clock.step + std::min<std::int64_t>(static_cast<std::int64_t>(row), steps));
    for (std::size_t tool = 0; tool < tools; ++tool) {
      const ToolMoment moment = tool_moment((*run_.model().tools)[tool], t);
      const Pose whole = pose(tool, t), at = compose(whole, moment.pose);
      for (const Vec3d& r : rotation_matrix(at.turn)) poses.insert(poses.end(), r.begin(), r.end());
      poses.insert(poses.end(), at.position.begin(), at.position.end());
      poses.insert(poses.end(), {double(moment.frame), moment.share});
      arms_[row * tools + tool] = vec::sub(at.position, whole.position);
      poses_.push_back(at);
    }
  }
  const Program& program = run_.loaded.program();
  Backend& backend = run_.backend();
  if (tools > 0) backend.write_reals(program.find("tool_pose"), poses);
  units_ = units();
  const Units& u = units_;
  backend.write_reals(
      program.find("contact_params"),
      {u.force, 1 / u.force, u.force / contact_weight_unit, 1 / u.torque, 1 / u.area, kMargin * run_.model().contact->spacing,
       double(contact_look_every), run_.scene.contact ? run_.scene.contact->friction : 0});
  if (run_.loaded.take_updated() && run_.state.clock.step % contact_look_every != 0) look();
}

/// What a cut or a tear has sampled anew has no partners yet.
void ToolContact::look() {
  for (const Pass& pass : run_.loaded.program().step) {
    if (pass.kernel.starts_with("touch_") && pass.every == contact_look_every) run_.backend().run(pass, 0);
  }
}

/// touch_depth has gathered the depths of a batch; the next one begins with none.
void ToolContact::read_touch() {
  const BufferId id = run_.loaded.program().find("touch_depth");
  const std::vector<double> depth = run_.backend().read_reals(id);
  touch_.points = 0;
  for (const double d : depth) {
    if (!(d > 0)) continue;
    ++touch_.points;
    touch_.max_depth = std::max(touch_.max_depth, d);
  }
  if (touch_.points > 0) run_.backend().write_reals(id, std::vector<double>(depth.size(), 0.0));
}

/// A force acts from the middle of the step before to that of the next one (central differences).
double ToolContact::work(std::size_t tool, std::int32_t step, const Vec3d& force, const Vec3d& torque) const {
  const std::size_t before = static_cast<std::size_t>(step) * history_.size() + tool;
  const Pose &from = poses_[before], &to = poses_[before + 2 * history_.size()];
  return -0.5 * (vec::dot(force, vec::sub(to.position, from.position)) + vec::dot(torque, turn_between(from, to)));
}

void ToolContact::end_batch(std::int32_t steps) {
  if (!active() || steps <= 0) return;
  if (run_.scene.contact) read_touch();
  if (history_.empty()) return;
  const std::vector<std::int32_t> sums = run_.backend().read_ints(run_.loaded.program().find("tool_sum"));
  const std::size_t tools = history_.size();
  last_.assign(poses_.begin() + steps * static_cast<std::ptrdiff_t>(tools),
               poses_.begin() + (steps + 1) * static_cast<std::ptrdiff_t>(tools));
  last_step_ = run_.state.clock.step;
  for (std::size_t t = 0; t < tools; ++t) {
    ToolHistory& h = history_[t];
    h.now = {};
    for (std::int32_t step = 0; step < steps; ++step) {
      const StepSum sum =
          sum_of_parts(&sums[(static_cast<std::size_t>(step) * tools + t) * contact_sum_parts * contact_sum_numbers]);
      if (sum.points == 0) continue;
      ++h.touched;
      Vec3d force{}, torque{};
      for (std::size_t c = 0; c < 3; ++c) {
        force[c] = sum.quanta[c] * units_.force;
        torque[c] = sum.quanta[3 + c] * units_.torque;
      }
      h.work += work(t, step, force, torque);
      torque = vec::add(torque, vec::cross(arms_[(static_cast<std::size_t>(step) + 1) * tools + t], force));
      for (std::size_t c = 0; c < 3; ++c) {
        h.now.force[c] += force[c] / steps;
        h.now.torque[c] += torque[c] / steps;
      }
      h.now.area = sum.quanta[6] * units_.area;
      h.now.points = sum.points;
      h.now.depth = sum.depth;
      h.max_depth = std::max(h.max_depth, h.now.depth);
    }
    h.max_force = std::max(h.max_force, vec::norm(h.now.force));
  }
}

}  // namespace pliant
