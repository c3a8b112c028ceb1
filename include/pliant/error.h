// The one exception type of Pliant.
#pragma once
#include <stdexcept>
#include <string>

#include "pliant/export.h"

namespace pliant {

/// What went wrong. The values 1 to 4 are exit codes of the `pliant` command; the same numbers are the status codes of the C
/// API.
enum class ErrorCode : int {
  internal = 1,       ///< a defect of Pliant itself
  bad_input = 2,      ///< a file, scene, option or device that cannot be used as given
  input = bad_input,  ///< the same by its shorter name
  difference = 3,     ///< `compare` found two backends that differ
  diverged = 4,       ///< the simulation left the range in which it means anything
  usage = 5,   ///< a call that is wrong whatever the scene: a null pointer, an index out of range, a buffer of the wrong size
  io = 6,      ///< a file that is missing, cannot be read or cannot be written
  device = 7,  ///< the backend cannot be opened, or was lost while it worked
  state = 8,   ///< a call that does not fit the present state: a destroyed world, two threads at once, forces where none were
               ///< reserved
};

/// Thrown while a scene is read, a model is built or a device is opened; a time step reports and does not throw.
/// The message says what is wrong, where, what was received and what is allowed.
class PLIANT_API Error : public std::runtime_error {
 public:
  /// There is no default code: a defect of Pliant must not pass for the user's mistake.
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  /// What kind of error it is.
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace pliant
