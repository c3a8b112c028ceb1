// OpenCL context and programs that the backends of a process share on one device.
//
// PoCL preprocesses a kernel with Clang whenever a program is built, even if its disk cache has the compiled kernel: 50 to
// 100 ms each, a second or more for a scene. Backends on a processor therefore share one context, which lives as long as the
// process and keeps its programs. On other devices each backend has its own context, since a context holds device memory and
// a fault may make it unusable.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "backends/opencl/opencl.h"

namespace pliant::opencl {

class SharedContext {
 public:
  explicit SharedContext(const cl::Device& device) : context_(device) {}
  [[nodiscard]] const cl::Context& context() const { return context_; }

  /// Returns the program of this text and these options, built by `build` on first use. Thread-safe; exceptions of `build`
  /// propagate and nothing is stored.
  cl::Program program(const std::string& text, const std::string& options, const std::function<cl::Program()>& build);

 private:
  cl::Context context_;
  std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, cl::Program> programs_;  // by text and options
};

/// Returns the context of this device: on a processor the shared one, elsewhere a new one.
std::shared_ptr<SharedContext> context_of(const cl::Device& device);

/// Makes later backends use a new context. Called after OpenCL errors, which may have broken the old one.
void forget_contexts();

}  // namespace pliant::opencl
