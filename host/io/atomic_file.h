// A file that appears under its name only when it is complete.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace pliant {

/// Writes to a temporary name in the folder of `target` and renames it over `target` in commit(). A target that is a link is
/// followed; one that exists and is a device or a pipe is written directly, never replaced. Every failure (missing folder, no
/// permission, full disk, a folder under that name) throws Error with the path, the bytes written so far and the system's
/// reason, and leaves no temporary behind. The data are handed to the system, not forced onto the disk.
/// A program that runs under a file-size limit must ignore SIGXFSZ to get the Error.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();  ///< removes the temporary unless committed
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* data, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Flush, close, rename. Nothing may be written afterwards.
  void commit();
  /// Bytes given to write() so far.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  void flush();
  void put(const char* data, std::size_t size);
  void discard() noexcept;
  [[noreturn]] void fail(const std::string& what, int error);

  std::filesystem::path target_;     ///< as the caller named it, for messages
  std::filesystem::path final_;      ///< links followed
  std::filesystem::path temporary_;  ///< empty when written directly
  std::string buffer_;
  std::uint64_t bytes_ = 0;
  std::uint64_t on_disk_ = 0;
  int file_ = -1;
};

/// Write `content` to `target` in one go.
void write_file(const std::filesystem::path& target, std::string_view content);

}  // namespace pliant
