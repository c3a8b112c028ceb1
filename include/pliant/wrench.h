// A force and a torque on a rigid body: on a tool, a blade, an instrument, or the hand that holds a device.
#pragma once
#include <array>

namespace pliant {

using Vec3d = std::array<double, 3>;

/// What has a force on a tool or a hand derives from it or holds it: ToolForce, ForceSample, DeviceWrench.
struct Wrench {
  Vec3d force{};   ///< [N]
  Vec3d torque{};  ///< about the body's origin or the device's tip [N m]
};

}  // namespace pliant
