#include "devices/dynamic_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "pliant/error.h"

namespace pliant::devices {

DynamicLibrary::DynamicLibrary(const std::string& file, const std::string& device)
    : file_(file), device_(device), handle_(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
  if (handle_ == nullptr) {
    throw Error(ErrorCode::bad_input, fmt::format("haptic device \"{}\": it needs {}, which is not installed", device, file));
  }
}

void* DynamicLibrary::symbol(const char* name) const {
  void* found = dlsym(handle_, name);
  if (found == nullptr) {
    throw Error(ErrorCode::bad_input, fmt::format("haptic device \"{}\": {} has no function {}", device_, file_, name));
  }
  return found;
}

}  // namespace pliant::devices
