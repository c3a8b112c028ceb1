#include "haptics/buffer_model.h"

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"
#include "integrators/integrator.h"
#include "schedule/build_program.h"
#include "schedule/contact/contact_data.h"
#include "schedule/program_layout.h"
#include "simulation/contact/contact_lists.h"

namespace pliant::haptics {
namespace {

constexpr std::int32_t kBatch = 1;

/// Of the size of an element, as in a simulation: below, numbers fade into denormals.
constexpr double kIncrementFloor = 1e-12;

/// The default integrator keeps increments, which this file writes; trajectories are those of any.
Program program_of(const Submodel& part, const TissueState& state) {
  ProgramOptions options;
  options.batch_steps = kBatch;
  options.blade_samples = static_cast<std::int32_t>(state.blade.front.size() / 2);
  options.blades = options.blade_samples > 0 ? 1 : 0;
  return build_program(*part.model, options);
}

}  // namespace

BufferModel::BufferModel(Submodel part, const BufferInstrument& instrument, const TissueState& state)
    : part_(std::move(part)),
      instrument_(instrument),
      program_(program_of(part_, state)),
      runner_(program_),
      blade_(runner_, instrument.length) {
  u_ = runner_.reals("node_u");
  w_ = runner_.reals("node_w");
  params_ = runner_.reals("step_params");
  contact_step_ = runner_.contact_step();
  has_law_ = std::ranges::any_of(part_.model->contact_laws, [](const ContactLaw& law) { return law.stiffness > 0; });
  poses_ = runner_.reals("tool_pose");
  contact_params_ = runner_.reals("contact_params");
  anchor_ = runner_.reals("contact_anchor");
  yield_ = runner_.reals("contact_yield");
  near_ = runner_.ints("contact_near");
  list_ = runner_.ints("contact_list");
  node_list_ = runner_.ints("contact_node_list");
  tool_sum_ = runner_.ints("tool_sum");
  curves_ = runner_.reals("curve_value");
  if (part_.model->contact != nullptr && part_.model->contact->size() > 0) margin_ = contact_margin(*part_.model);
  if (const BufferId tiles = program_.find("contact_tiles"); tiles >= 0) {
    tiles_offset_ = program_.at(program_.find("contact_tiles_offset")).ints;
    tiles_ = program_.at(tiles).ints;
  }
  for (std::size_t n = 0; n < part_.rim.size(); ++n) {
    if (part_.rim[n] != 0) rim_.push_back(static_cast<std::int32_t>(n));
  }
  way_.resize(3 * rim_.size());
  if (program_.near_samples != nullptr) *program_.near_samples = 1;
  start(state);
  from_ = to_ = instrument_.start;
}

/// At both ends of the step.
void BufferModel::set_curves(const TissueState& state) noexcept {
  const std::size_t count = std::min(state.curves.size(), curves_.size() / 2);
  for (std::size_t row = 0; row < 2; ++row)
    std::copy_n(state.curves.begin(), count, curves_.begin() + static_cast<std::ptrdiff_t>(row * count));
}

/// Points that tools hold stay held; friction begins anew.
void BufferModel::set_anchors(const TissueState& state) noexcept {
  std::ranges::fill(anchor_, 0.0F);
  for (std::size_t i = 0; 4 * i < state.anchors.size() && !anchor_.empty(); ++i) {
    if (!(state.anchors[4 * i + 3] < 0)) continue;
    for (std::size_t c = 0; c < 4; ++c) anchor_[tile_base(i, 4) + c * PLIANT_TILE] = state.anchors[4 * i + c];
  }
}

void BufferModel::start(const TissueState& state) noexcept {
  set_curves(state);
  set_anchors(state);
  std::ranges::fill(yield_, 0.0F);
  blade_.start(state.blade);
  grips_ = state.grips;
  stable_ = state.step;
  gravity_ = state.gravity;
  const double h = step_ > 0 ? step_ : stable_;
  for (std::size_t n = 0; n < part_.slot.size(); ++n) {
    for (std::size_t c = 0; c < 3; ++c) {
      u_[4 * n + c] = state.displacement[3 * n + c];
      w_[4 * n + c] = static_cast<float>(state.velocity[3 * n + c] * h);
    }
  }
  for (std::size_t r = 0; r < rim_.size(); ++r) {
    for (std::size_t c = 0; c < 3; ++c)
      way_[3 * r + c] = {state.displacement[3 * static_cast<std::size_t>(rim_[r]) + c], 0, 0, 0};
  }
  other_from_ = other_to_ = state.tools;
  moments_ = state.moments;
  step_ = 0;
  set_step(h);
  passed_ = period_ = 0;
  since_look_ = contact_look_every;
}

void BufferModel::carry(const BufferModel& before) noexcept {
  if (before.step_ > 0) set_step(before.step_);
  auto old = before.part_.names.begin();
  for (const auto& [name, n] : part_.names) {
    while (old != before.part_.names.end() && old->first < name) ++old;
    if (old == before.part_.names.end()) break;
    if (old->first != name) continue;
    const std::size_t to = 4 * static_cast<std::size_t>(n), from = 4 * static_cast<std::size_t>(old->second);
    for (std::size_t c = 0; c < 3; ++c) {
      u_[to + c] = before.u_[from + c];
      w_[to + c] = before.w_[from + c];
    }
  }
  blade_.carry(before.blade_);
  if (before.part_.topology != part_.topology || before.part_.tools != part_.tools || anchor_.empty()) return;
  std::size_t k = 0;
  for (std::size_t i = 0; i < part_.point.size(); ++i) {
    while (k < before.part_.point.size() && before.part_.point[k] < part_.point[i]) ++k;
    if (k == before.part_.point.size()) return;
    if (before.part_.point[k] != part_.point[i]) continue;
    for (std::size_t c = 0; c < 4; ++c)
      anchor_[tile_base(i, 4) + c * PLIANT_TILE] = before.anchor_[tile_base(k, 4) + c * PLIANT_TILE];
    yield_[i] = before.yield_[k];
  }
}

void BufferModel::follow(const TissueState& state, double seconds, double lead) noexcept {
  set_curves(state);
  stable_ = state.step;
  gravity_ = state.gravity;
  const auto rate = static_cast<float>(step_ > 0 ? seconds / step_ : 0), time = static_cast<float>(seconds);
  for (std::size_t r = 0; r < rim_.size(); ++r) {
    const std::size_t n = static_cast<std::size_t>(rim_[r]);
    for (std::size_t c = 0; c < 3; ++c) {  // Hermite: from the present place and speed to the target and the state's speed
      const float from = u_[4 * n + c], leaves = rate * w_[4 * n + c], speed = time * state.drift[3 * n + c];
      const float ahead = static_cast<float>(lead) * speed, to = state.displacement[3 * n + c] + ahead,
                  arrives = lead > 0 ? speed : 0;
      const float way = to - from;
      way_[3 * r + c] = {from, leaves, 3 * way - 2 * leaves - arrives, leaves + arrives - 2 * way};
    }
  }
  for (std::size_t t = 0; t < other_to_.size() && t < state.tools.size(); ++t) {
    other_from_[t] = pose_of(t, 0, 0);
    other_to_[t] = state.tools[t];
    moments_[t] = state.moments[t];
    grips_[t] = state.grips[t];
  }
  blade_.follow(state.blade, seconds);
  period_ = seconds;
  passed_ = 0;
}

void BufferModel::draw(const TissueState& state, double share) noexcept {
  const auto by = static_cast<float>(share);
  for (std::size_t n = 0; n < part_.slot.size(); ++n) {
    if (u_[4 * n + 3] == 0) continue;  // held, or of the rim
    for (std::size_t c = 0; c < 3; ++c) u_[4 * n + c] += by * (state.displacement[3 * n + c] - u_[4 * n + c]);
  }
}

/// Damping, gravity and the units of contact depend on the step.
void BufferModel::set_step(double h) noexcept {
  if (step_ > 0 && h != step_) {
    const auto scale = static_cast<float>(h / step_);
    for (std::size_t n = 0; n < part_.slot.size(); ++n) {
      for (std::size_t c = 0; c < 3; ++c) w_[4 * n + c] *= scale;
    }
  }
  const Model& model = *part_.model;
  // A force that stops a point within one step grows with the square of the rate, and so does what a jump of the hand costs: it
  // is no stiffer than at 1000 ticks a second. Laws of contact need the step that is.
  constexpr double kStiffest = 1e-3;  // [s]
  const double least = has_law_ ? 0 : std::min(0.5 * stable_, kStiffest);
  if (!contact_step_.empty()) contact_step_[0] = static_cast<float>(std::max(h, least));
  const double floor = kIncrementFloor * model.shortest;
  params_[0] = static_cast<float>(h);
  for (std::size_t c = 0; c < 3; ++c) params_[1 + c] = static_cast<float>(gravity_[c]);
  params_[4] = static_cast<float>(floor);
  params_[5] = static_cast<float>(std::ldexp(1.0, 22 + std::ilogb(floor)));
  if (h == step_) return;
  step_ = h;
  const IntegratorInfo& integrator = integrator_info(ProgramOptions{}.integrator);
  for (std::size_t n = 0; n < part_.slot.size(); ++n)
    w_[4 * n + 3] = part_.rim[n] != 0 ? 1.0F : static_cast<float>(integrator.decay(0.5 * h * model.damping[n]));
  if (contact_params_.empty()) return;
  units_ = contact_units(contact_extent(model), h);
  const std::array<double, 9> numbers = contact_numbers(model, units_, 0, 0);
  for (std::size_t i = 0; i < numbers.size(); ++i) contact_params_[i] = static_cast<float>(numbers[i]);
}

Pose BufferModel::pose_of(std::size_t tool, double share, double dt) const noexcept {
  if (tool == instrument_.tool) return between(from_, to_, share);
  const double s = period_ > 0 ? std::min(1.0, (passed_ + share * dt) / period_) : 1.0;
  return between(other_from_[tool], other_to_[tool], s);
}

void BufferModel::write_poses(double from, double to, double dt) noexcept {
  if (poses_.empty()) return;
  const std::size_t tools = other_to_.size();
  for (std::size_t row = 0; row < 2; ++row) {
    for (std::size_t t = 0; t < tools; ++t) {
      const Pose at = compose(pose_of(t, row == 0 ? from : to, dt), moments_[t].pose);
      float* out = poses_.data() + (row * tools + t) * contact_pose_numbers;
      for (const Vec3d& r : rotation_matrix(at.turn)) {
        for (const double x : r) *out++ = static_cast<float>(x);
      }
      for (const double x : at.position) *out++ = static_cast<float>(x);
      *out++ = static_cast<float>(moments_[t].frame);
      *out++ = static_cast<float>(moments_[t].share);
      const bool by_hand = t == instrument_.tool && hand_grip_ != HandGrip::unsaid;
      *out = !by_hand ? grips_[t] : hand_grip_ == HandGrip::closed ? static_cast<float>(instrument_.grip) : 0.0F;
    }
  }
}

void BufferModel::move_rim(double passed, double h) noexcept {
  const auto s = static_cast<float>(period_ > 0 ? std::min(1.0, (passed + h) / period_) : 1.0);
  for (std::size_t r = 0; r < rim_.size(); ++r) {
    const std::size_t n = 4 * static_cast<std::size_t>(rim_[r]);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::array<float, 4>& p = way_[3 * r + c];
      w_[n + c] = p[0] + s * (p[1] + s * (p[2] + s * p[3])) - u_[n + c];
    }
  }
}

/// Lists the tiles near a tool, as the simulation does (simulation/contact/contact_lists.cpp).
void BufferModel::look_again() noexcept {
  since_look_ = 0;
  travel_ = 0;
  runner_.look();
  std::size_t points = 0, nodes = 0;
  for (std::size_t tile = 0; tile < near_.size(); ++tile) {
    if (near_[tile] != 0) list_[points++] = static_cast<std::int32_t>(tile);
  }
  std::fill(list_.begin() + static_cast<std::ptrdiff_t>(points), list_.end(), -1);
  for (std::size_t n = 0; n + 1 < tiles_offset_.size() && points > 0; ++n) {
    const auto near = [&](std::int32_t tile) { return near_[static_cast<std::size_t>(tile)] != 0; };
    if (std::any_of(tiles_.begin() + tiles_offset_[n], tiles_.begin() + tiles_offset_[n + 1], near))
      node_list_[nodes++] = static_cast<std::int32_t>(n);
  }
  std::fill(node_list_.begin() + static_cast<std::ptrdiff_t>(nodes), node_list_.end(), -1);
  *program_.near_points = static_cast<std::int64_t>(points) * PLIANT_TILE;
  *program_.near_nodes = static_cast<std::int64_t>(nodes) * PLIANT_TILE;
}

/// About the instrument's origin, which is at `whole`.
Wrench BufferModel::read_wrench(const Pose& whole) noexcept {
  touching_ = 0;
  if (!instrument_.tool) {
    const Wrench on_blade = blade_.read();
    touching_ = blade_.pressing();
    return on_blade;
  }
  const std::size_t tool = *instrument_.tool;
  if (tool_sum_.empty() || *program_.near_points == 0) return {};
  const ContactSum sum = contact_sum(tool_sum_.data() + tool * contact_sum_parts * contact_sum_numbers);
  touching_ = sum.points;
  if (sum.points == 0) return {};
  Wrench out;
  for (std::size_t c = 0; c < 3; ++c) {
    out.force[c] = sum.quanta[c] * units_.force;
    out.torque[c] = sum.quanta[3 + c] * units_.torque;
  }
  const Vec3d arm = vec::sub(compose(whole, moments_[tool].pose).position, whole.position);
  out.torque = vec::add(out.torque, vec::cross(arm, out.force));
  return out;
}

Wrench BufferModel::tick(const Pose& from, const Pose& to, double dt) noexcept {
  from_ = from;
  to_ = to;
  substeps_ = std::max(1, static_cast<int>(std::ceil(dt / stable_ * (1 - 1e-6))));
  const double h = dt / substeps_;
  set_step(h);
  constexpr double kTravel = 0.4;  // share of the margin of a search that the instrument may use up
  const double reach = instrument_.tool ? (*part_.model->tools)[*instrument_.tool].reach : instrument_.length;
  const double way = vec::norm(vec::sub(to.position, from.position)) + vec::norm(turn_between(from, to)) * reach;
  Wrench mean;
  for (int s = 0; s < substeps_; ++s) {
    const double begin = static_cast<double>(s) / substeps_, end = static_cast<double>(s + 1) / substeps_;
    const Pose whole = between(from_, to_, end);
    write_poses(begin, end, dt);
    blade_.move(between(from_, to_, begin), whole, h);
    move_rim(passed_ + begin * dt, h);
    travel_ += way / substeps_;
    if (!near_.empty() && (++since_look_ >= contact_look_every || travel_ > kTravel * margin_)) look_again();
    runner_.step();
    const Wrench now = read_wrench(whole);
    for (std::size_t c = 0; c < 3; ++c) {
      mean.force[c] += now.force[c] / substeps_;
      mean.torque[c] += now.torque[c] / substeps_;
    }
  }
  passed_ += dt;
  return mean;
}

Vec3d BufferModel::displacement(std::size_t node) const { return {u_[4 * node], u_[4 * node + 1], u_[4 * node + 2]}; }

bool BufferModel::finite() const noexcept {
  float sum = 0;
  for (const float x : u_.first(4 * part_.slot.size())) sum += std::fabs(x);
  return std::isfinite(sum);
}

}  // namespace pliant::haptics
