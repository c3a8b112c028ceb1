// Builds kernels, each distinct (stem, defines, lanes) once; what another backend of the process has built is taken from there.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "backends/opencl/opencl.h"
#include "backends/opencl/shared_context.h"

namespace pliant::opencl {

using Files = std::map<std::string, std::string>;

/// The text of `file` with its #include "x" lines replaced from `files`. Every included text carries its own guard, so that it
/// counts once also when it is included under a condition. Throws Error (internal) that names a missing file and who wants it.
std::string resolve_includes(const Files& files, const std::string& file);

class KernelCache {
 public:
  /// `files` is kernels/ and whatever a test adds; `device_name` is for messages.
  KernelCache(std::shared_ptr<SharedContext> context, cl::Device device, Files files, std::string device_name);

  /// A new kernel object (arguments unset) of the program <stem>.cl. Throws Error with device, kernel, defines and the
  /// compiler's log.
  cl::Kernel make(const std::string& stem, const std::vector<std::pair<std::string, int>>& defines, int lanes);

 private:
  cl::Program build(const std::string& stem, const std::string& options);
  std::shared_ptr<SharedContext> context_;
  cl::Device device_;
  Files files_;
  std::string device_name_, common_options_;
  std::map<std::pair<std::string, std::string>, cl::Program> programs_;  // by stem and options
};

}  // namespace pliant::opencl
