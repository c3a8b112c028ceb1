// The state of a loaded Program in one that replaces it, as each buffer declares it (Carry and ToolNumbers in
// program/buffer.h).
#pragma once
#include <vector>

#include "simulation/state/loaded_model.h"

namespace pliant {

/// The initial values of the state buffers that take carried values, for LoadedModel::reset_initial_state once these have been
/// uploaded. `dropped`: buffers of Carry::drop take theirs, too.
[[nodiscard]] std::vector<BufferValues> initial_state(const Program& program, bool dropped);

/// Gives a buffer of the next Program the values that a buffer has on the backend.
void take_values(Backend& backend, BufferId from, Buffer& to);

/// Calls f(id of the buffer in `before`, buffer of `next`) for each state buffer that both have, in the same size.
template <class F>
void for_each_kept(const Program& before, Program& next, const F& f) {
  for (std::size_t i = 0; i < before.buffers.size(); ++i) {
    const Buffer& from = before.buffers[i];
    const BufferId to = from.role == BufferRole::state ? next.find(from.name) : -1;
    if (to >= 0 && next.at(to).values() == from.values()) f(static_cast<BufferId>(i), next.at(to));
  }
}

/// Where the values of a slot come from: (1 - share) times those of `before` plus `share` times those of `other`.
struct SlotOrigin {
  std::size_t slot = 0, before = 0, other = 0;
  double share = 0;
  /// The value of the slot, from number `c` of `stride` per slot.
  [[nodiscard]] double value(const std::vector<double>& from, std::size_t stride, std::size_t c) const {
    const double own = from[stride * before + c];
    return share > 0 ? (1 - share) * own + share * from[stride * other + c] : own;
  }
};

/// Carry::copy. Gives the slots of `to` the values that their origins have in `from`: of a texel the first three, since the
/// fourth (the inverse mass) belongs to the new model.
void copy_values(const std::vector<SlotOrigin>& origins, const std::vector<double>& from, Buffer& to);

}  // namespace pliant
