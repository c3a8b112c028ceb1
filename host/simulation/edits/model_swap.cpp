#include "simulation/edits/model_swap.h"

#include <algorithm>
#include <map>
#include <utility>

#include "geometry/vec.h"
#include "model/links/membranes.h"
#include "model/matching/matching_step.h"
#include "model/nodes/ballast.h"
#include "model/nodes/boundary_conditions.h"
#include "schedule/build_program.h"
#include "schedule/surface_program.h"
#include "simulation/edits/carried_depths.h"
#include "simulation/edits/carried_grips.h"
#include "simulation/step/coupling.h"

namespace pliant {
ModelSwap::ModelSwap(RunContext& run, HostLoads& loads, EditedBodies& bodies, CutReport& report)
    : run_(run), loads_(loads), bodies_(bodies), report_(report), old_model_(run.loaded.shared_model()) {}

/// Returns true if real nodes keep their slots, so that most of the surface can be reused.
bool ModelSwap::keeps_surface() const {
  if (bodies_.size() != 1 || bodies_.find_cut(0) == nullptr || bodies_.uncut(0).lattice == nullptr) return false;
  const ModelBody &body = model_->bodies[0], &before = old_model_->bodies[0];
  const std::int32_t first = before.virtual_nodes.first;
  const auto real = static_cast<std::ptrdiff_t>(first < 0 ? before.slot.size() : static_cast<std::size_t>(first));
  return !origins_[0].from.empty() && std::equal(before.slot.begin(), before.slot.begin() + real, body.slot.begin());
}

void ModelSwap::take_surfaces() {
  if (!ready_) return;
  if (kept_) model_->surface = bodies_.surface_copy.take(*old_model_);
  std::exchange(ready_, nullptr)();
  report_.surface += clock_.lap();
  const std::vector<const BodyMesh*> solids = bodies_.solids();
  changes_ = kept_ ? &solids[0]->changes.value() : nullptr;  // every edit of a lattice lists them
  add_surfaces(solids, *model_, changes_);
  report_.model += clock_.lap();
}

void ModelSwap::build(const Scene& scene, std::vector<NodeOrigins> origins, std::function<void()> ready) {
  static_cast<void>(clock_.lap());
  origins_ = std::move(origins);
  ready_ = std::move(ready);
  model_ = std::make_shared<Model>(build_elements(scene, bodies_.solids(), old_model_.get()));
  kept_ = keeps_surface();
  // The surface takes longest, so it comes last unless loads need it.
  if (needs_surface(scene)) {
    report_.model += clock_.lap();
    take_surfaces();
    add_membranes(scene, *model_);
  }
  if (keeps_bodies_) model_->contact = contact_of_same_bodies(*old_model_, *model_);
  ballast_ = carried_ballast();           // in proportion to masses, of membranes too
  set_ballast(scene, *model_, ballast_);  // the last that can refuse a scene
  program_ = build_program(*model_, run_.program_options());
  same_nodes_ = keeps_state_ && keeps_nodes();
  const bool goals = std::any_of(model_->flsm.begin(), model_->flsm.end(), extrapolates);
  initial_ = initial_state(program_, same_nodes_ || goals || program_.find("contact_start") >= 0);
  report_.model += clock_.lap();
}

void ModelSwap::load(std::vector<double> u) {
  static_cast<void>(clock_.lap());  // what passed since the model was built
  old_u_ = std::move(u);
  old_w_ = run_.loaded.w();
  for (std::size_t b = 0; b < bodies_.size(); ++b) v_.push_back(run_.velocities(old_w_, b));
  try {
    load_steps();
    take_surfaces();
    load_surface();
  } catch (...) {
    restore();
    throw;
  }
  run_.state.offset = std::move(offset_);
  run_.place_surface();
  upload_coupling(run_);
  run_.state.ballast = std::move(ballast_);
  run_.state.kept.reset();  // copies of the old model's buffers

  // The vectors of dynamic relaxation refer to the old slots.
  RelaxationState& relaxation = run_.state.relaxation;
  for (std::vector<double>* values : {&relaxation.u, &relaxation.force, &relaxation.v, &relaxation.middle, &relaxation.steady})
    values->clear();
  if (!run_.state.forces.empty()) loads_.upload();
  report_.upload += clock_.lap();
}

std::vector<SlotOrigin> ModelSwap::slot_origins() const {
  std::vector<SlotOrigin> out;
  for (std::size_t b = 0; b < origins_.size(); ++b) {
    const std::vector<std::int32_t>&slots = model_->bodies[b].slot, &old_slots = old_model_->bodies[b].slot;
    const std::size_t first = out.size();
    for (std::size_t n = 0; n < slots.size(); ++n) {
      const auto before = static_cast<std::size_t>(old_slots[origins_[b].of(n)]);
      out.push_back({static_cast<std::size_t>(slots[n]), before, before, 0});
    }
    for (const MixedNode& mixed : origins_[b].mixed) {
      SlotOrigin& o = out[first + static_cast<std::size_t>(mixed.node)];
      o.other = static_cast<std::size_t>(old_slots[static_cast<std::size_t>(mixed.other)]);
      o.share = mixed.share;
    }
  }
  return out;
}

std::vector<char> ModelSwap::changed_nodes() const {
  std::vector<char> changed(model_->mass.size());
  for (const SlotOrigin& o : slot_origins())
    changed[o.slot] = static_cast<char>(model_->mass[o.slot] != old_model_->mass[o.before]);
  return changed;
}

std::vector<NodeInertia> ModelSwap::carried_ballast() const {
  std::vector<NodeInertia> out;
  if (old_model_->ballast.empty()) return out;
  std::map<std::size_t, const Ballast*> before;
  for (const Ballast& b : old_model_->ballast) before[static_cast<std::size_t>(b.slot)] = &b;
  for (const SlotOrigin& o : slot_origins()) {
    const auto found = before.find(o.before);
    if (found == before.end() || o.share > 0 || !(model_->mass[o.slot] > 0)) continue;
    const Ballast& had = *found->second;
    out.push_back({static_cast<std::int32_t>(o.slot), had.inertia * model_->mass[o.slot] / had.mass});
  }
  std::sort(out.begin(), out.end(), [](const NodeInertia& a, const NodeInertia& b) { return a.slot < b.slot; });
  return out;
}

bool ModelSwap::keeps_nodes() const {
  if (model_->slots != old_model_->slots) return false;
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    if (!origins_[b].from.empty() || model_->bodies[b].slot != old_model_->bodies[b].slot) return false;
  }
  return true;
}

void ModelSwap::keep_rest(Program& program) const {
  for_each_kept(run_.loaded.program(), program, [&](BufferId id, Buffer& to) {
    if (to.carry == Carry::drop) take_values(run_.backend(), id, to);
  });
}

void ModelSwap::load_steps() {
  // Upload the carried-over state only; restore the Program's initial values afterwards so that the Program itself stays
  // pristine.
  carry_nodes(program_);
  if (same_nodes_) {
    keep_rest(program_);
    mark_freed(run_, *model_, program_);
  } else {
    carry_grips(run_, *model_, program_);
    carry_depths(run_, *model_, program_);
    start_goals(*model_, program_.at(program_.find("node_u")).reals, program_);
  }
  run_.loaded.update(model_, std::move(program_));
  run_.state.look.tools = -1;
  if (!same_nodes_) run_.state.look.tissue = -1;  // new contact points have no partners yet
  run_.loaded.reset_initial_state(std::move(initial_));
  report_.upload += clock_.lap();
}

void ModelSwap::load_surface() {
  Program before = run_.loaded.take_surface();
  Program surface = surface_program(model_->surface, run_.loaded.program(), &before, changes_);
  const bool patched = std::any_of(surface.buffers.begin(), surface.buffers.end(),
                                   [](const Buffer& buffer) { return buffer.changed.has_value(); });
  run_.loaded.update_surface(std::move(surface), patched);
  report_.upload += clock_.lap();
}

void ModelSwap::carry_nodes(Program& program) {
  const Program& before = run_.loaded.program();
  const std::vector<SlotOrigin> origins = slot_origins();
  for (Buffer& to : program.buffers) {
    const BufferId id = to.carry == Carry::copy ? before.find(to.name) : -1;
    if (id == run_.loaded.u_id()) {
      copy_values(origins, old_u_, to);  // with RunState::offset
    } else if (id >= 0) {
      copy_values(origins, run_.backend().read_reals(id), to);
    }
    if (to.carry == Carry::velocity) carry_velocity(to);
  }
  carry_offset(origins, program.at(program.find("node_u")).reals);
}

void ModelSwap::carry_velocity(Buffer& to) const {
  for (std::size_t b = 0; b < v_.size(); ++b) {
    const std::vector<std::int32_t>& slots = model_->bodies[b].slot;
    const auto give = [&](std::size_t n, const Vec3d& velocity) {
      const auto slot = static_cast<std::size_t>(slots[n]);
      const double step = substeps_of(*model_, slot) * run_.state.clock.dt;
      for (std::size_t c = 0; c < 3; ++c) to.reals[4 * slot + c] = step * velocity[c];
    };
    for (std::size_t n = 0; n < slots.size(); ++n) give(n, v_[b][origins_[b].of(n)]);
    for (const MixedNode& mixed : origins_[b].mixed) {
      const auto n = static_cast<std::size_t>(mixed.node);
      const Vec3d &one = v_[b][origins_[b].of(n)], &other = v_[b][static_cast<std::size_t>(mixed.other)];
      give(n, vec::add(vec::mul(one, 1 - mixed.share), vec::mul(other, mixed.share)));
    }
  }
  // A cut may leave a moving virtual node with held anchors only. Since no update moves a held node, it would keep its
  // velocity; set it to zero. The node stays at its current place: moving it back would stretch the elements at it and create
  // energy.
  for (const Constraint& held : model_->constraints) {
    const auto at = static_cast<std::ptrdiff_t>(4) * held.slot;
    if (!held.holds()) continue;
    std::fill_n(to.reals.begin() + at, 3, 0.0);
  }
  for (std::size_t b = 0; b < v_.size(); ++b) {  // nodes that lost their elements stay where they are
    if (bodies_.remade(b) == nullptr) continue;
    for (const std::int32_t slot : model_->bodies[b].slot) {
      if (!(model_->mass[static_cast<std::size_t>(slot)] > 0))
        std::fill_n(to.reals.begin() + static_cast<std::ptrdiff_t>(4) * slot, 3, 0.0);
    }
  }
  for (std::size_t slot = 0; slot < model_->mass.size(); ++slot) to.reals[4 * slot + 3] = run_.decay(*model_, slot);
}

void ModelSwap::carry_offset(const std::vector<SlotOrigin>& origins, std::vector<double>& u) {
  const std::vector<double>& before = run_.state.offset;
  if (before.empty()) return;
  offset_.assign(3 * static_cast<std::size_t>(model_->slots), 0.0);
  for (const SlotOrigin& o : origins) std::copy_n(&before[3 * o.before], 3, &offset_[3 * o.slot]);
  for (std::size_t i = 0; i < offset_.size(); ++i) u[i / 3 * 4 + i % 3] -= offset_[i];
}

void ModelSwap::restore() {
  Program program = build_program(*old_model_, run_.program_options());
  Program surface = surface_program(old_model_->surface, program);
  run_.loaded.load(old_model_, std::move(program), std::move(surface));
  run_.write_u(old_u_);
  run_.loaded.write_w(old_w_);
  run_.place_surface();
  upload_coupling(run_);
  start_goals(run_);
  if (!run_.state.forces.empty()) loads_.upload();
  run_.state.kept.reset();  // its copies are gone
}

}  // namespace pliant
