// The choice of a backend by name. The only room that knows them all.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "backends/interface/backend.h"

namespace pliant {

/// Every backend of this machine for work: "cpu", "cpu:double", "opencl:0", ... Each is opened and probed. Never throws; a
/// backend that cannot be opened has the reason in tolerance_reason.
std::vector<BackendInfo> list_backends();

/// `spec` is auto, cpu, cpu:double, cpu:check, opencl or opencl:N (opencl means opencl:0). auto takes a bit-exact GPU, else a
/// bit-exact OpenCL device of another kind (a processor first), else cpu; `why`, if given, receives which one and why. On a
/// processor a scene of few `nodes` (0: unknown) gets the device without threads, if there is one: launches would cost more
/// than a second core gives. Throws Error for any other spec, and where the backend asked for does not exist: it says what is
/// missing.
std::unique_ptr<Backend> open_backend(const std::string& spec, std::string* why = nullptr, std::int64_t nodes = 0);

}  // namespace pliant
