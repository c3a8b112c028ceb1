// Free running of a World: options, state, events and force traces.
#pragma once
#include <cstdint>
#include <string>

#include "pliant/frame.h"
#include "pliant/wrench.h"

namespace pliant {

/// Options of World::run_live(). The worker makes a frame per period of `rate`, begun shortly after the caller fetches the one
/// before. A machine that cannot keep up gets frames of less simulated time at the same rate, so that time slows down evenly;
/// after a delay, such as a cut, time catches up with up to 0.25 s. What the worker does between two frames (World::save) or
/// rejects is reported by an Event. Each frame that it may be `ahead` hides one that takes a period more than others, such as
/// one that checks the step, and delays by a period what the display shows of a call.
struct LiveOptions {
  double rate = 60;  ///< frames per second of wall time, 1 to 1000
  double speed = 1;  ///< simulated seconds per second of wall time, 0.001 to 1000
  int ahead = 0;     ///< frames that the worker may be ahead of the display, 0 to 4
};

/// Performance of a World that runs freely.
struct LiveState {
  bool running = false;      ///< true between run_live() and stop_live(), also while a divergence holds it up
  std::int64_t frames = 0;   ///< number of frames made since run_live()
  std::int64_t late = 0;     ///< number of periods in which no frame was begun
  std::int64_t dropped = 0;  ///< number of frames that nobody fetched before the next one was ready
  double real_time = 0;      ///< simulated time over `speed` times wall time of the last second; 1: in time
  double load = 0;           ///< share of a period that a frame of full length takes; above 1: the machine is too slow
  double lost = 0;           ///< simulated time that was given up to stay at the rate [s]
};

/// Something that happened while a World ran.
struct Event {
  /// "cut", "opened", "pieces", "inverted", "calmed", "rolled_back", "deep", "passed", "gave_way", "limited", "slowed",
  /// "backend", "diverged", "refused", "failed", "saved", "loaded", "reset" or "recovered" (docs/embedding.md, Running freely).
  std::string kind;
  std::string subject;    ///< name of the body, tool or blade, id of the grab, or file; empty: the whole scene
  std::int64_t step = 0;  ///< number of steps since the start
  double time = 0;        ///< [s]
  bool placed = false;    ///< `position` is set
  Vec3d position{};       ///< where it happened [m]
  double amount = 0;      ///< how much: edges, pieces, elements, cells of depth, newtons, according to `kind`
  std::string text;       ///< a sentence for people
};

/// Contact force on a tool in one step, with the torque about its origin; or the force of a grab on the tissue in one of its
/// updates, with a torque of zero.
struct ForceSample : Wrench {
  std::int64_t step = 0;  ///< the step at whose end it acted, counted from the start
  double time = 0;        ///< [s]
};

}  // namespace pliant
