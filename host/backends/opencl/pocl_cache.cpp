#include "backends/opencl/pocl_cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>  // setenv and mkdtemp are not in <cstdlib>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

namespace pliant::opencl {
namespace {

namespace fs = std::filesystem;

struct Folder {
  fs::path path;
  std::string from;  ///< the variable that says so
};

std::string variable(const char* name) {
  const char* value = ::getenv(name);
  return value == nullptr ? "" : value;
}

/// As PoCL finds it.
Folder cache_folder() {
  if (const std::string own = variable("POCL_CACHE_DIR"); !own.empty()) return {own, "POCL_CACHE_DIR"};
  if (const std::string all = variable("XDG_CACHE_HOME"); !all.empty())
    return {fs::path(all) / "pocl/kcache", "XDG_CACHE_HOME"};
  if (const std::string home = variable("HOME"); !home.empty()) return {fs::path(home) / ".cache/pocl/kcache", "HOME"};
  return {"/tmp/pocl/kcache", "no variable"};
}

/// Why nothing can be written there; empty: it can.
std::string trouble_with(const fs::path& folder) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (!code && !fs::is_directory(folder, code)) return "it is no folder";
  if (code) return code.message();
  if (::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) == 0) return "";
  return std::generic_category().message(errno);
}

std::string found;  ///< the remark

class PoclCache {
 public:
  PoclCache() {
    if (variable("POCL_CACHE_DIR").empty()) ::unsetenv("POCL_CACHE_DIR");  // PoCL ends the process where it is set and empty
    const Folder folder = cache_folder();
    const std::string trouble = trouble_with(folder.path);
    if (trouble.empty()) return;
    found = fmt::format("PoCL's folder for compiled kernels, {} (from {}), cannot be written: {}", folder.path.string(),
                        folder.from, trouble);
    std::error_code code;
    std::string name = (fs::temp_directory_path(code) / "pliant-kernels-XXXXXX").string();
    if (code || ::mkdtemp(name.data()) == nullptr) {
      found += "; set POCL_CACHE_DIR to a folder that can be";
      return;
    }
    ::setenv("POCL_CACHE_DIR", name.c_str(), 1);
    own_ = name;
    found +=
        "; kernels are compiled for this process alone, which takes seconds each time. POCL_CACHE_DIR names another folder";
  }
  ~PoclCache() {
    std::error_code ignored;
    if (!own_.empty() && process_ == ::getpid()) fs::remove_all(own_, ignored);  // a forked child leaves it to its parent
  }
  PoclCache(const PoclCache&) = delete;
  PoclCache& operator=(const PoclCache&) = delete;

 private:
  fs::path own_;
  const pid_t process_ = ::getpid();
};

}  // namespace

void ensure_pocl_cache() { static const PoclCache cache; }

const std::string& pocl_cache_remark() { return found; }

}  // namespace pliant::opencl
