// Opens backends by name. The only room that includes all of them.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "backends/interface/backend.h"

namespace pliant {

/// Returns all backends of this machine: "cpu", "cpu:double", "opencl:0", ... Each is opened and probed. Never throws; a
/// backend that cannot be opened has the reason in tolerance_reason.
std::vector<BackendInfo> list_backends();

/// What a backend is for.
enum class BackendUse {
  any,
  once,  ///< one run in a process of its own
  live   ///< somebody watches: no call may wait for a compiler
};

/// Opens the backend `spec`: auto, cpu, cpu:double, cpu:check, opencl or opencl:N (opencl means opencl:0). auto selects a
/// bit-exact GPU, otherwise another bit-exact OpenCL device (processors first), otherwise cpu; `why` (may be null) receives
/// the choice and the reason. On a processor, scenes with few `nodes` (0: unknown) use a device without threads, if
/// available, because launches would cost more than a second core gains. There auto compiles nothing before it computes: `once`
/// uses cpu for scenes with few nodes, and `live` lets cpu compute until the kernels are compiled (tiered_backend.h). Throws
/// Error for any other spec and for a missing backend, with what is missing.
std::unique_ptr<Backend> open_backend(const std::string& spec, std::string* why = nullptr, std::int64_t nodes = 0,
                                      BackendUse use = BackendUse::any);

}  // namespace pliant
