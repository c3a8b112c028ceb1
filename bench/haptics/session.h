// A haptic session in virtual time: the simulation at its frame rate, a force model at the haptic rate, the schedule as data.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "haptics/buffer_force.h"
#include "scene/scene.h"

namespace pliant::bench::haptics {

/// What the instrument does: poses over time [s].
using Stroke = std::function<Pose(double)>;

/// Forces on the instrument, at multiples of a period.
struct ForceTrace {
  double period = 0;           ///< [s]
  std::vector<Wrench> wrench;  ///< at period, 2 period, ...
};

struct SessionOptions {
  double frame_rate = 30;     ///< of the simulation [1/s]
  double haptic_rate = 1000;  ///< [1/s]
  double seconds = 1;
  double delay = 1;        ///< frames between the pose that a frame begins with and the arrival of its result
  std::int32_t rings = 2;  ///< of the buffer; negative: the whole body
  double stalled_from = 0, stalled_until = 0;  ///< no frame is made in between [s]
  double predict = 1;  ///< frames by which the simulation's tool is ahead of the last pose, at its speed
  double lead = 1;     ///< BufferForce
};

/// What a session cost, beside its forces.
struct SessionReport {
  ForceTrace felt;
  std::int64_t ticks = 0, built = 0, resets = 0, uncovered = 0;
  double tick_seconds = 0, worst_tick = 0;  ///< wall time of all ticks, of the longest [s]
  std::int64_t elements = 0, nodes = 0;     ///< of the largest buffer
  int substeps = 0;                         ///< of the last tick
};

/// The force on the scene's tool or blade `tool` of a simulation in which it follows the stroke in every step. `edit`: called
/// every `frame` seconds with the time; may be empty.
ForceTrace full_model(Scene scene, const std::string& tool, const Stroke& stroke, double seconds, double rate,
                      const std::function<void(Simulation&, double)>& edit = nullptr, double frame = 1.0 / 60);

/// What is tried in a session. Frames are numbered by slots that are used again when their turn comes.
struct SessionParts {
  std::function<void(Simulation&, double)> edit;       ///< before a frame; may be empty. Its end [s]
  std::function<void(Simulation&, std::size_t)> made;  ///< a frame has ended: keep in this slot what it says
  std::function<void(std::size_t)> arrived;            ///< the frame in this slot reaches the haptic thread
  std::function<Wrench(const Pose&, double)> tick;     ///< the instrument goes to a pose within a time [s]
};
/// Beside the ticks runs a simulation whose tool goes once per frame to where the instrument was.
SessionReport run_session(Scene scene, const std::string& tool, const Stroke& stroke, const SessionOptions& options,
                          const SessionParts& parts);

/// The same with the buffer model.
SessionReport with_buffer(Scene scene, const std::string& tool, const Stroke& stroke, const SessionOptions& options,
                          const std::function<void(Simulation&, double)>& edit = nullptr);

/// Differences of the forces [N] from `start` [s] on: largest and root mean square, and the largest and the root mean square of
/// `expected`.
struct ForceError {
  double most = 0, rms = 0, largest = 0, size = 0;
};
ForceError compare(const ForceTrace& felt, const ForceTrace& expected, double start = 0);

}  // namespace pliant::bench::haptics
