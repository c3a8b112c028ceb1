#include "io/save.h"

#include <fmt/format.h>

#include <cstring>

#include "pliant/error.h"
#include "program/hash.h"

namespace pliant {
namespace {

const std::string kVector = "vector/";

std::string real_type(const Simulation& simulation) {
  const BufferId u = simulation.program().find("node_u");
  const std::size_t values = simulation.program().buffers.at(static_cast<std::size_t>(u)).values();
  return simulation.backend().read_bytes(u).size() == sizeof(double) * values ? "double" : "float";
}

template <class T>
std::vector<T> values_of(const std::vector<std::uint8_t>& bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

void write_buffer(Backend& backend, BufferId id, const Buffer& buffer, const std::vector<std::uint8_t>& bytes, bool is_double) {
  if (buffer.is_int()) {
    backend.write_ints(id, values_of<std::int32_t>(bytes));
  } else if (is_double) {
    backend.write_reals(id, values_of<double>(bytes));
  } else {
    const std::vector<float> values = values_of<float>(bytes);
    backend.write_reals(id, {values.begin(), values.end()});
  }
}

/// The bytes of every state buffer, in the order of the table.
std::vector<const NamedBytes*> find_buffers(const Simulation& simulation, const Checkpoint& checkpoint, bool is_double,
                                            const std::filesystem::path& file) {
  std::vector<const NamedBytes*> found;
  for (const Buffer& buffer : simulation.program().buffers) {
    if (buffer.role != BufferRole::state) continue;
    const NamedBytes* match = nullptr;
    for (const NamedBytes& named : checkpoint.buffers) {
      if (named.name == buffer.name) match = &named;
    }
    const std::size_t expected = buffer.values() * (is_double && !buffer.is_int() ? 8 : 4);
    if (match == nullptr || match->bytes.size() != expected) {
      throw Error(ErrorCode::bad_input, fmt::format("{}: buffer {} has {} bytes, the scene needs {}", file.string(),
                                                    buffer.name, match == nullptr ? 0 : match->bytes.size(), expected));
    }
    found.push_back(match);
  }
  return found;
}

const std::vector<double>& host_group(const Checkpoint& checkpoint, const std::string& name, std::size_t size,
                                      const std::filesystem::path& file) {
  const auto group = checkpoint.host_state.find(name);
  if (group == checkpoint.host_state.end() || group->second.size() != size) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: the checkpoint lacks its group \"{}\" of {} numbers", file.string(), name, size));
  }
  return group->second;
}

}  // namespace

Checkpoint take_checkpoint(const Simulation& simulation) {
  const SimulationState& state = simulation.state();
  Checkpoint c;
  c.scene_hash = simulation.model_hash();
  c.scene_name = simulation.scene().name;
  c.real_type = real_type(simulation);
  c.step = state.step;
  c.time = simulation.time();
  c.dt = state.dt;
  c.host_state["clock"] = {static_cast<double>(state.origin_step), state.origin_time, state.stable_dt, state.damping,
                           state.caution};
  for (const auto& [name, values] : state.vectors) c.host_state[kVector + name] = values;
  const auto& buffers = simulation.program().buffers;
  for (std::size_t id = 0; id < buffers.size(); ++id) {
    if (buffers[id].role != BufferRole::state) continue;
    c.buffers.push_back({buffers[id].name, simulation.backend().read_bytes(static_cast<BufferId>(id))});
  }
  return c;
}

void restore_checkpoint(Simulation& simulation, const Checkpoint& checkpoint, const std::filesystem::path& file) {
  const auto& clock = host_group(checkpoint, "clock", 5, file);
  SimulationState state;
  state.step = checkpoint.step;
  state.dt = checkpoint.dt;
  state.origin_step = static_cast<std::int64_t>(clock[0]);
  state.origin_time = clock[1];
  state.stable_dt = clock[2];
  state.damping = clock[3];
  state.caution = clock[4];
  for (const auto& [name, values] : checkpoint.host_state) {
    if (name.rfind(kVector, 0) == 0) state.vectors[name.substr(kVector.size())] = values;
  }
  simulation.prepare_restore(state);  // before the hash: an operational region may have moved
  if (checkpoint.scene_hash != simulation.model_hash()) {
    throw Error(
        ErrorCode::bad_input,
        fmt::format(
            "{}: a checkpoint of \"{}\" (model {}) cannot resume \"{}\" (model {}): the scene, its meshes, the step given "
            "or the settings of the solver are not the same",
            file.string(), checkpoint.scene_name, hash_text(checkpoint.scene_hash), simulation.scene().name,
            hash_text(simulation.model_hash())));
  }
  const std::string real = real_type(simulation);
  if (checkpoint.real_type != real) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: a checkpoint in {} cannot resume on the backend {}, which computes in {}", file.string(),
                            checkpoint.real_type, simulation.backend().info().name, real));
  }
  const auto found = find_buffers(simulation, checkpoint, real == "double", file);
  const auto& buffers = simulation.program().buffers;
  std::size_t next = 0;
  for (std::size_t id = 0; id < buffers.size(); ++id) {
    if (buffers[id].role != BufferRole::state) continue;
    write_buffer(simulation.backend(), static_cast<BufferId>(id), buffers[id], found[next++]->bytes, real == "double");
  }
  simulation.restore(state);
}

}  // namespace pliant
