// The probes of the C API.
#include <algorithm>
#include <utility>
#include <vector>

#include "api/c_call.h"

namespace {

using namespace pliant::api;
using pliant::Error;
using pliant::ErrorCode;

/// Element i of an array of the caller's structs, which may be longer than this library's.
pliant_probe_value* probe_value(pliant_probe_value* first, std::size_t i) {
  return reinterpret_cast<pliant_probe_value*>(reinterpret_cast<char*>(first) + i * first->size);
}

void check_probe_values(pliant_probe_value* first, std::size_t count) {
  if (count == 0) return;
  need(first, "out");
  check_struct(first);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t size = probe_value(first, i)->size;
    if (size == first->size) continue;
    throw Error(ErrorCode::usage,
                fmt::format("pliant_probe_value::size is {} in out[{}] and {} in the first", size, i, first->size));
  }
}

}  // namespace

pliant_status pliant_world_probes(pliant_world world, pliant_probe_value* out, size_t count, size_t* needed) {
  return on(world, [&](CWorld& w) {
    check_probe_values(out, count);
    std::vector<pliant::ProbeValue> now = w.world.probes();
    const std::lock_guard lock(w.mutex);
    w.probes = std::move(now);
    if (needed != nullptr) *needed = w.probes.size();
    for (std::size_t i = 0; i < std::min(count, w.probes.size()); ++i) {
      const pliant::ProbeValue& v = w.probes[i];
      give_struct<pliant_probe_value>({0, v.probe.c_str(), v.quantity.c_str(), v.numbers.data(), v.numbers.size()},
                                      probe_value(out, i));
    }
  });
}
