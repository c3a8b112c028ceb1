// A file handle of the system that is closed by itself.
#pragma once
#include <unistd.h>

#include <utility>

namespace pliant::devices {

class FileHandle {
 public:
  FileHandle() = default;
  explicit FileHandle(int handle) : handle_(handle) {}
  FileHandle(FileHandle&& other) noexcept : handle_(std::exchange(other.handle_, -1)) {}
  FileHandle& operator=(FileHandle&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~FileHandle() { reset(); }
  [[nodiscard]] int get() const { return handle_; }
  explicit operator bool() const { return handle_ >= 0; }
  void reset() {
    if (handle_ >= 0) close(handle_);
    handle_ = -1;
  }

 private:
  int handle_ = -1;
};

}  // namespace pliant::devices
