// Touch: a device drives a tool or a blade of a World and feels the force on it, at a rate of its own (docs/haptics.md).
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "pliant/export.h"
#include "pliant/haptic_device.h"
#include "pliant/world.h"

namespace pliant {

/// Options of a HapticLoop.
struct HapticOptions {
  double rate = 1000;          ///< ticks per second, 300 to 10000
  std::string model = "auto";  ///< what computes the force between two frames of the simulation: "buffer", the elements around
                               ///< the contact, integrated in the tick; "whole", all elements of the body; "auto", as much as
                               ///< fits into `share`; "held", the force of the last frame; "extrapolated", the line through the
                               ///< last two
  int rings = 3;               ///< "buffer": rings of elements around the nodes that the tool touches, 1 to 100
  double share = 0.3;          ///< "auto": share of a tick that the model may take, 0.01 to 0.9
  double predict = 1;          ///< frames by which the simulation's tool is ahead of the device, at its speed, 0 to 2
  double lead = 1;             ///< frames by which the buffer's rim is ahead of the simulation's last state, 0 to 2

  /// Virtual coupling between device and tool. 0: rigid, the tool is where the device is [N/m]
  double stiffness = 0;
  double damping = 0;         ///< of the coupling [N s/m]
  double turn_stiffness = 0;  ///< [N m/rad]; 0: 0.002 m^2 of `stiffness`
  double turn_damping = 0;    ///< [N m s/rad]

  bool passive = true;          ///< the device receives no more energy than it gave (Hannaford and Ryu 2002)
  double device_damping = 0.1;  ///< of the device itself, at least [N s/m]
  double stale_after = 0.25;    ///< age of the newest frame beyond which the force fades out [s]
  double ramp = 0.1;            ///< time of fading out, and in at the start [s]
  double greatest_force = 0;    ///< limit in addition to the device's own; 0: none [N]
  double greatest_torque = 0;   ///< [N m]

  bool align =
      true;  ///< where device and tool are at the start is the same place; false: the device speaks in scene coordinates
  double motion_scale = 1;  ///< way of the tool per way of the device
  double force_scale = 1;   ///< force on the hand per force on the tool
  int grip_button = 0;      ///< bit of the device's buttons that makes a tool with a `grip` hold tissue while it is pressed,
                            ///< from when it is first pressed on; -1: none
  bool realtime = true;     ///< request real-time priority; without permission the thread runs as others
  std::size_t log_samples = 0;  ///< number of device samples to keep for write_log(); 0: none
};

/// One tick.
struct HapticSample {
  std::int64_t tick = 0;  ///< number since the start, from 1
  double time = 0;        ///< wall time since the start [s]
  Vec3d device{};         ///< position of the device, in scene coordinates [m]
  Vec3d position{};       ///< of the tool's origin [m]
  Vec3d tissue{};         ///< force of the tissue on the tool [N]
  Vec3d force{};          ///< on the hand, in scene coordinates [N]
};

/// State of a loop.
struct HapticState {
  bool running = false;          ///< until stop()
  bool realtime = false;         ///< it got real-time priority
  std::string model;             ///< in use: "buffer", "whole", "held", "extrapolated"
  std::int64_t ticks = 0;        ///< so far
  std::int64_t late = 0;         ///< ticks that were left out because one before took too long
  double work_mean = 0;          ///< time of a tick's work: mean [s]
  double work_most = 0;          ///< largest [s]
  double work_p999 = 0;          ///< the 99.9th percentile [s]
  double delay_p999 = 0;         ///< how much later than planned ticks begin: the 99.9th percentile [s]
  double delay_most = 0;         ///< largest [s]
  std::int64_t frames = 0;       ///< received from the World
  double age = 0;                ///< of the newest one [s]
  int rings = 0;                 ///< of the buffer; -1: the whole body
  std::int64_t elements = 0;     ///< of the buffer; 0: nothing is near the tool
  int substeps = 0;              ///< of the buffer, in a tick
  std::int64_t buffers = 0;      ///< built so far
  std::int64_t resets = 0;       ///< buffers that diverged and restarted
  std::int64_t contacts = 0;     ///< points that touch
  std::int64_t stale = 0;        ///< ticks without a recent frame (docs/haptics.md, What protects the hand)
  std::int64_t limited = 0;      ///< ticks whose force was limited
  std::int64_t not_finite = 0;   ///< ticks whose force was no number, and became 0
  std::int64_t corrections = 0;  ///< ticks in which the force was reduced for passivity
  double energy = 0;             ///< of the device's accounts of motion and turns, the lesser one, with its allowance [J]
  double least_energy = 0;       ///< at least so far [J]
  std::int64_t refused = 0;      ///< poses that the World refused
  HapticSample last;             ///< the newest tick
};

/// Couples a device with a tool of a World, or with a blade that cuts by force, whose origin is the middle of its edge. Its
/// thread reads the device, computes the force and writes it, tick by tick; it never waits for steps, cuts or frames of the
/// World, allocates nothing and takes no lock. The World has to run, freely (World::run_live) or by advance(): each frame moves
/// the tool to the device's pose, and sends the loop the state of the tissue. The loop may live longer than the World: then the
/// force fades out. It takes a second of the World for a second of the hand: run the World at a speed of 1. Any thread may make
/// these calls, also while another does.
class PLIANT_API HapticLoop {
 public:
  /// Starts the thread. `tool`: name of a tool, or of a blade by force. `device` must not be null. Throws Error: usage (an
  /// unknown or parked tool, a blade that is nowhere, one that another loop drives, options out of range).
  HapticLoop(World& world, const std::string& tool, std::shared_ptr<HapticDevice> device, const HapticOptions& options = {});
  HapticLoop(const HapticLoop&) = delete;
  HapticLoop& operator=(const HapticLoop&) = delete;
  /// stop()
  ~HapticLoop();
  /// Ends the thread; the device gets a zero force, and the tool stays where it is.
  void stop() noexcept;
  /// Its current state.
  [[nodiscard]] HapticState state() const;
  /// Returns the samples of the ticks since the last call, oldest first. When 65536 wait, further ones are left out.
  std::vector<HapticSample> samples();
  /// Writes the device's samples as a stroke, which "file:" plays (docs/haptic_devices.md). Throws Error: state (without
  /// log_samples), io.
  void write_log(const std::string& file) const;

  struct PLIANT_HIDDEN Impl;  ///< implementation

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace pliant
