// Which OpenCL devices there are.
#pragma once
#include <string>
#include <vector>

#include "backends/interface/backend.h"
#include "backends/opencl/opencl.h"

namespace pliant::opencl {

/// All devices of all platforms; empty (never an exception) when there are none.
std::vector<cl::Device> all_devices();

/// Everything but the probe's verdict. `index` is the N of opencl:N.
BackendInfo describe_device(const cl::Device& device, int index);

/// The build options that the contract asks of this device (docs/determinism.md).
std::string build_options(const cl::Device& device);

}  // namespace pliant::opencl
