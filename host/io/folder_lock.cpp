#include "io/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>

#include "pliant/error.h"

namespace pliant {
namespace {

/// Who holds the lock, as it has written there.
std::string holder(int descriptor) {
  std::array<char, 32> text{};
  const ssize_t size = ::pread(descriptor, text.data(), text.size() - 1, 0);
  std::string pid(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
  while (!pid.empty() && pid.back() == '\n') pid.pop_back();
  return pid.empty() ? "another process" : "process " + pid;
}

/// Whether the file of this name is the open one: the run before may have removed it since it was opened.
bool is_named(int descriptor, const std::filesystem::path& file) {
  struct stat open {
  }, named{};
  return ::fstat(descriptor, &open) == 0 && ::stat(file.c_str(), &named) == 0 && open.st_dev == named.st_dev &&
         open.st_ino == named.st_ino;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) : file_(folder / ".pliant-lock") {
  for (;;) {
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("cannot write into the folder '{}': its lock '{}' cannot be opened: {}", folder.string(),
                              file_.filename().string(), std::generic_category().message(errno)));
    }
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      if (errno == EINTR) {
        ::close(descriptor_);
        continue;
      }
      if (errno != EWOULDBLOCK) return;
      const std::string who = holder(descriptor_);
      ::close(descriptor_);
      throw Error(ErrorCode::bad_input,
                  fmt::format("the folder '{}' is in use by {}, which writes its frames there; wait for it, "
                              "or give another folder",
                              folder.string(), who));
    }
    if (is_named(descriptor_, file_)) break;
    ::close(descriptor_);
  }
  const std::string pid = fmt::format("{}\n", ::getpid());
  // Who it is matters to messages alone: a full disk does not keep the lock from holding.
  if (::ftruncate(descriptor_, 0) == 0) static_cast<void>(!::pwrite(descriptor_, pid.data(), pid.size(), 0));
}

FolderLock::~FolderLock() {
  ::unlink(file_.c_str());
  ::close(descriptor_);
}

}  // namespace pliant
