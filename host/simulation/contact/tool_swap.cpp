#include "simulation/contact/tool_swap.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "schedule/build_program.h"
#include "schedule/contact/contact_data.h"
#include "schedule/program_layout.h"
#include "schedule/surface_program.h"
#include "simulation/state/carried_state.h"
#include "simulation/state/snapshot.h"
#include "simulation/step/coupling.h"
#include "simulation/step/host_loads.h"

namespace pliant {
namespace {

/// Planes of a buffer whose last one has the index of the tool + 1, negative if it grips (contact_grip.cl), or 0; 0: none has.
std::size_t planes_of(ToolNumbers tools) { return tools == ToolNumbers::fourth ? 4 : tools == ToolNumbers::second ? 2 : 0; }

/// The new index of each previous tool; -1: removed.
std::vector<int> new_numbers(const std::vector<ContactTool>& before, const std::vector<ContactTool>& next) {
  std::vector<int> number;
  for (const ContactTool& tool : before) {
    const auto found = std::find(next.begin(), next.end(), tool);
    number.push_back(found == next.end() ? -1 : static_cast<int>(found - next.begin()));
  }
  return number;
}

/// Tiles that were near a tool stay so; a new tool counts as near to all.
void renumber_near(std::vector<std::int32_t>& near, const std::vector<int>& number, std::size_t tools) {
  std::int32_t fresh = static_cast<std::int32_t>((std::int64_t{1} << tools) - 1);
  for (const int n : number) {
    if (n >= 0) fresh &= ~(std::int32_t{1} << n);
  }
  for (std::int32_t& bits : near) {
    std::int32_t now =
        fresh | (bits & ~static_cast<std::int32_t>((std::int64_t{1} << number.size()) - 1));  // keeps the bit for tissue
    for (std::size_t t = 0; t < number.size(); ++t) {
      if (number[t] >= 0 && (bits >> t & 1) != 0) now |= std::int32_t{1} << number[t];
    }
    bits = now;
  }
}

/// to(tool) returns the new index of the tool that a point's numbers belong to, or -1 for none.
template <class To>
void renumber_points(std::vector<double>& values, std::size_t planes, const To& to) {
  for (std::size_t i = 0; i < values.size() / planes; ++i) {
    double& held = values[tile_base(i, planes) + (planes - 1) * PLIANT_TILE];
    if (held == 0) continue;
    const int mark = static_cast<int>(std::abs(held)) - 1, slipped = mark >= 64 ? 64 : 0, now = to(mark - slipped);
    held = now < 0 ? 0 : held < 0 ? -(now + slipped + 1) : now + 1;
  }
}

/// Copies the state buffers that both programs have, with the new numbers of the tools that they name.
void carry_state(const RunContext& run, Program& next, const std::vector<int>& number, std::size_t tools) {
  for_each_kept(run.loaded.program(), next, [&](BufferId id, Buffer& to) {
    take_values(run.backend(), id, to);
    if (to.tools == ToolNumbers::bits) renumber_near(to.ints, number, tools);
    if (const std::size_t planes = planes_of(to.tools); planes > 0)
      renumber_points(to.reals, planes, [&](int t) { return number[static_cast<std::size_t>(t)]; });
  });
}

void load_with(RunContext& run, const Snapshot& snapshot, const std::shared_ptr<const Model>& model) {
  Program program = build_program(*model, run.program_options());
  Program surface = surface_program(model->surface, program);
  run.loaded.load(model, std::move(program), std::move(surface));
  write_buffers(snapshot, run.loaded);
}

void settle(RunContext& run) {
  run.place_surface();
  upload_coupling(run);
  if (!run.state.forces.empty()) HostLoads(run).upload();
}

}  // namespace

void load_tools(RunContext& run, const std::shared_ptr<const Model>& model, const std::vector<ContactTool>& before,
                const std::vector<ContactTool>& next) {
  const std::shared_ptr<const Model> old = run.loaded.shared_model();
  const Snapshot snapshot = take_snapshot(run);
  try {
    Program program = build_program(*model, run.program_options());
    std::vector<BufferValues> initial = initial_state(program, true);
    carry_state(run, program, new_numbers(before, next), next.size());
    Program surface = surface_program(model->surface, program);
    run.loaded.update(model, std::move(program));
    run.loaded.reset_initial_state(std::move(initial));
    run.loaded.update_surface(std::move(surface), false);
  } catch (...) {
    load_with(run, snapshot, old);
    settle(run);
    throw;
  }
  settle(run);
  run.state.look.tools = -1;  // pairs of tissue stay valid
  run.state.kept.reset();     // copies of the old program's buffers
}

void replace_shape(RunContext& run, std::size_t tool, const ToolForm& form) {
  auto forms = std::make_shared<ToolForms>(*run.model().tools);
  (*forms)[tool] = form;
  auto model = std::make_shared<Model>(run.model());
  model->tools = forms;
  if (const BufferId grid = run.loaded.program().find("tool_grid"); grid >= 0) {
    run.loaded.replace_constant(std::move(model), grid, tool_grid(*forms));
  } else {  // nothing can touch
    run.loaded.replace_model(std::move(model));
  }
  run.state.look.tools = -1;
}

void let_go(RunContext& run, std::size_t tool) {
  const Program& program = run.loaded.program();
  for (std::size_t i = 0; i < program.buffers.size(); ++i) {
    const std::size_t planes = planes_of(program.buffers[i].tools);
    if (planes == 0) continue;
    const auto id = static_cast<BufferId>(i);
    std::vector<double> values = run.backend().read_reals(id);
    renumber_points(values, planes, [&](int t) { return t == static_cast<int>(tool) ? -1 : t; });
    run.backend().write_reals(id, values);
  }
}

}  // namespace pliant
