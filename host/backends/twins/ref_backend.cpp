#include "backends/twins/ref_backend.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <new>
#include <type_traits>

#include "backends/interface/buffer_checks.h"
#include "backends/interface/float_environment.h"
#include "backends/interface/pass_table.h"
#include "backends/interface/probe.h"
#include "backends/twins/prepared_twin.h"
#include "backends/twins/processor.h"
#include "backends/twins/thread_pool.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using ref::ArgValue;
using ref::Range;
using Clock = std::chrono::steady_clock;

template <class Scalar>
class RefBackend final : public Backend {
 public:
  explicit RefBackend(const RefOptions& options)
      : registry_(options.registry != nullptr ? *options.registry : ref::registry()), pool_(options.threads) {
    constexpr bool is_float = std::is_same_v<Scalar, float>;
    info_.name = is_float ? "cpu" : "cpu:double";
    info_.device = ref::processor_name();
    info_.kind = "reference";
    info_.real_bytes = sizeof(Scalar);
    info_.platform = "Pliant";
    info_.version = is_float ? "C++ twins, float" : "C++ twins, double";
    info_.memory_bytes = options.memory_bytes != 0 ? options.memory_bytes : ref::physical_memory();
    info_.max_buffer_bytes = info_.memory_bytes;
    info_.compute_units = pool_.threads();
    if (!is_float) info_.tolerance_reason = "double precision is the rounding-error oracle";
  }

  [[nodiscard]] const BackendInfo& info() const override { return info_; }
  void set_probe_result(const std::string& difference) {
    info_.bit_exact = difference.empty();
    info_.tolerance_reason = difference;
  }

  void load(const Program& program) override {
    table_.load(program);
    check_memory(table_, sizeof(Scalar), info_.max_buffer_bytes, info_.memory_bytes, info_.name);
    bring(nullptr, program, storage_, passes_);
    extension_.clear();
    extension_passes_.clear();
  }

  void update(const Program& loaded, const Program& next) override {
    table_.load(next);
    extension_passes_.clear();  // its arguments were buffers of the old program; its own buffers stay for extend()
    check_memory(table_, sizeof(Scalar), info_.max_buffer_bytes, info_.memory_bytes, info_.name);
    bring(&loaded, next, storage_, passes_);
  }

  void extend(const Program* before, const Program& extension) override {
    check_extension(extension, storage_.size());
    table_.extend(extension);
    check_memory(table_, sizeof(Scalar), info_.max_buffer_bytes, info_.memory_bytes, info_.name);
    bring(before, extension, extension_, extension_passes_);
  }

  void run(const std::vector<Pass>& passes, std::int32_t first, std::int32_t count, std::int64_t origin) override {
    for (std::int32_t step = first; step < first + count;) {
      // Runs consecutive steps with the same passes together.
      const auto same = [&](std::int32_t other) {
        return std::all_of(passes.begin(), passes.end(),
                           [&](const Pass& p) { return p.runs_in(origin + step) == p.runs_in(origin + other); });
      };
      std::int32_t end = step + 1;
      while (end < first + count && same(end)) ++end;
      list_.clear();
      for (const Pass& pass : passes) {
        if (pass.runs_in(origin + step) && pass.indices() > 0) list_.push_back({&prepared(pass), pass.indices()});
      }
      run_list(step, end - step);
      step = end;
    }
  }
  void run(const Pass& pass, std::int32_t step_in_batch) override {
    list_.clear();
    if (pass.indices() > 0) list_.push_back({&prepared(pass), pass.indices()});
    run_list(step_in_batch, 1);
  }
  void finish() override {}

  void copy(BufferId from, BufferId to) override {
    const Storage& source = storage(from);
    Storage& target = storage(to);
    check_copy(row(from), row(to));
    std::copy(source.reals.begin(), source.reals.end(), target.reals.begin());
    std::copy(source.ints.begin(), source.ints.end(), target.ints.begin());
  }

  std::vector<double> read_reals(BufferId id) override {
    const Storage& s = storage(id, false);
    return {s.reals.begin(), s.reals.begin() + static_cast<std::ptrdiff_t>(row(id).values())};
  }
  std::vector<std::int32_t> read_ints(BufferId id) override {
    const Storage& s = storage(id, true);
    return {s.ints.begin(), s.ints.begin() + static_cast<std::ptrdiff_t>(row(id).values())};
  }
  void write_reals(BufferId id, const std::vector<double>& values) override {
    Storage& s = storage(id, false);
    check_size(row(id), values.size());
    s.written = true;
    const DefaultFloatEnvironment environment;
    round_reals(values, s.reals.data());
  }
  void write_ints(BufferId id, const std::vector<std::int32_t>& values) override {
    Storage& s = storage(id, true);
    check_size(row(id), values.size());
    s.written = true;
    std::copy(values.begin(), values.end(), s.ints.begin());
  }
  std::vector<std::uint8_t> read_bytes(BufferId id) override {
    const Storage& s = storage(id);
    const bool ints = row(id).is_int();
    std::vector<std::uint8_t> bytes(row(id).values() * (ints ? sizeof(std::int32_t) : sizeof(Scalar)));
    if (!bytes.empty())
      std::memcpy(bytes.data(), ints ? static_cast<const void*>(s.ints.data()) : s.reals.data(), bytes.size());
    return bytes;
  }

  void profile(bool on) override { profiling_ = on; }
  std::vector<PassTime> take_profile() override {
    std::vector<PassTime> times;
    for (auto* table : {&passes_, &extension_passes_}) {
      table->for_each([&](const Pass& pass, Prepared& p) {
        if (p.launches > 0) times.push_back({pass.kernel, pass.label, p.seconds, p.launches});
        p.seconds = 0;
        p.launches = 0;
      });
    }
    return times;
  }

 private:
  struct Storage {
    std::vector<Scalar> reals;  // one of the two is used; never empty, so that its pointer is valid
    std::vector<std::int32_t> ints;
    bool written = false;  // written by the host after its initial values
  };
  struct Prepared : ref::PreparedTwin<Scalar> {
    Shape shape = Shape::lanes;
    bool uneven = false;
    double seconds = 0;
    std::int64_t launches = 0;
  };

  /// Few indices or bricks are not worth a second thread.
  static bool splits(const Prepared& p, std::int64_t count) {
    return count >= (p.shape == Shape::bricks ? 4 : p.uneven ? (p.shape == Shape::items ? 64 : 256) : 1024);
  }

  /// Number of portions per thread of an uneven pass.
  static constexpr int kPortions = 16;

  /// One piece of `pieces`: contiguous, and for `lanes` a multiple of sixteen indices.
  static Range share(const Prepared& p, std::int64_t count, int piece, int pieces) {
    const std::int64_t unit = p.shape == Shape::lanes ? 16 : 1;
    const std::int64_t units = count / unit;
    return {units * piece / pieces * unit, units * (piece + 1) / pieces * unit};
  }

  static void fill(const Buffer& buffer, Storage& s) {
    const std::size_t size = std::max<std::size_t>(buffer.values(), 1);
    initial_count(buffer);  // throws if the initial values do not fit
    s.written = false;
    if (buffer.is_int()) {
      s.ints.assign(size, 0);
      std::copy(buffer.ints.begin(), buffer.ints.end(), s.ints.begin());
    } else {
      s.reals.assign(size, static_cast<Scalar>(buffer.padding));
      round_reals(buffer.reals, s.reals.data());
    }
  }

  /// Updates storage with the initial values of `before` to those of `buffer`. Buffers that passes or the host write are
  /// reset.
  static void patch(const Buffer& before, const Buffer& buffer, Storage& s) {
    if (buffer.role != BufferRole::constant || s.written) return fill(buffer, s);
    const std::size_t size = std::max<std::size_t>(buffer.values(), 1);
    if (buffer.is_int()) {
      s.ints.resize(size, 0);
    } else {
      s.reals.resize(size, Scalar(0));
    }
    for (const ValueRange& range : changed_values(before, buffer)) {
      const std::size_t given = std::max(range.first, std::min(range.last, initial_count(buffer)));
      if (buffer.is_int()) {
        std::copy(buffer.ints.data() + range.first, buffer.ints.data() + given, s.ints.data() + range.first);
        std::fill(s.ints.data() + given, s.ints.data() + range.last, 0);
      } else {
        round_reals(std::span(buffer.reals).subspan(range.first, given - range.first), s.reals.data() + range.first);
        std::fill(s.reals.data() + given, s.reals.data() + range.last, static_cast<Scalar>(buffer.padding));
      }
    }
  }

  /// Sets up the buffers and passes of `next`, reusing the buffers of `before` if given.
  void bring(const Program* before, const Program& next, std::vector<Storage>& storage, PassTable<Prepared>& passes) {
    const DefaultFloatEnvironment environment;
    passes.clear();
    try {
      std::vector<Storage> old = std::move(storage);
      storage.clear();
      storage.resize(next.buffers.size());
      for (std::size_t i = 0; i < storage.size(); ++i) {
        const Buffer& buffer = next.buffers[i];
        const Buffer* same = before != nullptr ? find_same(before->buffers, buffer, i) : nullptr;
        if (same == nullptr) {
          fill(buffer, storage[i]);
        } else {
          storage[i] = std::move(old[static_cast<std::size_t>(same - before->buffers.data())]);
          patch(*same, buffer, storage[i]);
        }
      }
    } catch (const std::bad_alloc&) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("out of memory while the scene's {} buffers were allocated", next.buffers.size()));
    }
    passes.load(next, [this](const Pass& pass) { return prepare(pass); });
  }

  Prepared prepare(const Pass& pass) {
    const auto values_of = [this](BufferId id) {
      Storage& s = storage(id);
      return s.ints.empty() ? ArgValue<Scalar>{s.reals.data()} : ArgValue<Scalar>{nullptr, s.ints.data()};
    };
    return {ref::prepare_twin<Scalar>(registry_, pass, table_.size(), values_of), pass.shape, pass.uneven};
  }

  Prepared& prepared(const Pass& pass) {
    auto& table = extension_passes_.holds(pass) ? extension_passes_ : passes_;
    return table.get(pass, [this](const Pass& p) { return prepare(p); });
  }

  void run_list(std::int32_t first, std::int32_t count) {
    const DefaultFloatEnvironment environment;
    for (std::int32_t step = first; step < first + count; ++step) {
      for (const auto& [p, indices] : list_) {
        if (profiling_) {
          const auto start = Clock::now();
          execute(*p, indices, step);
          p->seconds += std::chrono::duration<double>(Clock::now() - start).count();
          ++p->launches;
        } else {
          execute(*p, indices, step);
        }
      }
    }
  }

  void execute(const Prepared& p, std::int64_t count, std::int32_t step) {
    if (splits(p, count)) {
      const int portions = p.uneven ? kPortions : 1, pieces = pool_.threads();
      pool_.run([&](int piece) {
        for (int k = 0; k < portions; ++k) p.execute(share(p, count, k * pieces + piece, portions * pieces), step);
      });
    } else {
      p.execute({0, count}, step);
    }
  }

  const Buffer& row(BufferId id) const { return table_.row(id); }
  Storage& storage(BufferId id) {
    check_id(id, storage_.size() + extension_.size());
    const auto i = static_cast<std::size_t>(id);
    return i < storage_.size() ? storage_[i] : extension_[i - storage_.size()];
  }
  Storage& storage(BufferId id, bool ints) {
    Storage& s = storage(id);
    check_type(row(id), ints);
    return s;
  }

  BackendInfo info_;
  const ref::Registry& registry_;
  ref::ThreadPool pool_;
  BufferTable table_;
  std::vector<Storage> storage_, extension_;
  PassTable<Prepared> passes_, extension_passes_;
  /// A pass and the number of indices to run.
  struct Listed {
    Prepared* pass;
    std::int64_t indices;
  };
  std::vector<Listed> list_;
  bool profiling_ = false;
};

}  // namespace

std::unique_ptr<Backend> make_ref_backend(const RefOptions& options) {
  ref::require_fma();
  if (options.double_precision) return std::make_unique<RefBackend<double>>(options);
  auto backend = std::make_unique<RefBackend<float>>(options);
  if (options.probe) backend->set_probe_result(run_probe(*backend));
  return backend;
}

}  // namespace pliant
