// A tool of a simulation that a device drives: the data that the stepping thread and the haptic thread exchange.
#pragma once
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "devices/mailbox.h"
#include "haptics/buffer_source.h"
#include "haptics/motion.h"

namespace pliant::haptics {

/// Where the device takes the instrument.
struct InstrumentPose {
  Pose pose;
  Motion motion;
  HandGrip grip = HandGrip::unsaid;
  bool given = false;  ///< false: the device has said nothing yet
};

class Instrument {
 public:
  /// `predict`: frames by which the simulation's tool is ahead of the device. `first_rings`: see BufferSource.
  /// `buffers`: false if nobody ticks them.
  Instrument(std::string tool, std::int32_t first_rings, double predict, bool buffers = true)
      : tool_(std::move(tool)), predict_(predict), source_(tool_, first_rings), buffers_(buffers) {}
  [[nodiscard]] const std::string& tool() const { return tool_; }

  // For the stepping thread.

  /// Call before a frame of `seconds`: drives the tool to where the device will be. Returns why the simulation refuses it.
  std::optional<std::string> before(Simulation& simulation, double seconds);
  /// Where the last before() has driven the tool; empty: it has not.
  [[nodiscard]] const std::optional<Pose>& driven() const { return driven_; }
  /// What it told the tool: to grip, or to let go; empty: nothing.
  [[nodiscard]] const std::optional<bool>& gripped() const { return gripped_; }
  /// Call after it: sends the state of the tissue.
  void after(const Simulation& simulation);

  // For the haptic thread.
  devices::Mailbox<InstrumentPose> hand;   ///< to the simulation
  devices::Mailbox<BufferMessage> tissue;  ///< from the simulation
  std::atomic<std::uint64_t> in_use{0};    ///< generation of the buffer that the haptic thread uses

  std::atomic<bool> closed{false};            ///< the loop has ended
  std::atomic<std::int64_t> refused{0};       ///< poses that the simulation refused
  std::atomic<std::int32_t> wanted_rings{0};  ///< wanted; 0: as constructed

 private:
  std::string tool_;
  double predict_;
  BufferSource source_;
  bool buffers_;
  std::optional<Pose> driven_;
  std::optional<bool> gripped_;
  std::string said_;  ///< why the last pose was refused
};

}  // namespace pliant::haptics
