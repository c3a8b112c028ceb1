// The backend that runs the kernels on an OpenCL device. The only header of this folder for the rest of Pliant; builds
// without OpenCL use host/opencl_absent instead.
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
  int local_size = 0;                  ///< work-group size, used if it divides the global size; 0: chosen per device
  bool probe = true;                   ///< run the known-answer probe when the device is opened
  std::uint64_t memory_bytes = 0;      ///< limit for a program; 0: the device's memory
  std::uint64_t max_buffer_bytes = 0;  ///< limit for one allocation; 0: the device's limit
  std::map<std::string, std::string> extra_kernels;  ///< file name to text, in addition to kernels/
};

/// Returns true if this build includes OpenCL. Without it there are no devices, and opening one throws an Error with
/// installation advice.
bool opencl_is_built_in();

/// Returns a remark on the devices found: that PoCL's kernel cache is not writable. Empty: none.
std::string opencl_remark();

/// Returns the number of kernels built for OpenCL devices in this process. Backends on a processor share built kernels.
std::int64_t opencl_programs_built();

/// Returns every device of every platform, in the order of opencl:N. With `probe` each is opened and probed; a device that
/// cannot be opened has the reason in tolerance_reason. Empty without a platform or loader; never throws.
std::vector<BackendInfo> list_opencl_devices(bool probe = true);

/// Opens device `index`. Throws Error if there is no such device, or if it cannot build or run the probe kernel.
std::unique_ptr<Backend> make_opencl_backend(int index, const OpenclOptions& options = {});

}  // namespace pliant
