#include "backends/opencl/devices.h"

#include <stdlib.h>  // setenv is not in <cstdlib>

#include <algorithm>
#include <cstring>
#include <exception>

#include "backends/opencl/opencl_backend.h"
#include "backends/opencl/pocl_cache.h"

namespace pliant::opencl {
namespace {

/// Drivers pad their texts with blanks and a terminating zero.
std::string tidy(std::string text) {
  text.resize(std::strlen(text.c_str()));
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// PoCL's device that computes on the caller's thread: a launch costs it next to nothing.
bool is_single_thread(const cl::Device& device) { return device.getInfo<CL_DEVICE_NAME>().rfind("basic", 0) == 0; }

}  // namespace

std::vector<cl::Device> all_devices() {
  // PoCL lists the single-threaded device in addition to the one with a thread per core only on request; a value set by the
  // user has priority.
  setenv("POCL_DEVICES", "pthread basic", 0);
  std::vector<cl::Device> devices;
  std::vector<cl::Platform> platforms;
  try {
    cl::Platform::get(&platforms);
  } catch (const cl::Error&) {  // the loader has no platform
    return devices;
  }
  for (const cl::Platform& platform : platforms) {
    try {
      if (platform.getInfo<CL_PLATFORM_NAME>().rfind("Portable Computing Language", 0) == 0) ensure_pocl_cache();
      std::vector<cl::Device> own;
      platform.getDevices(CL_DEVICE_TYPE_ALL, &own);
      std::stable_partition(own.begin(), own.end(), [](const cl::Device& d) { return !is_single_thread(d); });
      devices.insert(devices.end(), own.begin(), own.end());
    } catch (const cl::Error&) {  // this platform has no device
    }
  }
  return devices;
}

BackendInfo describe_device(const cl::Device& device, int index) {
  BackendInfo info;
  info.name = "opencl:" + std::to_string(index);
  info.device = tidy(device.getInfo<CL_DEVICE_NAME>());
  const cl_device_type type = device.getInfo<CL_DEVICE_TYPE>();
  info.kind = (type & CL_DEVICE_TYPE_GPU) != 0 ? "gpu" : (type & CL_DEVICE_TYPE_CPU) != 0 ? "cpu" : "accelerator";
  info.platform = tidy(cl::Platform(device.getInfo<CL_DEVICE_PLATFORM>()).getInfo<CL_PLATFORM_NAME>());
  info.version = tidy(device.getInfo<CL_DEVICE_VERSION>());
  info.driver = tidy(device.getInfo<CL_DRIVER_VERSION>());
  info.memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
  info.max_buffer_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
  info.compute_units = static_cast<int>(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
  info.single_thread = is_single_thread(device);
  info.lanes = info.kind == "cpu" ? 16 : 1;
  return info;
}

std::string build_options(const cl::Device& device) {
  std::string options = "-cl-std=CL1.2 -w";  // PoCL would write to standard error how many warnings its compiler has
  // Without the capability the option is an error; the probe then finds out what divide and sqrt really give.
  if ((device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0) {
    options += " -cl-fp32-correctly-rounded-divide-sqrt";
  }
  return options;
}

}  // namespace pliant::opencl

namespace pliant {

bool opencl_is_built_in() { return true; }

std::string opencl_remark() { return opencl::pocl_cache_remark(); }

}  // namespace pliant
