#include "edits/model_swap.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "edits/cut_state.h"
#include "model/boundary_conditions.h"

namespace pliant {
namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double lap(double& start) {
  const double end = now();
  return end - std::exchange(start, end);
}

}  // namespace

ModelSwap::ModelSwap(Simulation& simulation, std::vector<double> u, CutReport& report)
    : s_(simulation), report_(report), start_(now()), old_model_(s_.model_), old_u_(std::move(u)) {
  old_w_ = s_.backend_->read_reals(s_.w_);
  for (std::size_t b = 0; b < s_.scene_.bodies.size(); ++b) {
    v_.push_back(s_.velocities_from(old_w_, b));
  }
}

/// Most of a surface stays as it is.
void ModelSwap::keep_surface(Program& program) {
  if (s_.cuts_ == nullptr || s_.scene_.bodies.size() != 1) return;
  const ModelBody &body = model_->bodies[0], &before = s_.model_->bodies[0];
  const std::int32_t first = before.virtual_nodes.first;
  const auto real = first < 0 ? before.slot.size() : static_cast<std::size_t>(first);
  if (!std::equal(before.slot.begin(), before.slot.begin() + static_cast<std::ptrdiff_t>(real), body.slot.begin())) return;
  for (const char* name : {"surface_rest", "surface_node", "surface_weight"}) {
    Buffer& from = s_.program_.buffers[s_.program_.find(name)];  // nobody looks at its values again: changed is known
    Buffer& to = program.buffers[program.find(name)];
    to.reals = std::move(from.reals);
    to.ints = std::move(from.ints);
  }
  model_->surface = s_.cuts_->surface_copy.take(*s_.model_);
  kept_ = true;
}

void ModelSwap::take_surfaces(std::span<const Solid* const> solids, const std::function<void()>& ready) {
  ready();
  report_.surface += lap(start_);
  if (kept_) changes_ = &solids[0]->changes.value();  // every edit of a lattice lists them
  add_surfaces(solids, *model_, changes_);
}

void ModelSwap::run(std::span<const Solid* const> solids, std::vector<NodeOrigins> origins,
                    const std::function<void()>& ready) {
  origins_ = std::move(origins);
  model_ = std::make_shared<Model>(build_elements(s_.scene_, solids, s_.model_.get()));
  // What only the surface needs comes last: it takes longest to make.
  const bool follows = !needs_surface(s_.scene_) && !s_.program_.surface.empty();
  if (!follows) {
    report_.model += lap(start_);
    take_surfaces(solids, ready);
  }
  add_boundary_conditions(s_.scene_, *model_);
  Program program = build_program(*model_, {s_.scene_.integrator, s_.batch_steps_, follows});
  new_u_ = program.buffers[program.find("node_u")].reals;
  new_w_ = program.buffers[program.find("node_w")].reals;
  if (follows && solids[0]->lattice != nullptr) keep_surface(program);
  report_.model += lap(start_);
  s_.model_ = model_;
  // The buffers of the state are sent once, as they go on, and begin as always for whoever asks for the program.
  const auto exchange_state = [&](Program& of) {
    of.buffers[of.find("node_u")].reals.swap(new_u_);
    of.buffers[of.find("node_w")].reals.swap(new_w_);
  };
  try {
    carry_motion();
    exchange_state(program);
    s_.install(std::move(program), [&] {
      report_.upload += lap(start_);
      if (!follows) return;
      take_surfaces(solids, ready);
      set_surface(model_->surface, s_.program_, changes_);
      report_.model += lap(start_);
    });
  } catch (...) {
    restore();
    throw;
  }
  exchange_state(s_.program_);
  s_.upload_shape_matching();
  s_.state_.vectors.erase("kept");  // copies of the old model's buffers
  s_.state_.vectors["topology_version"] = {static_cast<double>(++s_.topology_version_)};
  report_.upload += lap(start_);
}

void ModelSwap::carry_motion() {
  for (std::size_t b = 0; b < v_.size(); ++b) {
    const NodeOrigins& origins = origins_[b];
    const std::vector<std::int32_t>&slots = model_->bodies[b].slot, &old_slots = old_model_->bodies[b].slot;
    std::vector<Vec3d> velocity(slots.size());
    for (std::size_t n = 0; n < velocity.size(); ++n) velocity[n] = v_[b][origins.of(n)];
    for (const FluxMass& f : origins.flux) {
      const double share = f.mass / model_->mass[slots[f.node]];
      for (std::size_t c = 0; c < 3; ++c) velocity[f.node][c] += share * (v_[b][f.from][c] - v_[b][origins.of(f.node)][c]);
    }
    for (std::size_t n = 0; n < slots.size(); ++n) {
      const auto slot = static_cast<std::size_t>(slots[n]);
      const double* moved = &old_u_[4 * static_cast<std::size_t>(old_slots[origins.of(n)])];
      const double step = s_.substeps_of(slot) * s_.state_.dt;
      for (std::size_t c = 0; c < 3; ++c) {
        new_u_[4 * slot + c] = moved[c];
        new_w_[4 * slot + c] = step * velocity[n][c];
      }
    }
  }
  for (std::size_t slot = 0; slot < model_->mass.size(); ++slot) new_w_[4 * slot + 3] = s_.decay(slot);
}

void ModelSwap::restore() {
  s_.model_ = old_model_;
  s_.load_program();
  s_.backend_->write_reals(s_.u_, old_u_);
  s_.backend_->write_reals(s_.w_, old_w_);
  s_.upload_shape_matching();
}

}  // namespace pliant
