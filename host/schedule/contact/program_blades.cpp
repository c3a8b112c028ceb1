// Buffers and passes of blades that cut by force (kernels/contact/blade_press.cl).
#include "schedule/contact/blade_data.h"
#include "schedule/program_builder.h"

namespace pliant {

void ProgramBuilder::add_blades() {
  if (options_.blade_samples == 0) return;
  const auto samples = static_cast<std::size_t>(options_.blade_samples), blades = static_cast<std::size_t>(options_.blades);
  const auto steps = static_cast<std::size_t>(options_.batch_steps), entries = samples * blade_sample_nodes;
  const auto control = [&](const char* name, std::size_t count, const char* shape, const char* unit, double value = 0) {
    add(make_reals(name, BufferType::real, count, BufferRole::control, shape, unit, "host", std::vector<double>(count, value)));
  };
  const auto list = [&](const char* name, std::size_t count, const char* shape, std::int32_t value) {
    add(make_ints(name, BufferRole::control, shape, std::vector<std::int32_t>(count, value), 0, "host"));
  };
  list("blade_node", entries, "[samples][8]", 0);
  control("blade_weight", entries, "[samples][8]", "1");
  control("blade_share", entries, "[samples][8]", "1");
  control("blade_data", samples * blade_sample_numbers, "[samples][12]", "m (3), 1 (3), N, 1", -1);
  control("blade_pose", (steps + 1) * blades * blade_pose_numbers, "[steps + 1][blades][6]", "m");
  add_contact_state(
      make_reals("blade_front", BufferType::real, 2 * samples, BufferRole::state, "[samples][2]", "m, 1", "blade_press"));
  add(make_reals("blade_force", BufferType::real, steps * samples * blade_force_numbers, BufferRole::scratch,
                 "[steps][samples][4]", "N", "blade_press"));
  program_.buffers.back().carried = Carried::all;  // one row per step of the batch, until the host reads it
  list("blade_slot", entries, "[nodes]", -1);
  list("blade_free", entries, "[nodes]", 0);
  list("blade_first", entries + 1, "[nodes + 1]", 0);
  list("blade_entry", entries, "[samples x 8]", 0);
  program_.near_samples = std::make_shared<std::int64_t>(0);
  const auto pass = [&](const char* kernel, std::vector<Arg> args, std::size_t count, const char* label) {
    const auto n = static_cast<std::int64_t>(count);
    program_.step.push_back({kernel, {}, std::move(args), Shape::items, n, label, n, 0, 0});
    program_.step.back().active = program_.near_samples;
  };
  std::vector<Arg> press = named({"node_u", "node_w", "blade_node", "blade_weight", "blade_share", "blade_data", "blade_pose",
                                  "blade_front", "blade_force", "step_params"});
  press.insert(press.end(), {int_arg(options_.blade_samples), int_arg(options_.blades), step_arg()});
  pass("blade_press", std::move(press), samples, "edges of blades");
  std::vector<Arg> apply = named({"node_u", "node_w", "blade_slot", "blade_free", "blade_first", "blade_entry", "blade_weight",
                                  "blade_force", "step_params"});
  apply.insert(apply.end(), {int_arg(options_.blade_samples), step_arg()});
  pass("blade_apply", std::move(apply), entries, "nodes at edges of blades");
}

}  // namespace pliant
