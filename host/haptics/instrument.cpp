#include "haptics/instrument.h"

#include <algorithm>

#include "geometry/vec.h"
#include "haptics/coupling.h"
#include "pliant/error.h"

namespace pliant::haptics {

std::optional<std::string> Instrument::before(Simulation& simulation, double seconds) {
  driven_.reset();
  hand.take();
  const InstrumentPose& newest = hand.newest();
  if (!newest.given || !(seconds > 0)) return {};
  Pose target = newest.pose;
  const double ahead = predict_ * seconds;
  target.position = vec::add(target.position, vec::mul(newest.motion.velocity, ahead));
  target = turned(target, vec::mul(newest.motion.spin, ahead));
  if (sent_ && *sent_ == target) return {};
  try {
    simulation.tools().drive(tool_, target, seconds);
    sent_ = driven_ = target;
    return {};
  } catch (const Error& error) {
    if (error.code() == ErrorCode::internal || error.code() == ErrorCode::device) throw;
    ++refused;
    return error.what();
  }
}

void Instrument::after(const Simulation& simulation) {
  if (const std::int32_t wanted = wanted_rings.load(); wanted != 0) source_.set_rings(wanted);
  source_.fill(simulation, in_use.load(std::memory_order_acquire), tissue.draft());
  tissue.publish();
}

}  // namespace pliant::haptics
