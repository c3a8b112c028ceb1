// A saved state from which a run continues with the same bits.
#pragma once
#include <filesystem>
#include <string>

#include "simulation/state/snapshot.h"

namespace pliant {

struct Checkpoint {
  std::string scene_name;  ///< for messages
  Snapshot snapshot;
};

/// Write atomically: magic, version, length, content (little-endian), 64-bit hash of all before it. Throws Error like
/// AtomicFile.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);

/// Throws Error when the file is missing, is no checkpoint, has another version, is truncated (says expected and actual bytes),
/// is damaged (hash), or holds lengths or a run state that do not fit it. Whether it belongs to the scene is for the caller to
/// check.
Checkpoint read_checkpoint(const std::filesystem::path& file);

}  // namespace pliant
