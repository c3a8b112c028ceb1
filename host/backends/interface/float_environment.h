// Sets the floating-point environment that the results depend on, regardless of the embedding program.
#pragma once
#include <cfenv>

namespace pliant {

/// While it lives: round to nearest, denormals kept, no traps. A program linked with -ffast-math, for example, starts with
/// denormals flushed to zero, and its threads inherit that.
class DefaultFloatEnvironment {
 public:
  DefaultFloatEnvironment() {
    std::fegetenv(&saved_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~DefaultFloatEnvironment() { std::fesetenv(&saved_); }
  DefaultFloatEnvironment(const DefaultFloatEnvironment&) = delete;
  DefaultFloatEnvironment& operator=(const DefaultFloatEnvironment&) = delete;

 private:
  std::fenv_t saved_{};
};

}  // namespace pliant
