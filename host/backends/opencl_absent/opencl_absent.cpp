// Stands in for host/opencl in a build without OpenCL.
#include <fmt/format.h>

#include "backends/opencl/opencl_backend.h"
#include "pliant/error.h"

namespace pliant {

bool opencl_is_built_in() { return false; }

std::string opencl_remark() { return {}; }

std::int64_t opencl_programs_built() { return 0; }

std::vector<BackendInfo> list_opencl_devices(bool) { return {}; }

std::unique_ptr<Backend> make_opencl_backend(int index, const OpenclOptions&) {
  throw Error(
      ErrorCode::bad_input,
      fmt::format("opencl:{} is not available: this build of Pliant has no OpenCL. Install the headers and the loader (Debian: "
                  "apt install "
                  "opencl-headers opencl-clhpp-headers ocl-icd-opencl-dev) and configure again, or use the backend \"cpu\"",
                  index));
}

}  // namespace pliant
