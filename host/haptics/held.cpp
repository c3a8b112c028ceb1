#include "haptics/held.h"

#include <algorithm>

#include "geometry/wrench.h"

namespace pliant::haptics {
namespace {

const Wrench& wrench_of(const FrameReport& report, Sampled sampled) {
  return sampled == Sampled::mean ? report.mean : report.last;
}

}  // namespace

void HeldForce::receive(const FrameReport& report) noexcept { wrench_ = wrench_of(report, sampled_); }

Wrench HeldForce::tick(const Pose& /*tool*/, double /*dt*/) noexcept { return wrench_; }

void ExtrapolatedForce::receive(const FrameReport& report) noexcept {
  const Wrench& wrench = wrench_of(report, sampled_);
  const double at = report.time - (sampled_ == Sampled::mean ? report.period / 2 : 0);
  slope_ = {};
  if (any_ && at > sampled_at_) {
    slope_ = scaled(minus(wrench, newest_), 1 / (at - sampled_at_));
  }
  newest_ = wrench;
  sampled_at_ = at;
  time_ = report.time;
  any_ = true;
}

Wrench ExtrapolatedForce::tick(const Pose& /*tool*/, double dt) noexcept {
  time_ += dt;
  const double ahead = std::clamp(time_ - sampled_at_, 0.0, horizon_);
  return plus(newest_, scaled(slope_, ahead));
}

}  // namespace pliant::haptics
