// Which states of a simulation may leave it as results, and states that wait for that.
#include "simulation/simulation.h"

namespace pliant {

Moment Simulation::moment() const { return {state_.clock, loaded_.state_bytes(), contact_.felt()}; }

void Simulation::look_at(const Moment& moment, const std::function<void()>& look) {
  const Moment present = this->moment();
  const auto go = [&](const Moment& to) {
    state_.clock = to.clock;
    loaded_.write_state_bytes(to.buffers);
    contact_.set_felt(to.felt);
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
  const Felt felt = contact_.felt();
  const Inversions inversions = inversions_;
  const BallastReport ballast = ballast_;
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
  contact_.set_felt(felt);
  inversions_ = inversions;
  ballast_ = ballast;
  return true;
}

}  // namespace pliant
