#include "api/device_claim.h"

#include <mutex>
#include <set>
#include <utility>

#include "pliant/error.h"

namespace pliant::api {
namespace {

std::mutex& claim_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// Guarded by claim_mutex().
std::set<const HapticDevice*>& claimed() {
  static std::set<const HapticDevice*> devices;
  return devices;
}

}  // namespace

DeviceClaim::DeviceClaim(const HapticDevice* device) : device_(device) {
  const std::lock_guard lock(claim_mutex());
  if (!claimed().insert(device).second)
    throw Error(ErrorCode::state, "haptics: this device drives another loop; stop() that one first, or open the device again");
}

void DeviceClaim::release() noexcept {
  const std::lock_guard lock(claim_mutex());
  if (device_ != nullptr) claimed().erase(std::exchange(device_, nullptr));
}

}  // namespace pliant::api
