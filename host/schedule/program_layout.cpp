#include "schedule/program_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "pliant/error.h"
#include "schedule/build_program.h"

namespace pliant {

ProgramLayout lay_out(const Model& model) {
  ProgramLayout layout;
  std::int64_t corner = 0;
  std::int64_t fault = std::int64_t{model.bricks} * PLIANT_BRICK_NODES;
  const auto place = [&](std::size_t count, int planes) {
    const BatchOffsets here{static_cast<std::int32_t>(corner), static_cast<std::int32_t>(fault)};
    corner += std::int64_t{padded(count)} * planes;
    fault += padded(count);
    // Indices in the kernels are 32-bit: 2^31 numbers of corner force are some 170 million tetrahedra.
    if (corner > std::numeric_limits<std::int32_t>::max() - 64 || fault > std::numeric_limits<std::int32_t>::max() - 64) {
      throw Error(
          ErrorCode::bad_input,
          fmt::format("the scene has too many elements for 32-bit indices: {} numbers of corner force, at most {} are possible",
                      corner, std::numeric_limits<std::int32_t>::max() - 64));
    }
    return here;
  };
  for (const ElementBatch& b : model.batches) layout.batches.push_back(place(b.size(), b.info().force));
  for (const FlsmBatch& b : model.flsm) layout.flsm.push_back(place(static_cast<std::size_t>(b.slots), 0));
  layout.corner_numbers = static_cast<std::int32_t>(corner);
  layout.faults = static_cast<std::int32_t>(fault);
  return layout;
}

FaultLocation find_fault(const Model& model, std::int32_t index) {
  if (index < model.bricks * PLIANT_BRICK_NODES) {
    return {model.brick_body[index / PLIANT_BRICK_NODES], model.brick_cell[index]};
  }
  const ProgramLayout layout = lay_out(model);
  FaultLocation found;
  for (std::size_t b = 0; b < model.batches.size(); ++b) {
    const std::int32_t local = index - layout.batches[b].fault_base;
    if (local >= 0 && local < static_cast<std::int32_t>(model.batches[b].size()))
      found = {model.batches[b].body, model.batches[b].id[local]};
  }
  for (std::size_t b = 0; b < model.flsm.size(); ++b) {
    const std::int32_t local = index - layout.flsm[b].fault_base;
    if (local < 0 || local >= model.flsm[b].own) continue;
    const auto& slots = model.bodies[model.flsm[b].body].slot;
    const auto node = std::find(slots.begin(), slots.end(), model.flsm[b].slot[local]);
    found = {model.flsm[b].body, node - slots.begin(), true};
  }
  return found;
}

}  // namespace pliant
