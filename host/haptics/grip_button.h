// The button of a device that closes forceps.
#pragma once
#include <cstdint>

#include "haptics/driven_part.h"
#include "haptics/force_model.h"

namespace pliant::haptics {

/// A tool that can grip does so while the button is pressed. Before it is pressed for the first time, the scene and the program
/// alone decide.
class GripButton {
 public:
  /// `bit`: of DeviceSample::buttons; -1: none.
  explicit GripButton(int bit) : bit_(bit) {}
  HandGrip read(std::uint32_t buttons) noexcept {
    if (bit_ < 0) return HandGrip::unsaid;
    const bool pressed = (buttons >> bit_ & 1U) != 0;
    if (pressed || wanted_ != HandGrip::unsaid) wanted_ = pressed ? HandGrip::closed : HandGrip::open;
    return wanted_;
  }

 private:
  int bit_;
  HandGrip wanted_ = HandGrip::unsaid;
};

/// Makes the tool grip or let go, if it can grip and has not been told so. Returns whether it had to be told.
inline bool grip_as_wanted(Simulation& simulation, const DrivenPart& part, HandGrip wanted) {
  if (wanted == HandGrip::unsaid || part.is_blade()) return false;
  const bool closed = wanted == HandGrip::closed;
  const ContactTool& tool = simulation.contact().tools()[part.index()];
  const auto told = simulation.state().gripping.find(tool.name);
  if (!tool.grip || (told != simulation.state().gripping.end() && told->second == closed)) return false;
  simulation.tools().grip(std::string(tool.name), closed);
  return true;
}

}  // namespace pliant::haptics
