#include "io/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>

#include "pliant/error.h"

namespace pliant {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kBuffer = std::size_t{1} << 18;

std::string reason(int error) { return std::generic_category().message(error); }

/// The file behind a chain of links, which may not exist yet.
fs::path follow(fs::path path) {
  std::error_code code;
  for (int i = 0; i < 40 && fs::is_symlink(fs::symlink_status(path, code)); ++i) {
    const fs::path next = fs::read_symlink(path, code);
    if (code) break;
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  return path;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& target) : target_(target), final_(follow(target)) {
  std::error_code code;
  const fs::file_status status = fs::status(final_, code);
  if (!final_.has_filename())
    throw Error(ErrorCode::bad_input, fmt::format("cannot write '{}': a file name is needed", target_.string()));
  if (fs::is_directory(status))
    throw Error(ErrorCode::bad_input, fmt::format("cannot write '{}': it is a folder", target_.string()));
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    file_ = ::open(final_.c_str(), O_WRONLY | O_CLOEXEC);
    if (file_ < 0) fail("cannot be opened", errno);
    return;
  }
  const fs::path folder = final_.has_parent_path() ? final_.parent_path() : fs::path(".");
  if (!fs::is_directory(fs::status(folder, code))) {
    throw Error(ErrorCode::bad_input,
                fmt::format("cannot write '{}': '{}' is not an existing folder", target_.string(), folder.string()));
  }
  // A short name of its own: a target whose name has the greatest allowed length must still work.
  static std::atomic<unsigned> counter{0};
  for (int attempt = 0; attempt < 100 && file_ < 0; ++attempt) {
    temporary_ = folder / fmt::format(".pliant-{}-{}.tmp", ::getpid(), counter++);
    file_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file_ < 0 && errno != EEXIST) break;
  }
  if (file_ < 0) {
    const int error = errno;
    temporary_.clear();
    fail("no file can be created in its folder", error);
  }
}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::discard() noexcept {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
}

void AtomicFile::fail(const std::string& what, int error) {
  discard();
  throw Error(ErrorCode::bad_input,
              fmt::format("cannot write '{}': {} after {} bytes: {}", target_.string(), what, on_disk_, reason(error)));
}

void AtomicFile::write(const void* data, std::size_t size) {
  if (file_ < 0) throw Error(ErrorCode::internal, fmt::format("'{}' is written after it was closed", target_.string()));
  bytes_ += size;
  const char* from = static_cast<const char*>(data);
  if (buffer_.size() + size < kBuffer) {
    buffer_.append(from, size);
    return;
  }
  flush();
  put(from, size);
}

void AtomicFile::flush() {
  put(buffer_.data(), buffer_.size());
  buffer_.clear();
}

void AtomicFile::put(const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t done = ::write(file_, data, size);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) fail("writing stopped", done < 0 ? errno : ENOSPC);
    data += done;
    size -= static_cast<std::size_t>(done);
    on_disk_ += static_cast<std::uint64_t>(done);
  }
}

void AtomicFile::commit() {
  if (file_ < 0) throw Error(ErrorCode::internal, fmt::format("'{}' is committed after it was closed", target_.string()));
  flush();
  const int file = file_;
  file_ = -1;
  // Some file systems report a full disk or an exceeded quota only here.
  if (::close(file) != 0) fail("closing failed", errno);
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), final_.c_str()) != 0) fail("the finished file cannot take its name", errno);
  temporary_.clear();
}

void write_file(const fs::path& target, std::string_view content) {
  AtomicFile file(target);
  file.write(content);
  file.commit();
}

}  // namespace pliant
