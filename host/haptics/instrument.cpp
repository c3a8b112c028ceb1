#include "haptics/instrument.h"

#include <algorithm>
#include <utility>

#include "geometry/vec.h"
#include "haptics/coupling.h"
#include "haptics/driven_part.h"
#include "haptics/grip_button.h"
#include "pliant/error.h"

namespace pliant::haptics {

std::optional<std::string> Instrument::before(Simulation& simulation, double seconds) {
  driven_.reset();
  gripped_.reset();
  hand.take();
  const InstrumentPose& newest = hand.newest();
  if (!newest.given || !(seconds > 0)) return {};
  Pose target = newest.pose;
  const double ahead = predict_ * seconds;
  target.position = vec::add(target.position, vec::mul(newest.motion.velocity, ahead));
  target = turned(target, vec::mul(newest.motion.spin, ahead));
  const std::optional<DrivenPart> own = DrivenPart::find(simulation, tool_);
  if (!own) return {};  // parked, lifted or removed: it stays so
  if (grip_as_wanted(simulation, *own, newest.grip)) gripped_ = newest.grip == HandGrip::closed;
  target = own->within_reach(simulation, target, seconds);
  if (own->pose(simulation, simulation.time() + seconds) == target) return {};
  try {
    own->drive(simulation, target, seconds);
    driven_ = target;
    said_.clear();
    return {};
  } catch (const Error& error) {
    if (error.code() == ErrorCode::internal || error.code() == ErrorCode::device) throw;
    ++refused;
    if (std::exchange(said_, error.what()) == error.what()) return {};  // once is enough
    return error.what();
  }
}

void Instrument::after(const Simulation& simulation) {
  if (const std::int32_t wanted = wanted_rings.load(); wanted != 0) source_.set_rings(wanted);
  if (!buffers_) source_.fill_report(simulation, tissue.draft());
  if (buffers_) source_.fill(simulation, in_use.load(std::memory_order_acquire), tissue.draft());
  tissue.publish();
}

}  // namespace pliant::haptics
