// Lists the OpenCL devices.
#pragma once
#include <string>
#include <vector>

#include "backends/interface/backend.h"
#include "backends/opencl/opencl.h"

namespace pliant::opencl {

/// Returns all devices of all platforms; empty (never an exception) if there are none.
std::vector<cl::Device> all_devices();

/// Returns everything except the result of the probe. `index` is the N of opencl:N.
BackendInfo describe_device(const cl::Device& device, int index);

/// Returns the build options for bit-exact arithmetic on this device (docs/determinism.md).
std::string build_options(const cl::Device& device);

}  // namespace pliant::opencl
