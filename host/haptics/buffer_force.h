// The haptic thread's side of the buffer model.
#pragma once
#include <cstdint>

#include "haptics/buffer_source.h"

namespace pliant::haptics {

/// A ForceModel that ticks the newest buffer. It owns none: the BufferSource keeps what in_use() names.
class BufferForce final : public ForceModel {
 public:
  /// `settle`: time in which a buffer without a rim, of a whole body, comes back to the simulation [s]; 0: never. `lead`: how
  /// far the rim is ahead of the last state of the simulation, in frames: 0 follows the last two states (Mendoza and Laugier
  /// 2003) one frame late, 1 continues their motion.
  explicit BufferForce(double lead = 1, double settle = 0) : lead_(lead), settle_(settle) {}

  void receive(const FrameReport& /*report*/) noexcept override {}  // its messages hold more
  /// A message has come, `interval` [s] after the one before.
  void receive(const BufferMessage& message, double interval) noexcept;
  Wrench tick(const Pose& tool, double dt) noexcept override;
  /// What the hand wants of the tool in the next ticks.
  void grip(HandGrip wanted) noexcept { grip_ = wanted; }

  /// Generation of the buffer in use; older ones are no longer needed.
  [[nodiscard]] std::uint64_t in_use() const { return generation_; }
  [[nodiscard]] const BufferModel* buffer() const { return buffer_; }
  [[nodiscard]] std::uint64_t resets() const { return resets_; }  ///< times that a buffer diverged and restarted

 private:
  double lead_, settle_;
  BufferModel* buffer_ = nullptr;
  std::uint64_t generation_ = 0, resets_ = 0, ticks_ = 0;
  const TissueState* last_ = nullptr;
  std::int64_t run_ = 0;  ///< BufferMessage::run
  Pose pose_;
  bool placed_ = false;  ///< `pose_` is set
  HandGrip grip_ = HandGrip::unsaid;
};

}  // namespace pliant::haptics
