#include "simulation/state/loaded_model.h"

#include <algorithm>

#include "backends/interface/buffer_bytes.h"

namespace pliant {
void LoadedModel::load(std::shared_ptr<const Model> model, Program program, Program surface) {
  backend_->finish();
  model_ = std::move(model);
  program_ = std::move(program);
  surface_ = std::move(surface);
  backend_->load(program_);
  backend_->extend(nullptr, surface_);
  count_surface();
  look_up();
  note_change();
}

void LoadedModel::update(std::shared_ptr<const Model> model, Program program) {
  model_ = std::move(model);
  const Program loaded = std::exchange(program_, std::move(program));
  backend_->update(loaded, program_);
  look_up();
  note_change();
}

void LoadedModel::replace_constant(std::shared_ptr<const Model> model, BufferId id, std::vector<double> values) {
  backend_->write_reals(id, values);
  program_.at(id).reals = std::move(values);
  replace_model(std::move(model));
}

void LoadedModel::reset_initial_state(std::vector<BufferValues> initial) {
  for (BufferValues& values : initial) {
    program_.at(values.id).reals = std::move(values.reals);
    program_.at(values.id).ints = std::move(values.ints);
  }
}

void LoadedModel::update_surface(Program surface, bool patched) {
  // A patched surface lists its differences: of the previous buffers only type and size are needed.
  surface_ = std::move(surface);
  Program before;
  for (const Buffer& buffer : surface_.buffers) {
    Buffer row;
    row.name = buffer.name;
    row.type = buffer.type;
    row.role = buffer.role;
    before.buffers.push_back(std::move(row));
  }
  for (std::size_t i = 0; patched && i < before.buffers.size(); ++i) before.buffers[i].count = surface_counts_.at(i);
  backend_->extend(patched ? &before : nullptr, surface_);
  for (Buffer& buffer : surface_.buffers) buffer.changed.reset();  // refers only to this surface
  count_surface();
}

void LoadedModel::count_surface() {
  surface_counts_.clear();
  for (const Buffer& buffer : surface_.buffers) surface_counts_.push_back(buffer.count);
}

void LoadedModel::look_up() {
  ids_ = {program_.find("node_u"),        program_.find("node_w"),           program_.find("node_force"),
          program_.find("step_params"),   program_.find("curve_value"),      program_.find("fault"),
          program_.find("fault_summary"), program_.find("increment_summary")};
  kept_.clear();
  for (std::size_t id = 0; id < program_.buffers.size(); ++id) {
    const BufferId live = program_.buffers[id].copy_of;
    if (live >= 0) kept_.emplace_back(live, static_cast<BufferId>(id));
  }
  free_.assign(3 * static_cast<std::size_t>(model_->slots), false);
  for (std::size_t s = 0; s < model_->mass.size(); ++s) {
    for (std::size_t c = 0; c < 3; ++c) free_[3 * s + c] = model_->mass[s] > 0;
  }
  for (const Constraint& constraint : model_->constraints) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (constraint.axes & (1 << c)) free_[3 * static_cast<std::size_t>(constraint.slot) + c] = false;
    }
  }
}

BufferId LoadedModel::surface_buffer(const char* name) const {
  const BufferId own = surface_.find(name);
  return own >= 0 ? own : program_.find(name);
}

void LoadedModel::clear_faults() {
  backend_->write_ints(ids_.fault, std::vector<std::int32_t>(program_.at(ids_.fault).count, 0));
}

double LoadedModel::largest_increment() const {
  const std::vector<double> most = backend_->read_reals(ids_.fastest);
  return *std::max_element(most.begin(), most.end());
}

void LoadedModel::keep_state() {
  for (const auto& [live, copy] : kept_) backend_->copy(live, copy);
}

void LoadedModel::return_to_kept_state() {
  for (const auto& [live, copy] : kept_) backend_->copy(copy, live);
  backend_->finish();
  note_change();
}

std::vector<std::vector<std::uint8_t>> LoadedModel::state_bytes() const {
  std::vector<std::vector<std::uint8_t>> bytes;
  for (const auto& kept : kept_) bytes.push_back(backend_->read_bytes(kept.first));
  return bytes;
}

void LoadedModel::write_state_bytes(const std::vector<std::vector<std::uint8_t>>& bytes) {
  for (std::size_t i = 0; i < kept_.size(); ++i) write_bytes(kept_[i].first, bytes[i]);
}

void LoadedModel::write_bytes(BufferId id, const std::vector<std::uint8_t>& bytes) {
  note_change();
  pliant::write_bytes(*backend_, program_.at(id), id, bytes);
}

std::vector<Vec3d> LoadedModel::positions(const std::vector<double>& u, std::size_t body) const {
  std::vector<Vec3d> x = model_->bodies[body].rest;
  for (std::size_t n = 0; n < x.size(); ++n) {
    const double* moved = &u[4 * static_cast<std::size_t>(model_->bodies[body].slot[n])];
    for (std::size_t c = 0; c < 3; ++c) x[n][c] += moved[c];
  }
  return x;
}

std::vector<Vec3d> LoadedModel::pick(const std::vector<double>& texels, std::size_t body, double factor) const {
  std::vector<Vec3d> out;
  out.reserve(model_->bodies.at(body).slot.size());
  for (const std::int32_t s : model_->bodies[body].slot) {
    const double* t = &texels[4 * static_cast<std::size_t>(s)];
    out.push_back({factor * t[0], factor * t[1], factor * t[2]});
  }
  return out;
}

}  // namespace pliant
