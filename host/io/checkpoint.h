// A saved state from which a run continues with the same bits.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace pliant {

/// The content of one buffer, as the backend holds it.
struct NamedBytes {
  std::string name;
  std::vector<std::uint8_t> bytes;
  bool operator==(const NamedBytes&) const = default;
};

struct Checkpoint {
  std::uint64_t scene_hash = 0;  ///< of everything that shapes the Program; a checkpoint resumes only the same one
  std::string scene_name;
  std::string real_type;                                  ///< "float" or "double"
  std::int64_t step = 0;                                  ///< steps done
  double time = 0;                                        ///< [s]
  double dt = 0;                                          ///< [s]
  std::map<std::string, std::vector<double>> host_state;  ///< what the host carries between batches, in named groups
  std::vector<NamedBytes> buffers;
};

/// Write atomically: magic, version, length, content (little-endian), 64-bit hash of all before it. Throws Error like
/// AtomicFile.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);

/// Throws Error when the file is missing, is no checkpoint, has another version, is truncated (says expected and actual bytes),
/// is damaged (hash), or holds lengths that do not fit it. Whether it belongs to the scene is for the caller to check.
Checkpoint read_checkpoint(const std::filesystem::path& file);

}  // namespace pliant
