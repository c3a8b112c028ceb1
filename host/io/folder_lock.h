// One process at a time writes into a folder.
#pragma once
#include <filesystem>

namespace pliant {

/// Holds a lock on the file ".pliant-lock" in `folder` until it is destroyed; the system releases it when the process dies,
/// however it does. Throws Error (bad_input) that names the folder and the other process when another one holds it. A file
/// system without locks gives none, and nothing is refused.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();  ///< removes the file
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace pliant
