// Builds each distinct kernel (stem, defines, lanes) once, and reuses programs built by other backends of the process.
#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "backends/opencl/opencl.h"
#include "backends/opencl/shared_context.h"

namespace pliant::opencl {

using Files = std::map<std::string, std::string>;

/// Returns the text of `file` with its #include "x" lines replaced from `files`. Each included text has its own guard, so
/// that it counts once even if included conditionally. Throws Error (internal) with a missing file and the including one.
std::string resolve_includes(const Files& files, const std::string& file);

class KernelCache {
 public:
  /// `files`: kernels/ and additional files of tests; `device_name` is for messages.
  KernelCache(std::shared_ptr<SharedContext> context, cl::Device device, Files files, std::string device_name);

  /// Returns a new kernel object (arguments unset) of the program <stem>.cl. Throws Error with device, kernel, defines and
  /// the compiler's log.
  cl::Kernel make(const std::string& stem, const std::vector<std::pair<std::string, int>>& defines, int lanes);
  /// Builds that program. Thread-safe, beside make() too. Throws as make().
  cl::Program program(const std::string& stem, const std::vector<std::pair<std::string, int>>& defines, int lanes);

 private:
  [[nodiscard]] cl::Program build(const std::string& stem, const std::string& options) const;
  std::shared_ptr<SharedContext> context_;
  cl::Device device_;
  Files files_;
  std::string device_name_, common_options_;
  std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, cl::Program> programs_;  // by stem and options
};

}  // namespace pliant::opencl
