#include "simulation/step/host_loads.h"

#include <fmt/format.h>

#include <utility>

#include "pliant/error.h"

namespace pliant {

void HostLoads::check(const Model& model, const std::vector<HostForce>& forces) {
  std::vector<char> reserved(static_cast<std::size_t>(model.slots), 0);
  for (const NodeForce& f : model.forces) reserved[static_cast<std::size_t>(f.slot)] = f.reserved ? 1 : 0;
  for (const HostForce& f : forces) {
    if (f.body >= model.bodies.size() || f.node < 0 || f.node >= static_cast<std::int64_t>(model.bodies[f.body].slot.size())) {
      throw Error(ErrorCode::usage, fmt::format("there is no node {} of body {}", f.node, f.body));
    }
    const ModelBody& body = model.bodies[f.body];
    if (reserved[static_cast<std::size_t>(body.slot[static_cast<std::size_t>(f.node)])] == 0) {
      throw Error(ErrorCode::state,
                  fmt::format("no force is reserved for node {} of body {}: only nodes that move the surface of an interactive "
                              "scene can have one",
                              f.node, body.name));
    }
  }
}

void HostLoads::set(std::vector<HostForce> forces) {
  check(run_.model(), forces);
  run_.state.forces = std::move(forces);
  upload();
}

void HostLoads::upload() const {
  const Model& model = run_.model();
  const Program& program = run_.loaded.program();
  const BufferId id = program.find("load_force");
  if (id < 0) return;
  std::vector<double> texels = program.at(id).reals;
  texels.resize(program.at(id).values());  // without forces the table has no values
  std::vector<std::int32_t> place(static_cast<std::size_t>(model.slots), -1);
  for (std::size_t f = 0; f < model.forces.size(); ++f) {
    if (model.forces[f].reserved) place[static_cast<std::size_t>(model.forces[f].slot)] = static_cast<std::int32_t>(f);
  }
  for (const HostForce& f : run_.state.forces) {
    const auto& slots = model.bodies[f.body].slot;
    if (f.node >= static_cast<std::int64_t>(slots.size())) continue;
    const std::int32_t at = place[static_cast<std::size_t>(slots[static_cast<std::size_t>(f.node)])];
    if (at < 0) continue;
    for (std::size_t c = 0; c < 3; ++c) texels[4 * static_cast<std::size_t>(at) + c] += f.force[c];
  }
  run_.backend().write_reals(id, texels);
}

}  // namespace pliant
