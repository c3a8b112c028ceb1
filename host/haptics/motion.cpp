#include "haptics/motion.h"

#include <cmath>

#include "geometry/vec.h"
#include "scene/contact_tool.h"

namespace pliant::haptics {

Motion MotionEstimate::update(const DeviceSample& sample, double dt) noexcept {
  since_ += dt;
  const bool good = good_pose({sample.position, sample.turn}) && std::isfinite(sample.time);
  constexpr double kStill = 0.02;  // a device that says nothing for so long stands still [s]
  if (sample.number == last_.number || !good) {
    if (since_ > kStill) motion_ = {};
    return motion_;
  }
  const double own = sample.time - last_.time, between = own > 0 ? own : since_;
  if (last_.number > 0 && between > 0) {
    const double share = smoothing_ > 0 ? -std::expm1(-between / smoothing_) : 1;
    const Vec3d velocity = vec::mul(vec::sub(sample.position, last_.position), 1 / between);
    const Vec3d spin = vec::mul(turn_between({{}, last_.turn}, {{}, sample.turn}), 1 / between);
    motion_.velocity = vec::add(motion_.velocity, vec::mul(vec::sub(velocity, motion_.velocity), share));
    motion_.spin = vec::add(motion_.spin, vec::mul(vec::sub(spin, motion_.spin), share));
  }
  last_ = sample;
  since_ = 0;
  return motion_;
}

}  // namespace pliant::haptics
