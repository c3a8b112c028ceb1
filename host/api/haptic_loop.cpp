// HapticLoop: the thread of a device, and its tool's place in a World.
#include <mutex>
#include <optional>

#include "api/device_claim.h"
#include "api/haptic_options.h"
#include "api/haptic_thread.h"
#include "api/world_call.h"
#include "devices/device_log.h"
#include "devices/limits.h"
#include "pliant/haptics.h"

namespace pliant {
struct HapticLoop::Impl {
  std::optional<api::DeviceClaim> claim;  ///< ends after the thread
  std::unique_ptr<api::HapticThread> thread;
  mutable std::mutex mutex;  ///< of the callers of state(), samples() and stop()
  std::shared_ptr<devices::DeviceLog> log;
};

HapticLoop::HapticLoop(World& world, const std::string& tool, std::shared_ptr<HapticDevice> device,
                       const HapticOptions& options)
    : impl_(std::make_unique<Impl>()) {
  api::check_options(options);
  if (device == nullptr) throw Error(ErrorCode::usage, "haptics: the device is null");
  const DeviceLimits limits = device->limits();
  devices::check_limits(limits);
  const HapticDevice* const driver = device.get();
  if (options.log_samples > 0) {
    impl_->log = std::make_shared<devices::DeviceLog>(options.log_samples);
    device = std::make_shared<devices::RecordedDevice>(std::move(device), impl_->log);
  }
  const std::int32_t rings = options.model == "whole" ? -1 : options.rings;
  const bool buffers = options.model != "held" && options.model != "extrapolated";
  auto instrument = std::make_shared<haptics::Instrument>(tool, rings, options.predict, buffers);
  const Pose start = WorldAccess::attach(world, instrument);
  const haptics::CoreOptions core = api::core_options(options, limits);
  try {
    impl_->claim.emplace(driver);
    impl_->thread = std::make_unique<api::HapticThread>(instrument, std::move(device), options, core, start);
  } catch (...) {
    instrument->closed = true;
    throw;
  }
}

HapticLoop::~HapticLoop() = default;

void HapticLoop::stop() noexcept {
  const std::lock_guard lock(impl_->mutex);
  impl_->thread->stop();
  impl_->claim->release();
}

HapticState HapticLoop::state() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->thread->state();
}

std::vector<HapticSample> HapticLoop::samples() {
  const std::lock_guard lock(impl_->mutex);
  return impl_->thread->samples();
}

void HapticLoop::write_log(const std::string& file) const {
  if (impl_->log == nullptr)
    throw Error(ErrorCode::state,
                "write_log: this loop keeps no log; HapticOptions::log_samples says how many samples to keep");
  impl_->log->write_csv(file);
}

}  // namespace pliant
