// A simulation whose clock is that of devices: it waits for each sample, goes on to the sample's time and answers it.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptics/drive_log.h"
#include "haptics/grip_button.h"
#include "haptics/run_guide.h"
#include "haptics/safety.h"
#include "pliant/haptic_device.h"

namespace pliant::haptics {

/// A device and the tool that it drives.
struct HeldTool {
  std::string tool;
  std::shared_ptr<HapticDevice> device;
};

struct LockstepOptions {
  double rate = 1000;                              ///< samples per second of a device that dates none [1/s]
  double patience = 5;                             ///< a device that says nothing for longer has ended [s]
  std::function<bool()> stop;                      ///< ends the waiting; may be empty
  std::function<void(const std::string&)> remark;  ///< receives messages for people; may be empty
};

/// Of one device.
struct LockstepCounts {
  std::int64_t samples = 0;  ///< that the run went to
  std::int64_t falling = 0;  ///< refused: their time did not rise
  std::int64_t missed = 0;   ///< replaced by newer ones before they were read
  std::int64_t limited = 0;  ///< poses too far for their time, towards which the tool went as fast as it may
  std::int64_t refused = 0;  ///< poses that the simulation refused
  double largest_force = 0;  ///< on the hand [N]
};

/// The first sample of a device is where its tool is when the run begins, and at that time. From there the tool goes on a
/// straight line from sample to sample. When the run has come to a sample's time, to the whole steps before it, the device gets
/// the force of the last step; then its next sample is waited for. A sample that is not later than the one before is answered
/// by the same force and moves nothing. With several devices, the run goes to whichever sample comes first. A recorded stroke
/// goes from sample to sample without waiting (StrokeDevice::step_by_answers).
class Lockstep final : public RunGuide {
 public:
  /// The tools must be there and not parked. `log` gets every drive, and must outlive this.
  Lockstep(const Simulation& simulation, const std::vector<HeldTool>& tools, LockstepOptions options, DriveLog& log);
  [[nodiscard]] std::int64_t steps_left(const Simulation& simulation) const override;
  bool next(Simulation& simulation) override;
  /// Answers the samples that are under way without any force.
  void release() noexcept;
  [[nodiscard]] const LockstepCounts& counts(std::size_t tool) const { return hands_[tool].counts; }

 private:
  struct Hand {
    HeldTool held;
    ForceGuard guard;
    GripButton button{0};
    Pose tool_start, device_start;
    std::optional<DeviceSample> first, sample;  ///< sample: the one under way
    std::uint64_t seen = 0;                     ///< number of the last sample
    bool dated = false;                         ///< a sample said its time
    double time = 0;                            ///< of `sample`, on the scene's clock [s]
    double period = 0;                          ///< from the sample before to it [s]
    bool open = false, over = false;            ///< the sample has no answer yet; the device has ended
    DeviceWrench answer;
    LockstepCounts counts;
  };
  bool accepted(Simulation& simulation);
  void answer(Hand& hand, const Simulation& simulation);
  void await(Hand& hand, Simulation& simulation);
  bool take(Hand& hand, const DeviceSample& sample, Simulation& simulation);
  [[nodiscard]] double time_of(Hand& hand, const DeviceSample& sample) const;
  void drive(Hand& hand, const Pose& target, Simulation& simulation);
  void remark(const std::string& text) const;

  LockstepOptions options_;
  DriveLog& log_;
  std::vector<Hand> hands_;
  double begin_, target_;  ///< on the scene's clock [s]
  bool stopped_ = false;
};

}  // namespace pliant::haptics
