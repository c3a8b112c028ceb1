#include "simulation/state/carried_state.h"

#include <algorithm>

namespace pliant {

std::vector<BufferValues> initial_state(const Program& program, bool dropped) {
  std::vector<BufferValues> initial;
  for (std::size_t i = 0; i < program.buffers.size(); ++i) {
    const Buffer& buffer = program.buffers[i];
    if (buffer.role == BufferRole::state && (dropped || buffer.carry != Carry::drop))
      initial.push_back({static_cast<BufferId>(i), buffer.reals, buffer.ints});
  }
  return initial;
}

void take_values(Backend& backend, BufferId from, Buffer& to) {
  if (to.is_int()) {
    to.ints = backend.read_ints(from);
  } else {
    to.reals = backend.read_reals(from);
  }
}

void copy_values(const std::vector<SlotOrigin>& origins, const std::vector<double>& from, Buffer& to) {
  const std::size_t stride = to.type == BufferType::real4 ? 4 : 1, copied = std::min<std::size_t>(stride, 3);
  to.reals.resize(to.values(), to.padding);
  for (const SlotOrigin& o : origins) {
    for (std::size_t c = 0; c < copied; ++c) to.reals[stride * o.slot + c] = o.value(from, stride, c);
  }
}

}  // namespace pliant
