#include "schedule/build_program.h"

#include <algorithm>

#include "pliant/error.h"
#include "schedule/kernel_cost.h"
#include "schedule/program_builder.h"

namespace pliant {

ProgramBuilder::ProgramBuilder(const Model& model, const ProgramOptions& options)
    : model_(model), options_(options), layout_(lay_out(model)), brick_corners_(brick_corners()) {}

/// Removes history and velocity from a force pass, for estimates, relaxation and probes, whose displacements are not part of
/// a motion.
static void evaluate_only(Pass& pass) {
  for (auto& [name, number] : pass.defines) {
    if (name == "VISCOUS") number = 0;
  }
}

static bool is_viscous(const Pass& pass) {
  return std::any_of(pass.defines.begin(), pass.defines.end(),
                     [](const auto& define) { return define.first == "VISCOUS" && define.second != 0; });
}

/// An edit finds what a buffer was before by its name (ProgramBackend::remake).
static void check_names(const std::vector<Buffer>& buffers) {
  std::vector<std::string_view> names;
  for (const Buffer& buffer : buffers) names.emplace_back(buffer.name);
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice != names.end()) throw Error(ErrorCode::internal, "two buffers have the name " + std::string(*twice));
}

Program ProgramBuilder::build() {
  add_shared_buffers();
  add_surface();
  add_pressure_passes();
  for (std::size_t b = 0; b < model_.brick_batches.size(); ++b) add_bricks(model_.brick_batches[b]);
  for (std::size_t b = 0; b < model_.batches.size(); ++b) add_batch(b);
  add_loads();
  add_links();
  program_.force = program_.step;
  if (std::any_of(program_.step.begin(), program_.step.end(), is_viscous)) program_.rates = program_.step;
  for (Pass& pass : program_.force) evaluate_only(pass);
  add_gravity();
  for (std::size_t b = 0; b < model_.flsm.size(); ++b) add_flsm(b);
  add_updates();
  add_constraints();
  add_rotations();
  add_contact();
  add_blades();
  add_status();
  check_names(program_.buffers);
  return std::move(program_);
}

void ProgramBuilder::add_shared_buffers() {
  const auto slots = static_cast<std::size_t>(model_.slots);
  std::vector<double> u(4 * slots), w(4 * slots);
  for (std::size_t s = 0; s < slots; ++s) {
    u[4 * s + 3] = model_.mass[s] > 0 ? 1 / model_.mass[s] : 0;
    w[4 * s + 3] = 1;  // decay per step; the host writes it once the step is known
  }
  for (std::size_t s = 0; s < model_.displacement.size(); ++s) {
    for (std::size_t c = 0; c < 3; ++c) u[4 * s + c] = model_.displacement[s][c];
  }
  for (const Constraint& c : model_.constraints) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if ((c.axes >> axis & 1) != 0) u[4 * static_cast<std::size_t>(c.slot) + axis] = 0;
    }
    if (c.holds()) u[4 * static_cast<std::size_t>(c.slot) + 3] = 0;
  }
  node_u_ = add(declare_state(make_reals("node_u", BufferType::real4, slots, BufferRole::state, "[slots]", "m, m, m, 1/kg",
                                         "node_update, brick_update, node_prescribe, node_rotate", std::move(u)),
                              Carry::copy));
  node_w_ = add(declare_state(make_reals("node_w", BufferType::real4, slots, BufferRole::state, "[slots]", "m, m, m, 1",
                                         "node_update, brick_update, node_prescribe, node_rotate", std::move(w)),
                              Carry::velocity));
  node_force_ = add(make_reals("node_force", BufferType::real4, slots, BufferRole::scratch, "[slots]", "N",
                               "node_update, brick_update (FORCE_ONLY)"));
  program_.buffers[node_force_].carried = Carried::unwritten;  // zero at slots without a node and at those of shape matching
  node_load_ = add(
      make_reals("node_load", BufferType::real4, needs_load() ? slots : 1, BufferRole::scratch, "[slots]", "N", "node_load"));
  program_.buffers[node_load_].carried = Carried::unwritten;  // zero for unloaded nodes
  if (has_list_elements() || has_list_nodes()) {
    const std::size_t numbers = static_cast<std::size_t>(layout_.corner_numbers) + 3 * PLIANT_TILE;
    corner_ = add(make_reals("corner_force", BufferType::real, numbers, BufferRole::scratch, "[tiles][corners][3][16]", "N",
                             "element kernels"));
    program_.buffers[corner_].padding = -0.0;
    // The gather lists of nodes with fewer corners than others are padded with these.
    program_.buffers[corner_].fixed = 3 * PLIANT_TILE;
  }
  // Backups for rollback when an element fails.
  for (const BufferId state : {node_u_, node_w_}) add_last_good(program_, state);
  fault_ = add(make_ints("fault", BufferRole::scratch, "[elements]", {}, std::max(layout_.faults, 1), "element kernels"));
  program_.buffers[fault_].carried = Carried::all;  // the first step in which an element failed, until the host clears it
  summary_ = add(make_ints("fault_summary", BufferRole::scratch, "[256][4]", {}, 256 * PLIANT_FAULT_SUMMARY, "fault_reduce"));
  fastest_ = add(make_reals("increment_summary", BufferType::real, 256, BufferRole::scratch, "[256]", "m", "increment_reduce"));
  params_ = add(make_reals("step_params", BufferType::real, 8, BufferRole::control, "[8]", "s, m/s^2 (3), m (2)", "host"));
  curves_ = add(make_reals("curve_value", BufferType::real,
                           (static_cast<std::size_t>(options_.batch_steps) + 1) * model_.curves.size(), BufferRole::control,
                           "[steps + 1][curves]", "1", "host"));
}

/// Input of a step's updates: the host's parameters, or with a gravity curve the result of step_gravity.
void ProgramBuilder::add_gravity() {
  now_ = params_;
  if (model_.gravity_curve == 0) return;
  now_ = add(make_reals("step_now", BufferType::real, 8, BufferRole::scratch, "[8]", "s, m/s^2 (3), m (2)", "step_gravity"));
  program_.step.push_back({"step_gravity",
                           {},
                           {buffer_arg(now_), buffer_arg(params_), buffer_arg(curves_), int_arg(curve_count()),
                            int_arg(model_.gravity_curve), step_arg()},
                           Shape::items,
                           8,
                           "gravity",
                           0,
                           0,
                           0});
}

std::vector<std::pair<std::string, int>> ProgramBuilder::update_defines(int force_only) const {
  return {{"FORCE_ONLY", force_only}, {"HAS_LOAD", needs_load() ? 1 : 0}, {"INTEGRATOR", integrator()}};
}

void ProgramBuilder::add_update(int force_only, const Pass& pass) {
  (force_only ? program_.force : program_.step).push_back(pass);
  if (force_only && !program_.rates.empty()) program_.rates.push_back(pass);
}

void ProgramBuilder::add_updates() {
  if (model_.bricks > 0) {
    const std::int64_t count = std::int64_t{model_.bricks} * PLIANT_BRICK_NODES;
    for (const int force_only : {0, 1}) {
      Pass pass{
          "brick_update",
          update_defines(force_only),
          {buffer_arg(node_u_), buffer_arg(node_w_), buffer_arg(brick_neighbor_), buffer_arg(brick_rows_),
           buffer_arg(brick_force_), buffer_arg(node_load_), buffer_arg(node_force_), buffer_arg(force_only ? params_ : now_)},
          Shape::lanes,
          count,
          "brick nodes",
          count,
          brick_update_bytes(needs_load()),
          24};
      add_update(force_only, pass);
    }
  }
  if (has_list_nodes()) add_list_update();
}

void ProgramBuilder::add_list_update() {
  const std::int32_t nodes = model_.list_end - model_.list_base;
  std::vector<std::vector<std::int32_t>> corners(nodes);
  std::vector<std::size_t> valence(nodes, 0);
  for (const ElementBatch& batch : model_.batches) {
    for (const std::int32_t slot : batch.nodes) {
      if (slot >= model_.list_base) ++valence[slot - model_.list_base];
    }
  }
  for (std::size_t n = 0; n < corners.size(); ++n) corners[n].reserve(valence[n]);
  for (std::size_t b = 0; b < model_.batches.size(); ++b) {
    const ElementBatch& batch = model_.batches[b];
    for (std::size_t e = 0; e < batch.size(); ++e) {
      const auto slots = batch.nodes_of(e);
      for (std::size_t a = 0; a < slots.size(); ++a) {
        const std::int32_t node = slots[a] - model_.list_base;
        if (node >= 0) corners[node].push_back(corner_position(layout_.batches[b], e, static_cast<int>(a), batch.info().force));
      }
    }
  }
  GatherList list = pack_rows(corners, layout_.corner_numbers);
  const double entries = double(list.index.size()) / nodes;
  const auto offset_id = add(make_ints("gather_offset", BufferRole::constant, "[tiles + 1]", std::move(list.offset)));
  const auto index_id = add(make_ints("gather_index", BufferRole::constant, "[rows][16]", std::move(list.index), 1));
  for (const int force_only : {0, 1}) {
    Pass pass{
        "node_update",
        update_defines(force_only),
        {buffer_arg(node_u_), buffer_arg(node_w_), buffer_arg(offset_id), buffer_arg(index_id), buffer_arg(corner_),
         buffer_arg(node_load_), buffer_arg(node_force_), buffer_arg(force_only ? params_ : now_), int_arg(model_.list_base)},
        Shape::lanes,
        nodes,
        "list nodes",
        nodes,
        16 * entries + 64 + (needs_load() ? 16 : 0),
        3 * entries + 21};
    add_update(force_only, pass);
  }
}

void ProgramBuilder::add_constraints() {
  std::vector<std::int32_t> node, axes, curve;
  std::vector<double> target;
  for (const Constraint& c : model_.constraints) {
    const std::int32_t straight = c.axes & ~c.turned;
    if (c.holds() || straight == 0) continue;  // held nodes have no inverse mass, so the update does not move them
    node.push_back(c.slot);
    axes.push_back(straight);
    curve.insert(curve.end(), c.curve.begin(), c.curve.end());
    target.insert(target.end(), {c.target[0], c.target[1], c.target[2], 0.0});
  }
  if (node.empty()) return;
  // Whole work-groups: the padding prescribes no component.
  const std::size_t real_count = node.size(), count = (node.size() + 63) / 64 * 64;
  node.resize(count, node.back());
  axes.resize(count, 0);
  curve.resize(3 * count, 0);
  target.resize(4 * count, 0.0);
  const auto node_id = add(make_ints("prescribed_node", BufferRole::constant, "[prescribed]", std::move(node)));
  const auto axes_id = add(make_ints("prescribed_axes", BufferRole::constant, "[prescribed]", std::move(axes)));
  const auto curve_id = add(make_ints("prescribed_curve", BufferRole::constant, "[prescribed][3]", std::move(curve)));
  const auto target_id = add(make_reals("prescribed_target", BufferType::real4, count, BufferRole::constant, "[prescribed]",
                                        "m", "model", std::move(target)));
  program_.step.push_back(
      {"node_prescribe",
       {{"INTEGRATOR", integrator()}},
       {buffer_arg(node_u_), buffer_arg(node_w_), buffer_arg(node_id), buffer_arg(axes_id), buffer_arg(curve_id),
        buffer_arg(target_id), buffer_arg(curves_), int_arg(curve_count()), step_arg()},
       Shape::items,
       static_cast<std::int64_t>(count),
       "prescribed nodes",
       static_cast<std::int64_t>(real_count),
       60,
       9});
}

void ProgramBuilder::add_rotations() {
  std::vector<std::int32_t> node, axes, curve;
  std::vector<double> cosine, sine;
  for (const Constraint& c : model_.constraints) {
    if (c.holds() || c.turned == 0) continue;
    node.push_back(c.slot);
    axes.push_back(c.turned);
    curve.insert(curve.end(), c.curve.begin(), c.curve.end());
    cosine.insert(cosine.end(), {c.target[0], c.target[1], c.target[2], 0.0});
    sine.insert(sine.end(), {c.sine[0], c.sine[1], c.sine[2], 0.0});
  }
  if (node.empty()) return;
  const std::size_t real_count = node.size(), count = (node.size() + 63) / 64 * 64;  // as in add_constraints
  node.resize(count, node.back());
  axes.resize(count, 0);
  curve.resize(3 * count, 0);
  cosine.resize(4 * count, 0.0);
  sine.resize(4 * count, 0.0);
  const auto node_id = add(make_ints("rotated_node", BufferRole::constant, "[rotated]", std::move(node)));
  const auto axes_id = add(make_ints("rotated_axes", BufferRole::constant, "[rotated]", std::move(axes)));
  const auto curve_id = add(make_ints("rotated_curve", BufferRole::constant, "[rotated][3]", std::move(curve)));
  const auto cosine_id = add(make_reals("rotated_cosine", BufferType::real4, count, BufferRole::constant, "[rotated]", "m",
                                        "model", std::move(cosine)));
  const auto sine_id = add(
      make_reals("rotated_sine", BufferType::real4, count, BufferRole::constant, "[rotated]", "m", "model", std::move(sine)));
  program_.step.push_back(
      {"node_rotate",
       {{"INTEGRATOR", integrator()}},
       {buffer_arg(node_u_), buffer_arg(node_w_), buffer_arg(node_id), buffer_arg(axes_id), buffer_arg(curve_id),
        buffer_arg(cosine_id), buffer_arg(sine_id), buffer_arg(curves_), int_arg(curve_count()), step_arg()},
       Shape::items,
       static_cast<std::int64_t>(count),
       "rotated nodes",
       static_cast<std::int64_t>(real_count),
       76,
       27});
}

void ProgramBuilder::add_status() {
  program_.status.push_back({"fault_reduce",
                             {},
                             {buffer_arg(fault_), buffer_arg(summary_), int_arg(layout_.faults)},
                             Shape::items,
                             256,
                             "first fault",
                             0,
                             0,
                             0});
  program_.status.push_back({"increment_reduce",
                             {},
                             {buffer_arg(node_w_), buffer_arg(fastest_), int_arg(model_.slots)},
                             Shape::items,
                             256,
                             "largest increment",
                             0,
                             0,
                             0});
}

Program build_program(const Model& model, const ProgramOptions& options) { return ProgramBuilder(model, options).build(); }

}  // namespace pliant
