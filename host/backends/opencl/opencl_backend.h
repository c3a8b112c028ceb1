// The backend that runs the kernels on an OpenCL device. The only header of this folder that the rest of Pliant needs; a build
// without OpenCL has host/opencl_absent behind it.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "backends/interface/backend.h"

namespace pliant {

struct OpenclOptions {
  int lanes = 0;                       ///< indices per work-item, 1 or 16; 0: 16 on a CPU, 1 elsewhere
  int local_size = 0;                  ///< work-group size, used where it divides the global size; 0: chosen per device
  bool probe = true;                   ///< run the known-answer probe when the device is opened
  std::uint64_t memory_bytes = 0;      ///< 0: the device's memory; otherwise the most that a program may use
  std::uint64_t max_buffer_bytes = 0;  ///< 0: the device's limit for one allocation; otherwise a lower one
  std::map<std::string, std::string> extra_kernels;  ///< file name to text, in addition to kernels/
};

/// Whether this build has OpenCL. Without it there are no devices, and asking for one throws an Error that says what to
/// install.
bool opencl_is_built_in();

/// What a user should know about the devices that were found: that PoCL's cache of kernels cannot be written. Empty: nothing.
std::string opencl_remark();

/// How many kernels this process has built for OpenCL devices. On a processor a backend takes what another one has built.
std::int64_t opencl_programs_built();

/// Every device of every platform, in the order in which opencl:N counts them. With `probe` each is opened and probed; a device
/// that cannot be opened has the reason in tolerance_reason. Empty when there is no platform or no loader; never throws.
std::vector<BackendInfo> list_opencl_devices(bool probe = true);

/// Opens device `index`. Throws Error if there is no such device, or if it cannot build or run the probe kernel.
std::unique_ptr<Backend> make_opencl_backend(int index, const OpenclOptions& options = {});

}  // namespace pliant
