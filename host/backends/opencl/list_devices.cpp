#include <fmt/format.h>

#include <exception>

#include "backends/opencl/devices.h"
#include "backends/opencl/opencl_backend.h"

namespace pliant {

std::vector<BackendInfo> list_opencl_devices(bool probe) {
  std::vector<BackendInfo> result;
  int index = 0;
  for (const cl::Device& device : opencl::all_devices()) {
    BackendInfo info;
    info.name = fmt::format("opencl:{}", index);
    try {
      info = opencl::describe_device(device, index);
      info.tolerance_reason = "not probed";
      if (probe) info = make_opencl_backend(index)->info();
    } catch (const std::exception& error) {
      info.tolerance_reason = error.what();
    }
    result.push_back(info);
    ++index;
  }
  return result;
}

}  // namespace pliant
