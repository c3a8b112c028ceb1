// Hands that hold tools of a random scene, in virtual time: each moves about as it likes, and feels what it meets.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "haptics/hand.h"
#include "haptics/haptic_core.h"

namespace pliant::bench {

/// What the hands met.
struct LiveFindings {
  std::int64_t ticks = 0, poses_refused = 0, buffers = 0;
  std::int64_t not_finite = 0, above_limit = 0;  ///< ticks in which the force on a hand was so
  double largest_force = 0;                      ///< on a hand [N]
  double least_energy = 0;                       ///< of the accounts of all devices, with the allowance [J]
  /// What must not be; empty: all is well.
  [[nodiscard]] std::string fault() const;
};

class LiveTools {
 public:
  /// Draws which tools of scene `number` are in a hand, and where the hands go in `seconds` [s]: none, or one or two.
  LiveTools(std::int64_t number, const Simulation& simulation, double seconds);
  [[nodiscard]] std::size_t count() const { return hands_.size(); }
  /// A frame: drives the tools, steps to its end, and lets the hands feel it.
  void frame(Simulation& simulation, double seconds);
  [[nodiscard]] const LiveFindings& findings() const { return findings_; }

 private:
  struct Hand {
    std::unique_ptr<pliant::haptics::Instrument> instrument;
    std::unique_ptr<pliant::haptics::SimulatedHand> device;
    std::unique_ptr<pliant::haptics::HapticCore> core;
  };
  void feel(Hand& hand, double seconds, bool first);

  std::vector<Hand> hands_;
  LiveFindings findings_;
  double owed_ = 0;  ///< of ticks [s]
};

}  // namespace pliant::bench
