// The exception type of Pliant.
#pragma once
#include <stdexcept>
#include <string>

#include "pliant/export.h"

namespace pliant {

/// The kind of an error. The values 1 to 4 are also the exit codes of the `pliant` command. The C API uses the same numbers
/// as status codes.
enum class ErrorCode : int {
  internal = 1,       ///< a bug in Pliant
  bad_input = 2,      ///< an unusable file, scene, option or device
  input = bad_input,  ///< short name of bad_input
  difference = 3,     ///< `compare` found a difference between two backends
  diverged = 4,       ///< the simulation diverged
  usage = 5,          ///< an invalid call, whatever the scene: null pointer, index out of range, wrong buffer size
  io = 6,             ///< a file that is missing, cannot be read or cannot be written
  device = 7,         ///< the backend cannot be opened or failed during the run
  state = 8,  ///< a call that is invalid in the current state: destroyed world, two threads at once, interactive tools without
              ///< WorldOptions::interactive
};

/// Thrown while a scene is read, a model is built or a device is opened. A divergence during a step is reported in StepReport
/// and not thrown. The message states the error, its place, the value received and the values allowed.
class PLIANT_API Error : public std::runtime_error {
 public:
  /// There is deliberately no default code, so that a bug in Pliant is never reported as a user error.
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  /// The kind of the error.
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace pliant
