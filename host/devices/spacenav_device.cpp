#include "devices/spacenav_device.h"

#include <fmt/format.h>

#include "devices/mouse_motion.h"
#include "pliant/error.h"

#ifndef PLIANT_SPNAV_LIBRARY

namespace pliant::devices {

std::shared_ptr<HapticDevice> open_spacenav(const std::string& rest, const std::string& text) {
  parse_speeds(rest, text);
  throw Error(ErrorCode::bad_input, fmt::format("haptic device \"{}\": this build has no 3D mouse (libspnav)", text));
}

}  // namespace pliant::devices

#else

#include <poll.h>
#include <spnav.h>

#include <algorithm>
#include <atomic>
#include <ctime>

#include "devices/dynamic_library.h"
#include "devices/threaded_device.h"

namespace pliant::devices {
namespace {

constexpr int kTick = 2;  ///< between two samples [ms]

/// What is called of the library.
struct Spnav {
  explicit Spnav(const std::string& device) {
    const DynamicLibrary library(PLIANT_SPNAV_LIBRARY, device);
    library.find(open, "spnav_open");
    library.find(close, "spnav_close");
    library.find(handle, "spnav_fd");
    library.find(poll_event, "spnav_poll_event");
  }
  decltype(spnav_open)* open;
  decltype(spnav_close)* close;
  decltype(spnav_fd)* handle;
  decltype(spnav_poll_event)* poll_event;
};

std::atomic<bool> g_spacenav_open{false};

class SpacenavDevice final : public ThreadedDevice {
 public:
  SpacenavDevice(const MouseSpeeds& speeds, const std::string& text) : speeds_(speeds), library_(text) {
    if (g_spacenav_open.exchange(true)) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("haptic device \"{}\": a 3D mouse is open already; there can be one", text));
    }
    if (library_.open() != 0) {
      g_spacenav_open.store(false);
      throw Error(ErrorCode::bad_input,
                  fmt::format("haptic device \"{}\": cannot reach spacenavd, the daemon of 3D mice", text));
    }
    start();
  }
  ~SpacenavDevice() override {
    stop();
    library_.close();
    g_spacenav_open.store(false);
  }
  [[nodiscard]] DeviceLimits limits() const noexcept override { return {0, 0}; }

 private:
  void serve() override;

  void take_event(pollfd& waiting);

  MouseSpeeds speeds_;
  Spnav library_;
  DeviceSample pose_;
  CapAxes cap_{};
};

void SpacenavDevice::take_event(pollfd& waiting) {
  if ((waiting.revents & (POLLHUP | POLLERR)) != 0) {
    waiting.fd = -1;
    cap_ = {};
    refuse("spacenavd has gone");
    return;
  }
  spnav_event event;
  const int kind = library_.poll_event(&event);
  if (kind == SPNAV_EVENT_MOTION) {
    cap_ = {event.motion.x, event.motion.y, event.motion.z, event.motion.rx, event.motion.ry, event.motion.rz};
  } else if (kind == SPNAV_EVENT_BUTTON) {
    press_button(pose_, event.button.bnum, event.button.press != 0);
  }
}

void SpacenavDevice::serve() {
  double before = elapsed();
  pollfd waiting{library_.handle(), POLLIN, 0};
  for (double next = before; !stopping(); next += 1e-3 * kTick) {
    double rest = 0;
    while ((rest = next - elapsed()) > 0 && !stopping()) {  // events come at any time, samples at each tick
      const timespec most{0, static_cast<long>(1e9 * std::min(rest, 0.1))};
      if (ppoll(&waiting, 1, &most, nullptr) > 0) take_event(waiting);
    }
    const double now = elapsed();
    move_pose(pose_, cap_, now - before, speeds_);
    before = now;
    if (now - next > 0.1) next = now;
    pose_.time = now;
    publish(pose_);
  }
}

}  // namespace

std::shared_ptr<HapticDevice> open_spacenav(const std::string& rest, const std::string& text) {
  return std::make_shared<SpacenavDevice>(parse_speeds(rest, text), text);
}

}  // namespace pliant::devices

#endif
