// What the backends of one process share on one device: the OpenCL context and the programs built in it.
//
// PoCL preprocesses a kernel with Clang whenever a program is built, also when its cache on disk has the compiled kernel: 50 to
// 100 ms each, a second or more for a scene. Backends on a processor therefore share one context, which stays for the life of
// the process and keeps its programs. On other devices a context holds memory of the device, and a fault of one may make it
// useless: there each backend has its own.
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

  /// The program of this text and these options, made by `build` where there is none yet. From any thread; what `build` throws
  /// is passed on, and nothing is kept.
  cl::Program program(const std::string& text, const std::string& options, const std::function<cl::Program()>& build);

 private:
  cl::Context context_;
  std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, cl::Program> programs_;  // by text and options
};

/// The context of this device: on a processor that of the backends before, elsewhere a new one.
std::shared_ptr<SharedContext> context_of(const cl::Device& device);

/// Backends that are opened from now on get a new context. Called when OpenCL reports an error: it may have broken the old one.
void forget_contexts();

}  // namespace pliant::opencl
