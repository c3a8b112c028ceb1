#include "pliant/haptic_device.h"

namespace pliant {

HapticDevice::~HapticDevice() = default;

}  // namespace pliant
