#include "backends/twins/check_backend.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "backends/interface/probe.h"
#include "backends/twins/check_buffer.h"
#include "backends/twins/twin_backend.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using ref::CheckBuffer;

constexpr int kWorlds = CheckBuffer::kWorlds;

/// A pass in both worlds, and the distinct buffers among its arguments.
struct Prepared : PassClock {
  std::array<ref::PreparedTwin<float>, kWorlds> worlds;
  std::int64_t count = 0;
  std::vector<BufferId> buffers;

  void execute(int world, std::int32_t step) const { worlds[static_cast<std::size_t>(world)].execute({0, count}, step); }
};

/// One launch, for messages.
struct Launch {
  const Pass& pass;
  const Prepared& prepared;
  std::int32_t step_in_batch;
  std::string name;  ///< "pass 7 (node_update, list nodes) in step 13"
};

/// A value of one of a pass's buffers.
struct Place {
  std::size_t buffer;  ///< which of Prepared::buffers
  std::ptrdiff_t index;
};

class CheckBackend final : public ref::TwinBackend<CheckBuffer, Prepared, float> {
 public:
  explicit CheckBackend(const CheckOptions& options) : TwinBackend(info_of(), kWorlds * sizeof(float), options.registry) {}

  /// Loads anew, so that nothing counts as written.
  void update(const Program& /*loaded*/, const Program& next) override { load(next); }

  void run(const std::vector<Pass>& passes, std::int32_t first, std::int32_t count, std::int64_t origin) override {
    const DefaultFloatEnvironment environment;
    for (std::int32_t step = first; step < first + count; ++step) {
      for_each_store([](CheckBuffer& b) { b.begin_step(); });
      const std::string in = list_name(passes, origin + step);
      for (std::size_t p = 0; p < passes.size(); ++p) {
        if (passes[p].runs_in(origin + step)) launch(passes[p], step, fmt::format("pass {}", p), in);
      }
      for_each_store([&](const CheckBuffer& b) { check_untouched(b, in); });
    }
  }
  void run(const Pass& pass, std::int32_t step_in_batch) override {
    const DefaultFloatEnvironment environment;
    launch(pass, step_in_batch, "the pass", fmt::format("step {} of its batch", step_in_batch + 1));
  }
  /// The host must not read unwritten values either.
  void read_into(BufferId id, void* out) override {
    const CheckBuffer& b = store(id);
    if (const auto index = b.unwritten()) {
      fail(fmt::format("the host read value {} of {}, which no pass had written", *index, b.name()));
    }
    if (b.values() > 0) std::memcpy(out, b.bytes(0), bytes_of(id));
  }

 protected:
  void copy_values(BufferId from, BufferId to) override { store(to).write(store(from).bytes(0)); }
  void write_from(BufferId id, const void* values) override { store(id).write(values); }
  std::vector<CheckBuffer> make_stores(const Program* /*before*/, const Program& next,
                                       std::vector<CheckBuffer> /*old*/) override {
    return remake(nullptr, next, {}, [&next](std::size_t i, const Buffer& row, const Buffer*, CheckBuffer*) {
      return CheckBuffer(row, next.first + static_cast<BufferId>(i));
    });
  }
  Prepared prepare(const Pass& pass) override {
    Prepared p;
    p.count = pass.count;
    for (int world = 0; world < kWorlds; ++world) {
      p.worlds[static_cast<std::size_t>(world)] = twin_of(pass, [&](BufferId id) { return store(id).argument(world); });
    }
    for (const Arg& arg : pass.args) {
      const BufferId* id = std::get_if<0>(&arg);
      if (id != nullptr && std::find(p.buffers.begin(), p.buffers.end(), *id) == p.buffers.end()) p.buffers.push_back(*id);
    }
    return p;
  }

 private:
  static BackendInfo info_of() {
    BackendInfo info = ref::twin_info("cpu:check", "C++ twins, float, every pass checked");
    info.compute_units = 1;
    info.single_thread = true;
    return info;
  }

  /// Name of the list that a pass belongs to, for messages.
  [[nodiscard]] std::string list_name(const std::vector<Pass>& passes, std::int64_t step) const {
    const auto& [own, extension] = table().parts();
    if (own != nullptr && &passes == &own->force) return "the list of the forces";
    if (own != nullptr && &passes == &own->rates) return "the list of the viscous forces";
    if (own != nullptr && &passes == &own->look) return "the list of the contact search";
    if (own != nullptr && &passes == &own->status) return "the list of the status";
    if (extension != nullptr && &passes == &extension->step) return "the list of the surface";
    return fmt::format("step {}", step + 1);
  }

  void launch(const Pass& pass, std::int32_t step, const std::string& number, const std::string& in) {
    Prepared& p = prepared(pass);
    before_.resize(std::max(before_.size(), p.buffers.size()));
    for (std::size_t i = 0; i < p.buffers.size(); ++i) {
      const CheckBuffer& b = store(p.buffers[i]);
      if (!b.writable()) continue;
      for (int world = 0; world < kWorlds; ++world) before_[i][static_cast<std::size_t>(world)] = b.image(world);
    }
    p.count = pass.indices();
    run_timed(p, [&] { p.execute(0, step); });
    p.execute(1, step);
    check({pass, p, step, fmt::format("{} ({}, {}) in {}", number, pass.kernel, pass.label, in)});
  }

  void check(const Launch& launch) {
    const std::vector<BufferId>& ids = launch.prepared.buffers;
    for (const BufferId id : ids) check_bounds(store(id), launch.name + " wrote");
    for (const BufferId id : ids) check_kept(store(id), launch.name + " changed");
    for (std::size_t i = 0; i < ids.size(); ++i) {
      CheckBuffer& b = store(ids[i]);
      if (const auto index = b.doubtful()) fail(launch.name + " " + blame(launch, {i, *index}));
      b.note_written();
    }
  }

  static void check_bounds(const CheckBuffer& b, const std::string& who) {
    const auto index = b.written_outside();
    if (index) fail(fmt::format("{} value {} of {}, outside its {} values", who, *index, b.name(), b.values()));
  }
  static void check_kept(const CheckBuffer& b, const std::string& who) {
    const auto index = b.changed();
    if (!index) return;
    fail(fmt::format("{} value {} of {}, {}", who, *index, b.name(),
                     b.writable() ? "which lies in its end that no pass writes" : "which only the host writes"));
  }
  /// Checked after all passes, which may have written to buffers other than their arguments.
  static void check_untouched(const CheckBuffer& b, const std::string& in) {
    const std::string who = "a pass in " + in + " that does not name it as an argument changed";
    check_bounds(b, who);
    check_kept(b, who);
    const auto index = b.doubtful();
    if (index) fail(fmt::format("{} value {} of {}", who, *index, b.name()));
  }

  /// Finds the unwritten value that the result depends on: repeats the pass in world 0 with the input of world 1, in which
  /// the first few differing values are taken from world 0. Bisection yields the first one that affects the result.
  std::string blame(const Launch& launch, const Place& result) {
    const std::vector<BufferId>& ids = launch.prepared.buffers;
    std::vector<std::array<ref::WorldImage, kWorlds>> found(ids.size());
    std::vector<Place> unwritten;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const CheckBuffer& b = store(ids[i]);
      found[i] = b.writable() ? before_[i] : std::array<ref::WorldImage, kWorlds>{b.image(0), b.image(1)};
      for (std::ptrdiff_t k = -CheckBuffer::kZone; k < b.values() + CheckBuffer::kZone; ++k) {
        if (CheckBuffer::bits_in(found[i][0], k) != CheckBuffer::bits_in(found[i][1], k)) unwritten.push_back({i, k});
      }
    }
    const auto result_with = [&](std::size_t count) {
      for (std::size_t i = 0; i < ids.size(); ++i) {
        ref::WorldImage image = found[i][1];
        for (std::size_t k = 0; k < count; ++k) {
          if (unwritten[k].buffer != i) continue;
          const std::ptrdiff_t at = 4 * (unwritten[k].index + CheckBuffer::kZone);
          std::copy_n(found[i][0].begin() + at, 4, image.begin() + at);
        }
        store(ids[i]).set_image(0, image);
      }
      launch.prepared.execute(0, launch.step_in_batch);
      return store(ids[result.buffer]).bits(0, result.index);
    };
    const std::string of = fmt::format("value {} of {} depends on it", result.index, store(ids[result.buffer]).name());
    const std::uint32_t without = result_with(0);
    std::size_t low = 0, high = unwritten.size();
    if (result_with(high) == without) return "read outside its buffers: " + of;
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (result_with(middle) == without ? low : high) = middle;
    }
    const Place& read = unwritten[low];
    const CheckBuffer& from = store(ids[read.buffer]);
    const bool inside = read.index >= 0 && read.index < from.values();
    return fmt::format("read value {} of {}, {}: {}", read.index, from.name(),
                       inside ? "which no pass had written" : fmt::format("outside its {} values", from.values()), of);
  }

  [[noreturn]] static void fail(const std::string& what) { throw Error(ErrorCode::internal, what); }

  std::vector<std::array<ref::WorldImage, kWorlds>> before_;  ///< contents of a pass's buffers before it ran
};

}  // namespace

std::unique_ptr<Backend> make_check_backend(const CheckOptions& options) {
  ref::require_fma();
  auto backend = std::make_unique<CheckBackend>(options);
  if (options.probe) backend->set_probe_result(run_probe(*backend));
  return backend;
}

}  // namespace pliant
