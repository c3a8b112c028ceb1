// A C library that is loaded when a device needs it, so that libpliant does not.
#pragma once
#include <string>

namespace pliant::devices {

/// Stays loaded until the program ends. A missing library or function throws Error `bad_input`.
class DynamicLibrary {
 public:
  /// `file` as the dynamic linker finds it; `device` is the whole text of the device, for messages.
  DynamicLibrary(const std::string& file, const std::string& device);
  /// Finds `name` and gives it the type of `function`.
  template <class Function>
  void find(Function*& function, const char* name) const {
    function = reinterpret_cast<Function*>(symbol(name));
  }

 private:
  [[nodiscard]] void* symbol(const char* name) const;
  std::string file_, device_;
  void* handle_;
};

}  // namespace pliant::devices
