// The one exception type of Pliant.
#pragma once
#include <stdexcept>
#include <string>

namespace pliant {

/// What went wrong; the value is the exit code of the `pliant` command.
enum class ErrorCode : int {
  internal = 1,    ///< a defect of Pliant itself
  bad_input = 2,   ///< a file, scene, option or device that cannot be used as given
  difference = 3,  ///< `compare` found two backends that differ
  diverged = 4,    ///< the simulation left the range in which it means anything
};

/// Thrown while a scene is read, a model is built or a device is opened; a time step reports and does not throw.
/// The message says what is wrong, where, what was received and what is allowed.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  /// Bad input is by far the most frequent reason.
  explicit Error(const std::string& message) : Error(ErrorCode::bad_input, message) {}
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace pliant
