#include "backends/opencl/shared_context.h"

#include <atomic>

#include "backends/opencl/opencl_backend.h"

namespace pliant::opencl {
namespace {

// A program is some 100 kB; what a process needs again and again is fewer than this.
constexpr std::size_t kMostPrograms = 512;

std::atomic<std::int64_t> builds{0};

struct Contexts {
  std::mutex mutex;
  std::map<cl_device_id, std::shared_ptr<SharedContext>> of_device;
};

// Never destroyed: at the end of the process the driver may be gone before us.
Contexts& contexts() {
  static auto* const all = new Contexts;
  return *all;
}

}  // namespace

cl::Program SharedContext::program(const std::string& text, const std::string& options,
                                   const std::function<cl::Program()>& build) {
  const auto key = std::make_pair(text, options);
  {
    const std::lock_guard lock(mutex_);
    if (const auto known = programs_.find(key); known != programs_.end()) return known->second;
  }
  cl::Program made = build();  // without the lock: it takes long, and two threads that build the same do no harm
  ++builds;
  const std::lock_guard lock(mutex_);
  if (programs_.size() >= kMostPrograms) programs_.clear();  // backends hold on to theirs
  return programs_.emplace(key, std::move(made)).first->second;
}

std::shared_ptr<SharedContext> context_of(const cl::Device& device) {
  if ((device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU) == 0) return std::make_shared<SharedContext>(device);
  const std::lock_guard lock(contexts().mutex);
  auto& shared = contexts().of_device[device()];
  if (shared == nullptr) shared = std::make_shared<SharedContext>(device);
  return shared;
}

void forget_contexts() {
  const std::lock_guard lock(contexts().mutex);
  contexts().of_device.clear();
}

}  // namespace pliant::opencl

std::int64_t pliant::opencl_programs_built() { return opencl::builds; }
