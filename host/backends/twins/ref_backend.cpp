#include "backends/twins/ref_backend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <type_traits>

#include "backends/interface/probe.h"
#include "backends/twins/thread_pool.h"
#include "backends/twins/twin_backend.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using ref::Range;

template <class Scalar>
struct Storage {
  std::vector<Scalar> reals;  // one of the two is used; never empty, so that its pointer is valid
  std::vector<std::int32_t> ints;
  bool written = false;  // written by the host after its initial values

  [[nodiscard]] const void* values() const { return ints.empty() ? static_cast<const void*>(reals.data()) : ints.data(); }
  [[nodiscard]] void* values() { return ints.empty() ? static_cast<void*>(reals.data()) : ints.data(); }
};

template <class Scalar>
struct PreparedPass : PassClock {
  ref::PreparedTwin<Scalar> twin;
  Shape shape = Shape::lanes;
  bool uneven = false;
};

template <class Scalar>
class RefBackend final : public ref::TwinBackend<Storage<Scalar>, PreparedPass<Scalar>, Scalar> {
  using Base = ref::TwinBackend<Storage<Scalar>, PreparedPass<Scalar>, Scalar>;
  using Store = Storage<Scalar>;
  using Prepared = PreparedPass<Scalar>;
  using Base::bytes_of, Base::prepared, Base::remake, Base::run_timed, Base::store, Base::twin_of;

 public:
  explicit RefBackend(const RefOptions& options) : RefBackend(options, std::make_unique<ref::ThreadPool>(options.threads)) {}

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
  void read_into(BufferId id, void* out) override {
    const std::size_t bytes = bytes_of(id);
    if (bytes > 0) std::memcpy(out, store(id).values(), bytes);
  }

 protected:
  void copy_values(BufferId from, BufferId to) override {
    std::memcpy(store(to).values(), store(from).values(), bytes_of(from));
  }
  void write_from(BufferId id, const void* values) override {
    store(id).written = true;
    if (const std::size_t bytes = bytes_of(id); bytes > 0) std::memcpy(store(id).values(), values, bytes);
  }
  std::vector<Store> make_stores(const Program* before, const Program& next, std::vector<Store> old) override {
    try {
      return remake(before, next, std::move(old), [](std::size_t, const Buffer& buffer, const Buffer* same, Store* given) {
        Store made = given != nullptr ? std::move(*given) : Store();
        if (same == nullptr) {
          fill(buffer, made);
        } else {
          patch(*same, buffer, made);
        }
        return made;
      });
    } catch (const std::bad_alloc&) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("out of memory while the scene's {} buffers were allocated", next.buffers.size()));
    }
  }
  Prepared prepare(const Pass& pass) override {
    Prepared p;
    p.twin = twin_of(pass, [this](BufferId id) {
      Store& s = store(id);
      return s.ints.empty() ? ref::ArgValue<Scalar>{s.reals.data()} : ref::ArgValue<Scalar>{nullptr, s.ints.data()};
    });
    p.shape = pass.shape;
    p.uneven = pass.uneven;
    return p;
  }

 private:
  RefBackend(const RefOptions& options, std::unique_ptr<ref::ThreadPool> pool)
      : Base(info_of(options, pool->threads()), sizeof(Scalar), options.registry), pool_(std::move(pool)) {}

  static BackendInfo info_of(const RefOptions& options, int threads) {
    constexpr bool is_float = std::is_same_v<Scalar, float>;
    BackendInfo info = ref::twin_info(is_float ? "cpu" : "cpu:double", is_float ? "C++ twins, float" : "C++ twins, double");
    info.real_bytes = sizeof(Scalar);
    if (options.memory_bytes != 0) info.memory_bytes = info.max_buffer_bytes = options.memory_bytes;
    info.compute_units = threads;
    if (!is_float) info.tolerance_reason = "double precision is the rounding-error oracle";
    return info;
  }

  /// Few indices or bricks are not worth a second thread.
  static bool splits(const Prepared& p, std::int64_t count) {
    return count >= (p.shape == Shape::bricks ? 4 : p.uneven ? (p.shape == Shape::lanes ? 256 : 64) : 1024);
  }

  /// Number of portions per thread of an uneven pass.
  static constexpr int kPortions = 16;

  /// One piece of `pieces`: contiguous, and for `lanes` a multiple of sixteen indices.
  static Range share(const Prepared& p, std::int64_t count, int piece, int pieces) {
    const std::int64_t unit = p.shape == Shape::lanes ? 16 : 1;
    const std::int64_t units = count / unit;
    return {units * piece / pieces * unit, units * (piece + 1) / pieces * unit};
  }

  static void fill(const Buffer& buffer, Store& s) {
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
  static void patch(const Buffer& before, const Buffer& buffer, Store& s) {
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

  void run_list(std::int32_t first, std::int32_t count) {
    const DefaultFloatEnvironment environment;
    for (std::int32_t step = first; step < first + count; ++step) {
      for (const Listed& listed : list_) {
        run_timed(*listed.pass, [&] { execute(*listed.pass, listed.indices, step); });
      }
    }
  }

  void execute(const Prepared& p, std::int64_t count, std::int32_t step) {
    if (splits(p, count)) {
      const int portions = p.uneven ? kPortions : 1, pieces = pool_->threads();
      pool_->run([&](int piece) {
        for (int k = 0; k < portions; ++k) p.twin.execute(share(p, count, k * pieces + piece, portions * pieces), step);
      });
    } else {
      p.twin.execute({0, count}, step);
    }
  }

  std::unique_ptr<ref::ThreadPool> pool_;
  /// A pass and the number of indices to run.
  struct Listed {
    Prepared* pass;
    std::int64_t indices;
  };
  std::vector<Listed> list_;
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
