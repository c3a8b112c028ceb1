#include "io/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "pliant/error.h"
#include "support/temp_folder.h"

namespace pliant {
namespace {

using test::bytes_of;
using test::TempFolder;

std::size_t entries(const std::filesystem::path& folder) {
  std::size_t n = 0;
  for (const auto& e : std::filesystem::directory_iterator(folder)) n += e.exists() || e.is_symlink() ? 1 : 0;
  return n;
}

template <class F>
void expect_error(F&& f, std::initializer_list<std::string> parts) {
  try {
    f();
    ADD_FAILURE() << "no error";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::bad_input);
    for (const auto& part : parts)
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what() << "\nlacks: " << part;
  }
}

TEST(AtomicFile, AppearsOnlyWhenCommitted) {
  const TempFolder folder;
  const auto path = folder.path() / "a.bin";
  std::ofstream(path) << "old";
  {
    AtomicFile file(path);
    file.write(std::string(1 << 20, 'x'));
    file.write("yz");
    EXPECT_EQ(file.bytes(), (1u << 20) + 2);
    EXPECT_EQ(bytes_of(path), "old");
    file.commit();
  }
  EXPECT_EQ(bytes_of(path), std::string(1 << 20, 'x') + "yz");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(AtomicFile, LeavesNothingWhenAbandoned) {
  const TempFolder folder;
  {
    AtomicFile file(folder.path() / "a.bin");
    file.write("half");
  }
  EXPECT_EQ(entries(folder.path()), 0u);
}

TEST(AtomicFile, FollowsLinksAndLeavesThem) {
  const TempFolder folder;
  std::filesystem::create_symlink("real.txt", folder.path() / "link.txt");
  write_file(folder.path() / "link.txt", "text");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "link.txt"));
  EXPECT_EQ(bytes_of(folder.path() / "real.txt"), "text");
}

TEST(AtomicFile, TakesTheLongestName) {
  const TempFolder folder;
  const auto path = folder.path() / std::string(255, 'n');
  write_file(path, "text");
  EXPECT_EQ(bytes_of(path), "text");
  expect_error([&] { write_file(folder.path() / std::string(256, 'n'), "text"); }, {"cannot write"});
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(AtomicFile, RefusesFoldersAndMissingFolders) {
  const TempFolder folder;
  expect_error([&] { write_file(folder.path(), "x"); }, {folder.path().string(), "folder"});
  expect_error([&] { write_file(folder.path() / "no" / "a", "x"); }, {"no/a", "not an existing folder"});
  std::ofstream(folder.path() / "plain") << "x";
  expect_error([&] { write_file(folder.path() / "plain" / "a", "x"); }, {"not an existing folder"});
  EXPECT_THROW(write_file("", "x"), Error);
  EXPECT_THROW(write_file(folder.path() / "", "x"), Error);
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(AtomicFile, UnwritableFolder) {
  // Even an administrator cannot create files here.
  if (!std::filesystem::is_directory("/proc/self")) GTEST_SKIP() << "no /proc";
  expect_error([] { write_file("/proc/self/pliant", "x"); }, {"/proc/self/pliant", "no file can be created"});
  if (::geteuid() == 0) return;
  const TempFolder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  expect_error([&] { write_file(folder.path() / "a", "x"); }, {"Permission denied"});
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
}

TEST(AtomicFile, FullDeviceIsReportedAndKept) {
  if (!std::filesystem::is_character_file("/dev/full")) GTEST_SKIP() << "no /dev/full";
  expect_error([] { write_file("/dev/full", "x"); }, {"/dev/full", "after 0 bytes", "No space left"});
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
  write_file("/dev/null", "x");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

/// Sets the greatest size of a file for its lifetime.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &old_);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, old_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit old_{};
  void (*handler_)(int) = SIG_DFL;
};

TEST(AtomicFile, SizeLimitKeepsTheOldFile) {
  const TempFolder folder;
  const auto path = folder.path() / "a.bin";
  write_file(path, "old");
  {
    const FileSizeLimit limit(1 << 20);
    expect_error([&] { write_file(path, std::string(3 << 20, 'x')); }, {"a.bin", "after 1048576 bytes", "File too large"});
    // Within the buffer, so that only commit() meets the limit.
    const FileSizeLimit tiny(100);
    expect_error([&] { write_file(path, std::string(1000, 'x')); }, {"after 100 bytes"});
  }
  EXPECT_EQ(bytes_of(path), "old");
  EXPECT_EQ(entries(folder.path()), 1u);
}

/// A file system of 256 KiB for its lifetime, where the system permits.
class TinyDisk {
 public:
  explicit TinyDisk(std::filesystem::path path) : path_(std::move(path)) {
    mounted_ = ::mount("tmpfs", path_.c_str(), "tmpfs", 0, "size=256k") == 0;
  }
  ~TinyDisk() {
    if (mounted_) ::umount2(path_.c_str(), MNT_DETACH);
  }
  TinyDisk(const TinyDisk&) = delete;
  TinyDisk& operator=(const TinyDisk&) = delete;
  [[nodiscard]] bool mounted() const { return mounted_; }

 private:
  std::filesystem::path path_;
  bool mounted_ = false;
};

TEST(AtomicFile, FullDiskKeepsTheOldFile) {
  const TempFolder folder;
  const TinyDisk disk(folder.path());
  if (!disk.mounted()) GTEST_SKIP() << "a small file system cannot be mounted here";
  const auto path = folder.path() / "a.bin";
  write_file(path, "old");
  expect_error([&] { write_file(path, std::string(1 << 20, 'x')); }, {"a.bin", "No space left"});
  EXPECT_EQ(bytes_of(path), "old");
  EXPECT_EQ(entries(folder.path()), 1u);
}

}  // namespace
}  // namespace pliant
