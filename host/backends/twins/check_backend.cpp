#include "backends/twins/check_backend.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>

#include "backends/interface/buffer_checks.h"
#include "backends/interface/float_environment.h"
#include "backends/interface/pass_table.h"
#include "backends/interface/probe.h"
#include "backends/twins/check_buffer.h"
#include "backends/twins/prepared_twin.h"
#include "backends/twins/processor.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using ref::CheckBuffer;
using Clock = std::chrono::steady_clock;

constexpr int kWorlds = CheckBuffer::kWorlds;

/// A pass in both worlds, and the distinct buffers among its arguments.
struct Prepared {
  std::array<ref::PreparedTwin<float>, kWorlds> worlds;
  std::int64_t count = 0;
  std::vector<BufferId> buffers;
  double seconds = 0;
  std::int64_t launches = 0;

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

class CheckBackend final : public Backend {
 public:
  explicit CheckBackend(const CheckOptions& options)
      : registry_(options.registry != nullptr ? *options.registry : ref::registry()) {
    info_.name = "cpu:check";
    info_.device = ref::processor_name();
    info_.kind = "reference";
    info_.platform = "Pliant";
    info_.version = "C++ twins, float, every pass checked";
    info_.memory_bytes = info_.max_buffer_bytes = ref::physical_memory();
    info_.compute_units = 1;
    info_.single_thread = true;
  }

  [[nodiscard]] const BackendInfo& info() const override { return info_; }
  void set_probe_result(const std::string& difference) {
    info_.bit_exact = difference.empty();
    info_.tolerance_reason = difference;
  }

  void load(const Program& program) override {
    table_.load(program);
    extension_.clear();
    extension_passes_.clear();
    bring(program, buffers_, passes_);
  }

  void extend(const Program* /*before*/, const Program& extension) override {
    check_extension(extension, buffers_.size());
    table_.extend(extension);
    bring(extension, extension_, extension_passes_);
  }

  void run(const std::vector<Pass>& passes, std::int32_t first, std::int32_t count, std::int64_t origin) override {
    const DefaultFloatEnvironment environment;
    for (std::int32_t step = first; step < first + count; ++step) {
      for_each_buffer([](CheckBuffer& b) { b.begin_step(); });
      const std::string in = list_name(passes, origin + step);
      for (std::size_t p = 0; p < passes.size(); ++p) {
        if (passes[p].runs_in(origin + step)) launch(passes[p], step, fmt::format("pass {}", p), in);
      }
      for_each_buffer([&](const CheckBuffer& b) { check_untouched(b, in); });
    }
  }
  void run(const Pass& pass, std::int32_t step_in_batch) override {
    const DefaultFloatEnvironment environment;
    launch(pass, step_in_batch, "the pass", fmt::format("step {} of its batch", step_in_batch + 1));
  }
  void finish() override {}

  void copy(BufferId from, BufferId to) override {
    check_copy(table_.row(from), table_.row(to));
    buffer(to).write(buffer(from).bytes(0));
  }

  std::vector<double> read_reals(BufferId id) override {
    const std::vector<float> values = read<float>(id, false);
    return {values.begin(), values.end()};
  }
  std::vector<std::int32_t> read_ints(BufferId id) override { return read<std::int32_t>(id, true); }
  void write_reals(BufferId id, const std::vector<double>& values) override {
    CheckBuffer& target = checked(id, values.size(), false);
    const DefaultFloatEnvironment environment;
    std::vector<float> rounded(values.size());
    round_reals(values, rounded.data());
    target.write(rounded.data());
  }
  void write_ints(BufferId id, const std::vector<std::int32_t>& values) override {
    checked(id, values.size(), true).write(values.data());
  }
  std::vector<std::uint8_t> read_bytes(BufferId id) override {
    const CheckBuffer& b = written(id);
    return {b.bytes(0), b.bytes(0) + 4 * b.values()};
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
  void bring(const Program& program, std::vector<CheckBuffer>& buffers, PassTable<Prepared>& passes) {
    const DefaultFloatEnvironment environment;
    check_memory(table_, 4 * kWorlds, info_.max_buffer_bytes, info_.memory_bytes, info_.name);
    passes.clear();
    buffers.clear();
    buffers.reserve(program.buffers.size());
    for (const Buffer& row : program.buffers) buffers.emplace_back(row, program.first + static_cast<BufferId>(buffers.size()));
    passes.load(program, [this](const Pass& pass) { return prepare(pass); });
  }

  Prepared prepare(const Pass& pass) {
    Prepared p;
    p.count = pass.count;
    for (int world = 0; world < kWorlds; ++world) {
      p.worlds[static_cast<std::size_t>(world)] =
          ref::prepare_twin<float>(registry_, pass, table_.size(), [&](BufferId id) { return buffer(id).argument(world); });
    }
    for (const Arg& arg : pass.args) {
      const BufferId* id = std::get_if<0>(&arg);
      if (id != nullptr && std::find(p.buffers.begin(), p.buffers.end(), *id) == p.buffers.end()) p.buffers.push_back(*id);
    }
    return p;
  }

  /// Name of the list that a pass belongs to, for messages.
  [[nodiscard]] std::string list_name(const std::vector<Pass>& passes, std::int64_t step) const {
    const auto& [own, extension] = table_.parts();
    if (own != nullptr && &passes == &own->force) return "the list of the forces";
    if (own != nullptr && &passes == &own->look) return "the list of the look";
    if (own != nullptr && &passes == &own->status) return "the list of the status";
    if (extension != nullptr && &passes == &extension->step) return "the list of the surface";
    return fmt::format("step {}", step + 1);
  }

  void launch(const Pass& pass, std::int32_t step, const std::string& number, const std::string& in) {
    auto& table = extension_passes_.holds(pass) ? extension_passes_ : passes_;
    Prepared& p = table.get(pass, [this](const Pass& of) { return prepare(of); });
    before_.resize(std::max(before_.size(), p.buffers.size()));
    for (std::size_t i = 0; i < p.buffers.size(); ++i) {
      const CheckBuffer& b = buffer(p.buffers[i]);
      if (!b.writable()) continue;
      for (int world = 0; world < kWorlds; ++world) before_[i][static_cast<std::size_t>(world)] = b.image(world);
    }
    p.count = pass.indices();
    const auto start = Clock::now();
    p.execute(0, step);
    if (profiling_) {
      p.seconds += std::chrono::duration<double>(Clock::now() - start).count();
      ++p.launches;
    }
    p.execute(1, step);
    check({pass, p, step, fmt::format("{} ({}, {}) in {}", number, pass.kernel, pass.label, in)});
  }

  void check(const Launch& launch) {
    const std::vector<BufferId>& ids = launch.prepared.buffers;
    for (const BufferId id : ids) check_bounds(buffer(id), launch.name + " wrote");
    for (const BufferId id : ids) check_kept(buffer(id), launch.name + " changed");
    for (std::size_t i = 0; i < ids.size(); ++i) {
      CheckBuffer& b = buffer(ids[i]);
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
      const CheckBuffer& b = buffer(ids[i]);
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
        buffer(ids[i]).set_image(0, image);
      }
      launch.prepared.execute(0, launch.step_in_batch);
      return buffer(ids[result.buffer]).bits(0, result.index);
    };
    const std::string of = fmt::format("value {} of {} depends on it", result.index, buffer(ids[result.buffer]).name());
    const std::uint32_t without = result_with(0);
    std::size_t low = 0, high = unwritten.size();
    if (result_with(high) == without) return "read outside its buffers: " + of;
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (result_with(middle) == without ? low : high) = middle;
    }
    const Place& read = unwritten[low];
    const CheckBuffer& from = buffer(ids[read.buffer]);
    const bool inside = read.index >= 0 && read.index < from.values();
    return fmt::format("read value {} of {}, {}: {}", read.index, from.name(),
                       inside ? "which no pass had written" : fmt::format("outside its {} values", from.values()), of);
  }

  [[noreturn]] static void fail(const std::string& what) { throw Error(ErrorCode::internal, what); }

  template <class Value>
  std::vector<Value> read(BufferId id, bool ints) {
    const CheckBuffer& b = written(id);
    check_type(table_.row(id), ints);
    std::vector<Value> values(static_cast<std::size_t>(b.values()));
    if (!values.empty()) std::memcpy(values.data(), b.bytes(0), 4 * values.size());
    return values;
  }
  CheckBuffer& checked(BufferId id, std::size_t values, bool ints) {
    CheckBuffer& b = buffer(id);
    check_type(table_.row(id), ints);
    check_size(table_.row(id), values);
    return b;
  }
  /// For reads by the host, which must not read unwritten values either.
  const CheckBuffer& written(BufferId id) {
    const CheckBuffer& b = buffer(id);
    if (const auto index = b.unwritten()) {
      fail(fmt::format("the host read value {} of {}, which no pass had written", *index, b.name()));
    }
    return b;
  }
  CheckBuffer& buffer(BufferId id) {
    check_id(id, buffers_.size() + extension_.size());
    const auto i = static_cast<std::size_t>(id);
    return i < buffers_.size() ? buffers_[i] : extension_[i - buffers_.size()];
  }
  template <class Visit>
  void for_each_buffer(Visit&& visit) {
    for (auto* list : {&buffers_, &extension_}) std::for_each(list->begin(), list->end(), visit);
  }

  BackendInfo info_;
  const ref::Registry& registry_;
  BufferTable table_;
  std::vector<CheckBuffer> buffers_, extension_;
  PassTable<Prepared> passes_, extension_passes_;
  std::vector<std::array<ref::WorldImage, kWorlds>> before_;  ///< contents of a pass's buffers before it ran
  bool profiling_ = false;
};

}  // namespace

std::unique_ptr<Backend> make_check_backend(const CheckOptions& options) {
  ref::require_fma();
  auto backend = std::make_unique<CheckBackend>(options);
  if (options.probe) backend->set_probe_result(run_probe(*backend));
  return backend;
}

}  // namespace pliant
