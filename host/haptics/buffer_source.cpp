#include "haptics/buffer_source.h"

#include <algorithm>
#include <limits>

#include "geometry/vec.h"
#include "scene/blade_face.h"
#include "schedule/program_layout.h"
#include "simulation/contact/tool_changes.h"
#include "simulation/edits/carried_grips.h"
#include "simulation/measure/energy.h"

namespace pliant::haptics {
namespace {

/// Distances from the instrument, in spacings of contact points: nearer points are in contact, or may be before the next
/// frame; beyond the second one there is no buffer at all.
constexpr double kNear = 0.4, kFar = 6;
constexpr std::int32_t kAll = std::numeric_limits<std::int32_t>::max();

/// Ring of elements that the contact may reach before the buffer is rebuilt; ring 0 is that of the contact when it was built.
std::int32_t inner_ring(std::int32_t rings) { return rings >= 3 ? 1 : 0; }

/// Whether a body can stand without the rest of the scene: what touches and presses it are tools, gravity and forces on nodes.
bool may_be_whole(const Model& model) {
  const bool held =
      std::any_of(model.constraints.begin(), model.constraints.end(), [](const Constraint& c) { return c.axes != 0; });
  const bool grabbed = std::any_of(model.forces.begin(), model.forces.end(), [](const NodeForce& f) { return f.reserved; });
  return !model.tissue_contact && model.pressures.empty() && model.links.empty() && held && !grabbed;
}

/// [points][4] of the buffer (contact_grip.cl); empty: no tool can grip.
std::vector<float> anchors_of(const Simulation& simulation, const Submodel& part) {
  if (!has_grips(simulation.model())) return {};
  const std::vector<double> anchor = simulation.backend().read_reals(simulation.program().find("contact_anchor"));
  std::vector<float> out;
  for (const std::int32_t i : part.point) {
    for (std::size_t c = 0; c < 4; ++c)
      out.push_back(static_cast<float>(anchor[tile_base(static_cast<std::size_t>(i), 4) + c * PLIANT_TILE]));
  }
  return out;
}

/// Bits of the components in which a node of the buffer can move.
std::vector<std::int32_t> free_axes(const Submodel& part) {
  std::vector<std::int32_t> free(part.slot.size(), 7);
  for (const Constraint& c : part.model->constraints) free[static_cast<std::size_t>(c.slot)] &= ~c.axes;
  return free;
}

}  // namespace

/// Displacements [m] and velocities [m/s] by slot.
struct BufferSource::Tissue {
  std::vector<Vec3d> u, v;

  explicit Tissue(const Simulation& simulation) {
    std::vector<std::vector<Vec3d>> us, vs;
    for (std::size_t b = 0; b < simulation.model().bodies.size(); ++b) {
      us.push_back(simulation.displacements(b));
      vs.push_back(simulation.velocities(b));
    }
    u = by_slot(simulation.model(), us);
    v = by_slot(simulation.model(), vs);
  }
};

/// What the instrument touches, or will.
struct BufferSource::Seeds {
  std::vector<std::int32_t> slots;   ///< nodes of the points, or of the edge's samples, ascending
  std::vector<std::int32_t> points;  ///< that are near

  void sort() {
    std::sort(slots.begin(), slots.end());
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
  }
};

TissueState BufferSource::state_of(const Simulation& simulation, const Tissue& tissue, const Submodel& part,
                                   const DrivenPart& tool, double period, bool& covered) const {
  TissueState state;
  const std::vector<std::int32_t>& slots = part.slot;
  const bool moved = period > 0 && last_u_.size() == tissue.u.size();
  for (const std::int32_t slot : slots) {
    const auto s = static_cast<std::size_t>(slot);
    for (std::size_t c = 0; c < 3; ++c) {
      state.displacement.push_back(static_cast<float>(tissue.u[s][c]));
      state.velocity.push_back(static_cast<float>(tissue.v[s][c]));
      state.drift.push_back(static_cast<float>(moved ? (tissue.u[s][c] - last_u_[s][c]) / period : tissue.v[s][c]));
    }
  }
  const ToolContact& contact = simulation.contact();
  const Model& model = simulation.model();
  for (std::size_t t = 0; t < contact.tools().size(); ++t) {
    state.tools.push_back(contact.pose(t, simulation.time()));
    state.moments.push_back(tool_moment((*model.tools)[t], simulation.time()));
    const ContactTool& known = contact.tools()[t];
    if (is_face(known)) state.moments.back().frame = is_away(known, simulation.state(), simulation.time()) ? 0 : 1;
    state.grips.push_back(static_cast<float>(tool_grip(contact.tools()[t], simulation.state(), simulation.time())));
  }
  state.anchors = anchors_of(simulation, part);
  if (tool.is_blade()) {
    state.blade = blade_state(simulation.press().samples(tool.index()), slots, free_axes(part), covered);
    state.blade.pose = tool.pose(simulation, simulation.time());
  }
  state.step = simulation.dt();
  for (const Curve& curve : model.curves) state.curves.push_back(static_cast<float>(curve.value(simulation.time())));
  const Curve* curve = model.gravity_curve == 0 ? nullptr : &model.curves[static_cast<std::size_t>(model.gravity_curve)];
  state.gravity = vec::mul(simulation.scene().gravity, curve == nullptr ? 1 : curve->value(simulation.time()));
  return state;
}

BufferSource::Seeds BufferSource::find_seeds(const Simulation& simulation, const Tissue& tissue, const DrivenPart& tool) {
  Seeds seeds;
  if (tool.is_blade()) {
    const BladeSamples samples = simulation.press().samples(tool.index());
    for (std::size_t at = 0; at < samples.node.size(); ++at) {
      if (samples.weight[at] != 0) seeds.slots.push_back(samples.node[at]);
    }
    seeds.sort();
    return seeds;
  }
  const Model& model = simulation.model();
  if (model.contact == nullptr || model.tools == nullptr) return seeds;
  const ContactPoints& points = *model.contact;
  const ToolForm& form = (*model.tools)[tool.index()];
  const ToolMoment moment = tool_moment(form, simulation.time());
  const Pose at = compose(tool.pose(simulation, simulation.time()), moment.pose);
  double nearest = kFar * points.spacing;
  std::int32_t closest = -1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Vec3d x = points.rest[i];
    for (std::size_t a = 0; a < 8; ++a) {
      const double weight = static_cast<double>(points.weights[i][a]) / contact_weight_unit;
      x = vec::add(x, vec::mul(tissue.u[static_cast<std::size_t>(points.nodes[i][a])], weight));
    }
    const double distance = tool_distance(form, place_back(at, x), moment);
    if (distance < kNear * points.spacing) seeds.points.push_back(static_cast<std::int32_t>(i));
    if (distance < nearest) {
      nearest = distance;
      closest = static_cast<std::int32_t>(i);
    }
  }
  if (seeds.points.empty() && closest >= 0) seeds.points.push_back(closest);
  for (const std::int32_t i : seeds.points) {
    const auto& nodes = points.nodes[static_cast<std::size_t>(i)];
    seeds.slots.insert(seeds.slots.end(), nodes.begin(), nodes.end());
  }
  seeds.sort();
  return seeds;
}

bool BufferSource::holds(const Seeds& seeds) const {
  if (buffers_.empty() || ring_.empty()) return false;
  if (rings_ < 0) {
    const std::vector<std::int32_t>& slot = buffers_.back().model->part().slot;
    return std::all_of(seeds.slots.begin(), seeds.slots.end(), [&](std::int32_t s) {
      return !graph_->has_elements(s) || std::binary_search(slot.begin(), slot.end(), s);
    });
  }
  const std::int32_t inner = inner_ring(rings_);
  const std::vector<std::int32_t> now = graph_->rings(seeds.slots, 0);
  for (std::size_t e = 0; e < now.size(); ++e) {
    if (now[e] == 0 && (ring_[e] < 0 || ring_[e] > inner)) return false;
  }
  return true;
}

void BufferSource::build(const Simulation& simulation, const Seeds& seeds, const DrivenPart& tool, const Tissue& tissue) {
  ring_ = graph_->rings(seeds.slots, rings_ < 0 ? kAll : std::max(rings_ - 1, 0));
  if (std::none_of(ring_.begin(), ring_.end(), [](std::int32_t r) { return r >= 0; })) {
    ring_.clear();
    return;
  }
  Submodel part = extract(*model_, *graph_, ring_);
  part.topology = simulation.topology_version();
  part.rings = rings_;
  for (const ContactTool& t : simulation.contact().tools()) part.tools.push_back(t.name);
  bool covered = true;
  const TissueState state = state_of(simulation, tissue, part, tool, 0, covered);
  BufferInstrument instrument{{}, tool.length(), 0, tool.pose(simulation, simulation.time())};
  if (!tool.is_blade()) {
    instrument.tool = tool.index();
    instrument.grip = grip_strength(simulation.contact().tools()[tool.index()]);
  }
  buffers_.push_back({++generation_, std::make_unique<BufferModel>(std::move(part), instrument, state)});
}

void BufferSource::report(const Simulation& simulation, const DrivenPart& tool, FrameReport& out) {
  out.time = simulation.time();
  out.period = last_step_ >= 0 ? out.time - last_time_ : 0;
  out.tool = tool.pose(simulation, out.time);
  out.mean = tool.mean(simulation);
  out.last = tool.last(simulation).value_or(out.mean);
  out.topology = simulation.topology_version();
  out.number = ++number_;
  last_step_ = simulation.step();
  last_time_ = out.time;
}

std::optional<DrivenPart> BufferSource::fill_report(const Simulation& simulation, BufferMessage& message) {
  if (&simulation != simulation_ || simulation.step() < last_step_) {  // reset, loaded, or taken back
    simulation_ = &simulation;
    ++run_;
    ring_.clear();
    last_u_.clear();
    last_step_ = -1;
  }
  message.model = nullptr;
  message.covered = true;
  message.generation = generation_;
  message.run = run_;
  message.elements = 0;
  if (std::optional<DrivenPart> own = DrivenPart::find(simulation, tool_)) {
    report(simulation, *own, message.report);
    return own;
  }
  message.report = {};  // parked, or removed
  message.report.time = last_time_ = simulation.time();
  message.report.number = ++number_;
  last_step_ = -1;
  return {};
}

void BufferSource::fill(const Simulation& simulation, std::uint64_t in_use, BufferMessage& message) {
  std::erase_if(buffers_, [&](const Kept& k) { return k.generation < in_use && k.generation != generation_; });
  const std::optional<DrivenPart> own = fill_report(simulation, message);
  if (!own) return;
  const DrivenPart& tool = *own;
  const Tissue tissue(simulation);
  const Seeds seeds = find_seeds(simulation, tissue, tool);
  if (model_ != simulation.shared_model()) {
    model_ = simulation.shared_model();
    graph_ = std::make_shared<const ElementGraph>(*model_);
    ring_.clear();
    last_u_.clear();
  }
  message.elements = may_be_whole(*model_) ? graph_->elements() : std::numeric_limits<std::int64_t>::max();
  if (seeds.slots.empty()) {
    last_u_ = tissue.u;
    return;
  }
  if (!holds(seeds)) build(simulation, seeds, tool, tissue);
  if (ring_.empty()) {
    last_u_ = tissue.u;
    message.covered = false;
    return;
  }
  BufferModel& buffer = *buffers_.back().model;
  const std::vector<std::int32_t>& within = buffer.part().point;
  message.covered = std::all_of(seeds.points.begin(), seeds.points.end(),
                                [&](std::int32_t i) { return std::binary_search(within.begin(), within.end(), i); });
  message.model = &buffer;
  message.generation = generation_;
  message.state = state_of(simulation, tissue, buffer.part(), tool, message.report.period, message.covered);
  last_u_ = tissue.u;
}

}  // namespace pliant::haptics
