// The frame of every backend: the loaded program and its extension with their buffers and prepared passes, the checks of what
// the host reads and writes, and the times of passes. A backend adds how it allocates buffers, prepares passes and runs them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "backends/interface/backend.h"
#include "backends/interface/buffer_checks.h"
#include "backends/interface/float_environment.h"
#include "backends/interface/pass_table.h"

namespace pliant {

/// What is measured of a prepared pass.
struct PassClock {
  double seconds = 0;
  std::int64_t launches = 0;
};

/// `Store`: the memory of one buffer. `Prepared`: a pass that is ready to run, derived from PassClock. `Real`: the backend's
/// real numbers.
template <class Store, class Prepared, class Real>
class ProgramBackend : public Backend {
 public:
  [[nodiscard]] const BackendInfo& info() const final { return info_; }
  /// `difference`: what the start-up probe found; empty: the backend is exact.
  void set_probe_result(const std::string& difference) {
    info_.bit_exact = difference.empty();
    info_.tolerance_reason = difference;
  }

  void load(const Program& program) override {
    begin_change();
    table_.load(program);
    check_fits();
    own_ = {};
    extension_ = {};
    bring(nullptr, program, own_);
  }
  void update(const Program& loaded, const Program& next) override {
    begin_change();
    release(own_.passes);
    release(extension_.passes);  // its arguments were buffers of the old program; its own buffers stay for extend()
    table_.load(next);
    check_fits();
    bring(&loaded, next, own_);
  }
  void extend(const Program* before, const Program& extension) override {
    begin_change();
    release(extension_.passes);
    check_extension(extension, own_.stores.size());
    table_.extend(extension);
    check_fits();
    bring(before, extension, extension_);
  }

  void copy(BufferId from, BufferId to) final {
    check_copy(row(from), row(to));
    if (from != to && row(from).values() > 0) copy_values(from, to);
  }
  std::vector<double> read_reals(BufferId id) final {
    check_type(row(id), false);
    const std::size_t count = row(id).values();
    const auto values = std::make_unique_for_overwrite<Real[]>(count);
    read_into(id, values.get());
    return {values.get(), values.get() + count};
  }
  std::vector<std::int32_t> read_ints(BufferId id) final {
    check_type(row(id), true);
    std::vector<std::int32_t> values(row(id).values());
    read_into(id, values.data());
    return values;
  }
  std::vector<std::uint8_t> read_bytes(BufferId id) final {
    std::vector<std::uint8_t> bytes(bytes_of(id));
    read_into(id, bytes.data());
    return bytes;
  }
  void read_into(BufferId id, void* out) override = 0;
  void write_reals(BufferId id, const std::vector<double>& values) final {
    check_type(row(id), false);
    check_size(row(id), values.size());
    const DefaultFloatEnvironment environment;
    const auto rounded = std::make_unique_for_overwrite<Real[]>(values.size());
    round_reals(values, rounded.get());
    write_from(id, rounded.get());
  }
  void write_ints(BufferId id, const std::vector<std::int32_t>& values) final {
    check_type(row(id), true);
    check_size(row(id), values.size());
    write_from(id, values.data());
  }

  void profile(bool on) override { profiling_ = on; }
  std::vector<PassTime> take_profile() final {
    begin_change();
    std::vector<PassTime> times;
    for (auto* part : {&own_, &extension_}) {
      part->passes.for_each([&](const Pass& pass, Prepared& p) {
        if (p.launches > 0) times.push_back({pass.kernel, pass.label, p.seconds, p.launches});
        static_cast<PassClock&>(p) = {};
      });
    }
    return times;
  }

 protected:
  /// `where`: the backend in messages. `bytes_per_real`: memory that a real number of a buffer takes.
  ProgramBackend(BackendInfo info, std::string where, std::size_t bytes_per_real)
      : info_(std::move(info)), where_(std::move(where)), bytes_per_real_(bytes_per_real) {}

  /// Waits for what runs, and adds the times that are still missing.
  virtual void begin_change() {}
  /// Drops prepared passes.
  virtual void release(PassTable<Prepared>& passes) { passes.clear(); }
  /// Returns the memory of the buffers of `next` with their initial values. `before`: the program that `old` belongs to, or
  /// nullptr.
  virtual std::vector<Store> make_stores(const Program* before, const Program& next, std::vector<Store> old) = 0;
  virtual Prepared prepare(const Pass& pass) = 0;
  /// Copies one buffer, which is not empty, to another of the same size.
  virtual void copy_values(BufferId from, BufferId to) = 0;
  /// Writes all values of a buffer, which may be empty.
  virtual void write_from(BufferId id, const void* values) = 0;

  /// Returns make(i, row, same, store) for each buffer i of `next`, where `same` is its row in `before` and `store` its old
  /// memory; both are nullptr if it is new.
  template <class Make>
  static std::vector<Store> remake(const Program* before, const Program& next, std::vector<Store> old, Make&& make) {
    std::vector<Store> stores;
    stores.reserve(next.buffers.size());
    for (std::size_t i = 0; i < next.buffers.size(); ++i) {
      const Buffer* same = before != nullptr ? find_same(before->buffers, next.buffers[i], i) : nullptr;
      Store* store = same != nullptr ? &old[static_cast<std::size_t>(same - before->buffers.data())] : nullptr;
      stores.push_back(make(i, next.buffers[i], same, store));
    }
    return stores;
  }

  Prepared& prepared(const Pass& pass) {
    auto& table = extension_.passes.holds(pass) ? extension_.passes : own_.passes;
    return table.get(pass, [this](const Pass& p) { return prepare(p); });
  }
  [[nodiscard]] const Buffer& row(BufferId id) const {
    check_id(id, table_.size());
    return table_.row(id);
  }
  [[nodiscard]] std::size_t bytes_of(BufferId id) const {
    return row(id).values() * (row(id).is_int() ? sizeof(std::int32_t) : sizeof(Real));
  }
  Store& store(BufferId id) {
    check_id(id, own_.stores.size() + extension_.stores.size());
    const auto i = static_cast<std::size_t>(id);
    return i < own_.stores.size() ? own_.stores[i] : extension_.stores[i - own_.stores.size()];
  }
  template <class Visit>
  void for_each_store(Visit&& visit) {
    for (auto* part : {&own_, &extension_}) {
      for (Store& store : part->stores) visit(store);
    }
  }
  [[nodiscard]] const BufferTable& table() const { return table_; }
  [[nodiscard]] bool profiling() const { return profiling_; }
  [[nodiscard]] const std::string& where() const { return where_; }

 private:
  /// A program's buffers and passes.
  struct Part {
    std::vector<Store> stores;
    PassTable<Prepared> passes;
  };

  void check_fits() const { check_memory(table_, bytes_per_real_, info_.max_buffer_bytes, info_.memory_bytes, where_); }
  void bring(const Program* before, const Program& next, Part& part) {
    const DefaultFloatEnvironment environment;
    part.stores = make_stores(before, next, std::exchange(part.stores, {}));
    part.passes.load(next, [this](const Pass& pass) { return prepare(pass); });
  }

  BackendInfo info_;
  const std::string where_;
  const std::size_t bytes_per_real_;
  BufferTable table_;
  Part own_, extension_;
  bool profiling_ = false;
};

}  // namespace pliant
