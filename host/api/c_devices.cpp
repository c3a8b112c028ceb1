// Haptic devices of the C API.
#include <algorithm>
#include <cstring>

#include "api/c_call.h"
#include "devices/counter.h"
#include "devices/limits.h"
#include "geometry/wrench.h"

namespace {

using namespace pliant::api;
using pliant::DeviceLimits;
using pliant::DeviceSample;
using pliant::DeviceWrench;

/// A struct that callbacks of a program with newer headers may read and write: the members that only they know are 0.
template <class T>
union Roomy {
  explicit Roomy(const T& value) : room{} { known = value; }
  T known;
  unsigned char room[kLargestStruct];
};

pliant_device_wrench c_wrench(const DeviceWrench& given) {
  pliant_device_wrench wrench = PLIANT_DEVICE_WRENCH_INIT;
  copy_wrench(given, wrench);
  wrench.time = given.time;
  wrench.number = given.number;
  return wrench;
}

/// A device that asks a C program.
class CallbackDevice final : public pliant::HapticDevice {
 public:
  CallbackDevice(const pliant_device_callbacks& callbacks, const DeviceLimits& limits)
      : callbacks_(callbacks), limits_(limits), sample_(PLIANT_DEVICE_SAMPLE_INIT), wrench_(PLIANT_DEVICE_WRENCH_INIT) {}
  ~CallbackDevice() override {
    if (callbacks_.release != nullptr) callbacks_.release(callbacks_.user);
  }
  DeviceSample read() noexcept override {
    pliant_device_sample& told = sample_.known;
    told.size = sizeof told;
    callbacks_.read(callbacks_.user, &told);
    if (told.number == seen_) return newest_;
    seen_ = told.number;
    DeviceSample sample{{told.position[0], told.position[1], told.position[2]},
                        {told.turn[0], told.turn[1], told.turn[2], told.turn[3]},
                        told.time,
                        told.buttons,
                        told.number};
    if (const pliant::devices::Refusal why = pliant::devices::check_sample(sample); why != nullptr) {
      counter_.refuse(why);
      return newest_;
    }
    counter_.receive();
    newest_ = sample;
    return newest_;
  }
  void write(const DeviceWrench& wrench) noexcept override {
    if (callbacks_.write == nullptr) return;
    wrench_.known = c_wrench(wrench);
    callbacks_.write(callbacks_.user, &wrench_.known);
  }
  [[nodiscard]] DeviceLimits limits() const noexcept override { return limits_; }
  [[nodiscard]] pliant::DeviceCounts counts() const override { return counter_.counts(); }

 private:
  const pliant_device_callbacks callbacks_;
  const DeviceLimits limits_;
  pliant::devices::Counter counter_;
  Roomy<pliant_device_sample> sample_;
  Roomy<pliant_device_wrench> wrench_;
  std::uint64_t seen_ = 0;
  DeviceSample newest_;
};

DeviceLimits limits_of(const pliant_device_limits* given) {
  if (given == nullptr) return {};
  const pliant_device_limits limits = take_struct<pliant_device_limits>(*given, PLIANT_DEVICE_LIMITS_INIT);
  const DeviceLimits checked{limits.force, limits.torque};
  pliant::devices::check_limits(checked);
  return checked;
}

/// `make` returns the device whose handle `out` receives.
template <class Make>
pliant_status make_device(pliant_haptic_device* out, Make&& make) noexcept {
  return guarded([&] {
    need(out, "out");
    out->id = 0;
    out->id = Handles::devices().add(std::make_shared<CDevice>(make()));
  });
}

template <class Call>
pliant_status on_device(pliant_haptic_device device, Call&& call) noexcept {
  return guarded([&] {
    const auto held = Handles::devices().find(device.id);
    call(*held);
  });
}

pliant::ManualDevice& manual(const CDevice& of) {
  if (auto* const found = dynamic_cast<pliant::ManualDevice*>(of.device.get()); found != nullptr) return *found;
  throw pliant::Error(pliant::ErrorCode::usage, "this device was not made by pliant_manual_device_create");
}

}  // namespace

pliant_status pliant_haptic_device_open(const char* text, pliant_haptic_device* out) {
  return make_device(out, [&] {
    need(text, "text");
    return pliant::open_haptic_device(text);
  });
}

pliant_status pliant_haptic_device_create(const pliant_device_callbacks* callbacks, const pliant_device_limits* limits,
                                          pliant_haptic_device* out) {
  return make_device(out, [&] {
    need(callbacks, "callbacks");
    const pliant_device_callbacks given = take_struct<pliant_device_callbacks>(*callbacks, PLIANT_DEVICE_CALLBACKS_INIT);
    need(reinterpret_cast<const void*>(given.read), "read");
    return std::make_shared<CallbackDevice>(given, limits_of(limits));
  });
}

pliant_status pliant_manual_device_create(const pliant_device_limits* limits, pliant_haptic_device* out) {
  return make_device(out, [&] { return std::make_shared<pliant::ManualDevice>(limits_of(limits)); });
}

pliant_status pliant_haptic_device_destroy(pliant_haptic_device device) {
  return guarded([&] { Handles::devices().remove(device.id); });
}

pliant_status pliant_haptic_device_counts(pliant_haptic_device device, pliant_device_counts* out) {
  return on_device(device, [&](CDevice& d) {
    need(out, "out");
    check_struct(out);
    const pliant::DeviceCounts counts = d.device->counts();
    const std::lock_guard lock(d.mutex);
    const char* const why = d.texts.insert(counts.last_refusal).first->c_str();
    give_struct<pliant_device_counts>({0, counts.received, counts.refused, why}, out);
  });
}

pliant_status pliant_haptic_device_limits(pliant_haptic_device device, pliant_device_limits* out) {
  return on_device(device, [&](CDevice& d) {
    need(out, "out");
    check_struct(out);
    const DeviceLimits limits = d.device->limits();
    give_struct<pliant_device_limits>({0, limits.force, limits.torque}, out);
  });
}

pliant_status pliant_haptic_device_port(pliant_haptic_device device, int* out) {
  return on_device(device, [&](CDevice& d) {
    need(out, "out");
    *out = d.device->port();
  });
}

pliant_status pliant_manual_device_set_pose(pliant_haptic_device device, const double position[3], const double turn[4],
                                            uint32_t buttons) {
  return on_device(device, [&](CDevice& d) {
    need(turn, "turn");
    manual(d).set_pose(vector_of(position, "position"), {turn[0], turn[1], turn[2], turn[3]}, buttons);
  });
}

pliant_status pliant_manual_device_wrench(pliant_haptic_device device, pliant_device_wrench* out) {
  return on_device(device, [&](CDevice& d) {
    need(out, "out");
    check_struct(out);
    give_struct(c_wrench(manual(d).wrench()), out);
  });
}
