// What a program that embeds the simulation puts on its nodes and takes out of them, and the surface that it reads.
#include <fmt/format.h>

#include "pliant/error.h"
#include "simulation/simulation.h"

namespace pliant {

void Simulation::set_forces(std::vector<HostForce> forces) {
  std::vector<char> reserved(static_cast<std::size_t>(model_->slots), 0);
  for (const NodeForce& f : model_->forces) reserved[static_cast<std::size_t>(f.slot)] = f.reserved ? 1 : 0;
  for (const HostForce& f : forces) {
    if (f.body >= model_->bodies.size() || f.node < 0 ||
        f.node >= static_cast<std::int64_t>(model_->bodies[f.body].slot.size())) {
      throw Error(ErrorCode::usage, fmt::format("there is no node {} of body {}", f.node, f.body));
    }
    const ModelBody& body = model_->bodies[f.body];
    if (reserved[static_cast<std::size_t>(body.slot[static_cast<std::size_t>(f.node)])] == 0) {
      throw Error(ErrorCode::state,
                  fmt::format("no force is reserved for node {} of body {}: only nodes that move the surface of an interactive "
                              "scene can have one",
                              f.node, body.name));
    }
  }
  host_forces_ = std::move(forces);
  upload_host_forces();
}

/// Writes the whole table of forces: those of the scene are constants of the Model. After a cut a node may be gone, or move no
/// vertex any more; its force waits until the host sets them again.
void Simulation::upload_host_forces() {
  const BufferId id = program_.find("load_force");
  std::vector<double> texels = id < 0 ? std::vector<double>{} : program_.buffers[static_cast<std::size_t>(id)].reals;
  if (id >= 0) texels.resize(program_.buffers[static_cast<std::size_t>(id)].values());  // a table without forces has no values
  std::vector<std::int32_t> place(static_cast<std::size_t>(model_->slots), -1);
  for (std::size_t f = 0; f < model_->forces.size(); ++f) {
    if (model_->forces[f].reserved) place[static_cast<std::size_t>(model_->forces[f].slot)] = static_cast<std::int32_t>(f);
  }
  for (const HostForce& f : host_forces_) {
    const auto& slots = model_->bodies[f.body].slot;
    if (f.node >= static_cast<std::int64_t>(slots.size())) continue;
    const std::int32_t at = place[static_cast<std::size_t>(slots[static_cast<std::size_t>(f.node)])];
    if (at < 0) continue;
    for (std::size_t c = 0; c < 3; ++c) texels[4 * static_cast<std::size_t>(at) + c] += f.force[c];
  }
  if (id >= 0) backend_->write_reals(id, texels);
}

/// The next move_blade puts it somewhere else.
void Simulation::lift_blade(const std::string& blade) {
  state_.vectors.erase("blade/" + blade);
  for (std::size_t b = 0; b < scene_.bodies.size(); ++b) state_.vectors.erase(fmt::format("front/{}/host/{}", b, blade));
}

std::size_t Simulation::surface_bytes() const {
  const BufferId id = program_.find("surface_x");
  if (id < 0) return 0;
  const std::size_t real = backend_->info().name == "cpu:double" ? sizeof(double) : sizeof(float);
  return program_.buffers[static_cast<std::size_t>(id)].values() * real;
}

void Simulation::read_surface_into(void* out) {
  if (program_.surface.empty()) return;
  backend_->run(program_.surface, 0, 1);
  backend_->read_into(program_.find("surface_x"), out);
}

}  // namespace pliant
