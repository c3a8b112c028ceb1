// Shared by the backends: pass equality, a table of prepared passes, and the memory check.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "program/program.h"

namespace pliant {

/// Returns true for the same launch: kernel, defines, arguments, shape, count and label agree.
bool same_pass(const Pass& a, const Pass& b);

/// "LAW=0 FORCE_ONLY=1", for messages.
std::string defines_text(const std::vector<std::pair<std::string, int>>& defines);

/// "1.50 GiB (1610612736 bytes)".
std::string bytes_text(std::uint64_t bytes);

/// The buffer tables of the loaded program and its extension, by id. Both programs must not move.
class BufferTable {
 public:
  void load(const Program& program) { parts_ = {&program, nullptr}; }
  void extend(const Program& extension) { parts_[1] = &extension; }
  void drop_extension() { parts_[1] = nullptr; }
  [[nodiscard]] std::size_t size() const { return own() + (parts_[1] != nullptr ? parts_[1]->buffers.size() : 0); }
  /// Number of buffers of the program itself.
  [[nodiscard]] std::size_t own() const { return parts_[0] != nullptr ? parts_[0]->buffers.size() : 0; }
  [[nodiscard]] const Buffer& row(BufferId id) const {
    const auto i = static_cast<std::size_t>(id);
    return i < own() ? parts_[0]->buffers[i] : parts_[1]->buffers.at(i - own());
  }
  [[nodiscard]] const std::array<const Program*, 2>& parts() const { return parts_; }

 private:
  std::array<const Program*, 2> parts_{};
};

/// Throws Error if an argument is not one of the `buffers` buffers of the table, if a size is impossible, or if `count` does
/// not fit the shape.
void check_pass(const Pass& pass, std::size_t buffers);

/// Throws Error if an extension was built for a program with a different number of buffers than the loaded one.
void check_extension(const Program& extension, std::size_t buffers);

/// Throws Error if a buffer is larger than `max_buffer` bytes or all together are larger than `total` bytes, with the memory
/// needed and available and the largest buffer. `real_bytes`: 4 or 8.
void check_memory(const BufferTable& table, std::size_t real_bytes, std::uint64_t max_buffer, std::uint64_t total,
                  const std::string& device);

/// Caches prepared passes. Passes of the loaded program are found by address, copies of them by value; unknown passes are
/// prepared on first use.
template <class Prepared>
class PassTable {
 public:
  void clear() {
    entries_.clear();
    by_address_.clear();
  }
  /// Prepares all lists of a program with `make(pass)`, which returns a Prepared.
  template <class Make>
  void load(const Program& program, Make&& make) {
    clear();
    for (const auto* list : {&program.step, &program.look, &program.force, &program.rates, &program.status}) {
      for (const Pass& pass : *list) by_address_.emplace(&pass, &by_value(pass, make));
    }
  }
  /// Returns true if it is a pass of the loaded program itself.
  [[nodiscard]] bool holds(const Pass& pass) const {
    const auto found = by_address_.find(&pass);
    return found != by_address_.end() && same_pass(found->second->pass, pass);
  }
  template <class Make>
  Prepared& get(const Pass& pass, Make&& make) {
    const auto found = by_address_.find(&pass);
    if (found != by_address_.end() && same_pass(found->second->pass, pass)) return found->second->prepared;
    return by_value(pass, make).prepared;
  }
  /// Calls visit(pass, prepared) in the order of preparation.
  template <class Visit>
  void for_each(Visit&& visit) {
    for (auto& entry : entries_) visit(entry->pass, entry->prepared);
  }

 private:
  struct Entry {
    Pass pass;
    Prepared prepared;
  };
  template <class Make>
  Entry& by_value(const Pass& pass, Make&& make) {
    for (auto& entry : entries_) {
      if (same_pass(entry->pass, pass)) return *entry;
    }
    entries_.push_back(std::make_unique<Entry>(Entry{pass, make(pass)}));
    return *entries_.back();
  }
  std::vector<std::unique_ptr<Entry>> entries_;
  std::unordered_map<const Pass*, Entry*> by_address_;
};

}  // namespace pliant
