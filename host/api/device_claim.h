// A device drives one loop at a time: two would each take half of its samples and write over each other's forces.
#pragma once
#include "pliant/haptic_device.h"

namespace pliant::api {

class DeviceClaim {
 public:
  /// Throws Error (state) if the device has a claim already.
  explicit DeviceClaim(const HapticDevice* device);
  ~DeviceClaim() { release(); }
  DeviceClaim(const DeviceClaim&) = delete;
  DeviceClaim& operator=(const DeviceClaim&) = delete;
  void release() noexcept;

 private:
  const HapticDevice* device_;
};

}  // namespace pliant::api
