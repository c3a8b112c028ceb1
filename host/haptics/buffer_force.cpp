#include "haptics/buffer_force.h"

#include <algorithm>
#include <cmath>

namespace pliant::haptics {

void BufferForce::receive(const BufferMessage& message, double interval) noexcept {
  last_ = &message.state;
  if (message.model == nullptr) {
    buffer_ = nullptr;
    generation_ = message.generation;
    return;
  }
  if (message.generation != generation_ || buffer_ == nullptr) {
    message.model->start(message.state);
    if (buffer_ != nullptr && message.run == run_) message.model->carry(*buffer_);
    buffer_ = message.model;
    generation_ = message.generation;
    run_ = message.run;
  }
  buffer_->hold(placed_ ? pose_ : message.report.tool);
  buffer_->follow(message.state, interval, lead_);
}

Wrench BufferForce::tick(const Pose& tool, double dt) noexcept {
  const Pose from = placed_ ? pose_ : tool;
  pose_ = tool;
  placed_ = true;
  if (buffer_ == nullptr) return {};
  if (settle_ > 0 && buffer_->whole()) buffer_->draw(*last_, std::min(1.0, dt / settle_));
  buffer_->grip(grip_);
  const Wrench wrench = buffer_->tick(from, tool, dt);
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c) sum += wrench.force[c] + wrench.torque[c];
  constexpr std::uint64_t kEvery = 8;  // ticks between two looks at all nodes
  if (std::isfinite(sum) && (++ticks_ % kEvery != 0 || buffer_->finite())) return wrench;
  ++resets_;
  buffer_->start(*last_);
  return {};
}

}  // namespace pliant::haptics
