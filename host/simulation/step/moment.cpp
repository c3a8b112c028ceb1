// Determines which states of a simulation are final, and stores states until they are.
#include "simulation/simulation.h"
#include "simulation/step/coupling.h"

namespace pliant {

Moment Simulation::moment() const {
  return {state_.clock,   loaded_.state_bytes(), reports_.now, state_.driven,
          state_.pressed, state_.driven_blades,  press_.felt()};
}

void Simulation::look_at(const Moment& moment, const std::function<void()>& look) {
  const Moment present = this->moment();
  const auto go = [&](const Moment& to) {
    state_.clock = to.clock;
    loaded_.write_state_bytes(to.buffers);
    reports_.now = to.report;
    state_.driven = to.driven;
    state_.pressed = to.pressed;
    state_.driven_blades = to.driven_blades;
    press_.put_back(to.felt);
  };
  go(moment);
  try {
    look();
  } catch (...) {
    go(present);
    throw;
  }
  go(present);
}

bool Simulation::confirm() {
  if (settled() || divergence_) return !divergence_;
  const Snapshot present = snapshot();
  const BladePress::Felt on_blades = press_.felt();
  const ToolContact::Felt on_tools = contact_.felt();
  while (!settled()) {
    const std::int32_t n = next_batch(settings_.batch_steps);
    const std::int64_t end = step() + n;
    begin_batch(n);
    run_steps(0, n);
    end_batch(n);
    if (step() != end) return false;
  }
  write_buffers(present, loaded_);
  state_ = present.state;
  upload_coupling(run_);  // the step may have become shorter
  reports_ = present.reports;
  press_.put_back(on_blades);
  contact_.put_back(on_tools);
  return true;
}

}  // namespace pliant
