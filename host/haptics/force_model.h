// Computes the force on an instrument at the haptic rate from the reports of the simulation, which come at a lower rate.
#pragma once
#include <cstdint>

#include "pliant/wrench.h"
#include "scene/contact_tool.h"

namespace pliant::haptics {

/// The simulation's report on an instrument after each frame.
struct FrameReport {
  double time = 0;            ///< simulated time of its last step [s]
  double period = 0;          ///< simulated time since the report before [s]
  Pose tool;                  ///< at `time`
  Wrench mean;                ///< on the instrument, over the steps of the last batch of the frame
  Wrench last;                ///< in its last step
  std::int64_t topology = 0;  ///< number of edits that changed elements
  std::uint64_t number = 0;   ///< number of reports so far
};

/// What a hand wants of a tool that can grip. `unsaid`: the scene and the program alone decide.
enum class HandGrip : std::uint8_t { unsaid, open, closed };

/// Both calls come from the haptic thread: they neither allocate nor wait.
class ForceModel {
 public:
  ForceModel() = default;
  ForceModel(const ForceModel&) = delete;
  ForceModel& operator=(const ForceModel&) = delete;
  virtual ~ForceModel() = default;
  /// A new report has come.
  virtual void receive(const FrameReport& report) noexcept = 0;
  /// Advances by `dt` [s], during which the instrument moves to `tool`. Returns the wrench on it.
  virtual Wrench tick(const Pose& tool, double dt) noexcept = 0;
};

}  // namespace pliant::haptics
