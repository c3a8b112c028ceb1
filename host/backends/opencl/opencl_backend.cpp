#include "backends/opencl/opencl_backend.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "backends/interface/buffer_checks.h"
#include "backends/interface/float_environment.h"
#include "backends/interface/launch.h"
#include "backends/interface/pass_table.h"
#include "backends/interface/probe.h"
#include "backends/opencl/device_memory.h"
#include "backends/opencl/devices.h"
#include "backends/opencl/kernel_cache.h"
#include "backends/opencl/kernel_text.h"
#include "backends/opencl/opencl.h"
#include "backends/opencl/shared_context.h"

namespace pliant {
namespace {

using opencl::guarded;

opencl::Files all_files(const OpenclOptions& options) {
  opencl::Files files = options.extra_kernels;
  files.insert(kernel_files().begin(), kernel_files().end());
  return files;
}

class OpenclBackend final : public Backend {
 public:
  OpenclBackend(const cl::Device& device, BackendInfo info, const OpenclOptions& options)
      : info_(std::move(info)),
        where_(fmt::format("{} ({})", info_.name, info_.device)),
        device_(device),
        shared_(opencl::context_of(device)),
        context_(shared_->context()),
        queue_(context_, device, cl_command_queue_properties{0}),
        kernels_(shared_, device, all_files(options), where_),
        local_size_(options.local_size) {
    info_.compiles = true;
    if (options.lanes != 0) info_.lanes = options.lanes;
    if (options.memory_bytes != 0) info_.memory_bytes = options.memory_bytes;
    if (options.max_buffer_bytes != 0) info_.max_buffer_bytes = options.max_buffer_bytes;
    if (info_.lanes != 1 && info_.lanes != 16)
      throw Error(ErrorCode::bad_input, fmt::format("lanes is {}; allowed are 1 and 16", info_.lanes));
  }

  [[nodiscard]] const BackendInfo& info() const override { return info_; }
  void set_probe_result(bool bit_exact, const std::string& reason) {
    info_.bit_exact = bit_exact;
    info_.tolerance_reason = reason;
  }

  void load(const Program& program) override {
    table_.load(program);
    check_memory(table_, sizeof(float), info_.max_buffer_bytes, info_.memory_bytes, where_);
    finish();
    events_.clear();
    passes_.clear();
    extension_passes_.clear();
    memory_.clear();
    extension_.clear();
    bring(nullptr, program, memory_, passes_);
  }

  void update(const Program& loaded, const Program& next) override {
    finish();
    collect_events();
    keep_kernels(passes_);
    keep_kernels(extension_passes_);  // its arguments were buffers of the old program; its own stay for extend()
    table_.load(next);
    check_memory(table_, sizeof(float), info_.max_buffer_bytes, info_.memory_bytes, where_);
    bring(&loaded, next, memory_, passes_);
  }

  void extend(const Program* before, const Program& extension) override {
    finish();
    collect_events();
    keep_kernels(extension_passes_);
    check_extension(extension, memory_.size());
    table_.extend(extension);
    check_memory(table_, sizeof(float), info_.max_buffer_bytes, info_.memory_bytes, where_);
    bring(before, extension, extension_, extension_passes_);
    spare_kernels_.clear();
  }

  void compile(const Program& program) override {
    for (const auto* passes : {&program.step, &program.look, &program.force, &program.status}) {
      for (const Pass& pass : *passes) kernels_.make(pass.kernel, pass.defines, pass.shape == Shape::items ? 1 : info_.lanes);
    }
  }

  void run(const std::vector<Pass>& passes, std::int32_t first, std::int32_t count, std::int64_t origin) override {
    list_.clear();
    for (const Pass& pass : passes) list_.push_back(&prepared(pass));
    for (std::int32_t step = first; step < first + count; ++step) {
      for (std::size_t p = 0; p < list_.size(); ++p) {
        if (passes[p].runs_in(origin + step)) enqueue(passes[p], *list_[p], step);
      }
    }
    flush();
  }
  void run(const Pass& pass, std::int32_t step_in_batch) override {
    enqueue(pass, prepared(pass), step_in_batch);
    flush();
  }
  void finish() override {
    guarded(ErrorCode::internal, where_, [&] { queue_.finish(); });
  }

  void copy(BufferId from, BufferId to) override {
    check_copy(row(from), row(to));
    const std::size_t bytes = row(from).values() * 4;
    if (bytes == 0 || from == to) return;
    guarded(ErrorCode::internal, where_, [&] { queue_.enqueueCopyBuffer(memory(from), memory(to), 0, 0, bytes); });
  }

  std::vector<double> read_reals(BufferId id) override {
    check_type(row(id), false);
    const std::size_t count = row(id).values();
    const auto values = std::make_unique_for_overwrite<float[]>(count);
    read_into(id, values.get());
    return {values.get(), values.get() + count};
  }
  std::vector<std::int32_t> read_ints(BufferId id) override {
    check_type(row(id), true);
    return read<std::int32_t>(id);
  }
  std::vector<std::uint8_t> read_bytes(BufferId id) override { return read<std::uint8_t>(id); }
  void read_into(BufferId id, void* out) override {
    const std::size_t bytes = row(id).values() * 4;
    if (bytes == 0) return;
    guarded(ErrorCode::internal, where_, [&] { queue_.enqueueReadBuffer(memory(id), CL_TRUE, 0, bytes, out); });
  }
  void write_reals(BufferId id, const std::vector<double>& values) override {
    check_type(row(id), false);
    const DefaultFloatEnvironment environment;
    write(id, rounded(values));
  }
  void write_ints(BufferId id, const std::vector<std::int32_t>& values) override {
    check_type(row(id), true);
    write(id, values);
  }

  void profile(bool on) override {
    finish();
    collect_events();
    if (on == profiling_) return;
    profiling_ = on;
    guarded(ErrorCode::internal, where_, [&] {
      queue_ = cl::CommandQueue(context_, device_, on ? cl_command_queue_properties{CL_QUEUE_PROFILING_ENABLE} : 0);
    });
  }
  std::vector<PassTime> take_profile() override {
    finish();
    collect_events();
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
  struct Prepared {
    cl::Kernel kernel;
    std::vector<cl_uint> step_args;
    LaunchRules rules{};
    std::vector<Launch> launches_of_one_run;
    std::string where;
    double seconds = 0;
    std::int64_t launches = 0;
  };
  struct Timed {
    Prepared* pass;
    cl::Event event;
  };

  static std::vector<float> rounded(const std::vector<double>& values) {
    std::vector<float> result(values.size());
    round_reals(values, result.data());
    return result;
  }

  [[nodiscard]] std::string place(const Buffer& buffer) const {
    return fmt::format("buffer \"{}\" {} on {}", buffer.name, buffer.shape, where_);
  }

  using KernelKey = std::pair<std::string, std::vector<std::pair<std::string, int>>>;

  /// Making kernel objects takes longer than setting their arguments.
  void keep_kernels(PassTable<Prepared>& passes) {
    passes.for_each([&](const Pass& pass, Prepared& p) {
      spare_kernels_.emplace(KernelKey{pass.kernel, pass.defines}, std::move(p.kernel));
    });
    passes.clear();
  }
  cl::Kernel make_kernel(const Pass& pass, int lanes) {
    const auto spare = spare_kernels_.find({pass.kernel, pass.defines});
    if (spare == spare_kernels_.end()) return kernels_.make(pass.kernel, pass.defines, lanes);
    cl::Kernel kernel = std::move(spare->second);
    spare_kernels_.erase(spare);
    return kernel;
  }

  /// The buffers of `next` with their initial values, from those of `before` where there are some, and its passes.
  void bring(const Program* before, const Program& next, std::vector<opencl::DeviceMemory>& memory,
             PassTable<Prepared>& passes) {
    const DefaultFloatEnvironment environment;
    std::vector<opencl::DeviceMemory> old = std::move(memory);
    memory.clear();
    memory.resize(next.buffers.size());
    opencl::Upload upload(queue_);
    for (std::size_t i = 0; i < memory.size(); ++i) {
      const Buffer& buffer = next.buffers[i];
      const Buffer* same = before != nullptr ? find_same(before->buffers, buffer, i) : nullptr;
      guarded(ErrorCode::bad_input, place(buffer), [&] {
        if (same == nullptr) {
          memory[i] = opencl::load_memory(context_, upload, buffer);
          if (before == nullptr) upload.finish();  // so that an allocation failure names the buffer
        } else {
          memory[i] = opencl::patch_memory(context_, upload, {same, &buffer, info_.max_buffer_bytes},
                                           old[static_cast<std::size_t>(same - before->buffers.data())]);
        }
      });
    }
    guarded(ErrorCode::internal, where_, [&] { upload.finish(); });
    passes.load(next, [this](const Pass& pass) { return prepare(pass); });
    finish();
  }

  Prepared prepare(const Pass& pass) {
    check_pass(pass, table_.size());
    const int lanes = pass.shape == Shape::items ? 1 : info_.lanes;
    Prepared p;
    p.where = fmt::format("pass \"{}\" (kernel {}{}{}) on {}", pass.label, pass.kernel, pass.defines.empty() ? "" : ", ",
                          defines_text(pass.defines), where_);
    p.kernel = make_kernel(pass, lanes);
    guarded(ErrorCode::internal, p.where, [&] {
      const auto parameters = p.kernel.getInfo<CL_KERNEL_NUM_ARGS>();
      if (pass.args.size() != parameters) {
        throw Error(ErrorCode::internal,
                    fmt::format("{} arguments for {} parameters: {}", pass.args.size(), parameters, p.where));
      }
      for (cl_uint i = 0; i < parameters; ++i) {
        const Arg& arg = pass.args[i];
        if (arg.index() == 0) {
          p.kernel.setArg(i, memory(std::get<0>(arg)));
        } else if (arg.index() == 1) {
          p.kernel.setArg(i, static_cast<cl_float>(std::get<1>(arg)));
        } else if (arg.index() == 2) {
          p.kernel.setArg(i, cl_int{std::get<2>(arg)});
        } else {
          p.step_args.push_back(i);
        }
      }
      const std::size_t largest = p.kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device_);
      p.rules = {info_.lanes, local_size_, largest, info_.kind == "cpu"};
      p.launches_of_one_run = plan_launches(pass, p.rules);
    });
    return p;
  }

  Prepared& prepared(const Pass& pass) {
    auto& table = extension_passes_.holds(pass) ? extension_passes_ : passes_;
    return table.get(pass, [this](const Pass& p) { return prepare(p); });
  }

  void enqueue(const Pass& pass, Prepared& p, cl_int step) {
    const std::int64_t indices = pass.indices();
    if (indices == 0) return;
    guarded(ErrorCode::internal, p.where, [&] {
      for (const cl_uint i : p.step_args) p.kernel.setArg(i, step);
      const bool listed = pass.active != nullptr && pass.shape != Shape::items;
      const auto some = listed ? std::vector{plan_listed(indices, p.rules)} : std::vector<Launch>();
      for (const Launch& launch : listed ? some : p.launches_of_one_run) {
        cl::Event* event = nullptr;
        if (profiling_) {
          events_.push_back({&p, {}});
          event = &events_.back().event;
        }
        queue_.enqueueNDRangeKernel(p.kernel, launch.offset == 0 ? cl::NullRange : cl::NDRange(launch.offset),
                                    cl::NDRange(launch.global), cl::NDRange(launch.local), nullptr, event);
      }
    });
    if (profiling_) {
      ++p.launches;
      if (events_.size() >= 4096) {
        finish();
        collect_events();
      }
    }
  }

  void flush() {
    guarded(ErrorCode::internal, where_, [&] { queue_.flush(); });
  }

  /// Sums the times of finished events.
  void collect_events() {
    guarded(ErrorCode::internal, where_, [&] {
      for (const Timed& timed : events_) {
        const auto start = timed.event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
        const auto end = timed.event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
        timed.pass->seconds += 1e-9 * static_cast<double>(end - start);
      }
    });
    events_.clear();
  }

  template <class T>
  std::vector<T> read(BufferId id) {
    std::vector<T> values(row(id).values() * 4 / sizeof(T));
    if (values.empty()) return values;
    guarded(ErrorCode::internal, where_,
            [&] { queue_.enqueueReadBuffer(memory(id), CL_TRUE, 0, values.size() * sizeof(T), values.data()); });
    return values;
  }
  template <class T>
  void write(BufferId id, const std::vector<T>& values) {
    check_size(row(id), values.size());
    device_memory(id).written = true;
    if (values.empty()) return;
    guarded(ErrorCode::internal, where_,
            [&] { queue_.enqueueWriteBuffer(memory(id), CL_TRUE, 0, values.size() * sizeof(T), values.data()); });
  }

  const Buffer& row(BufferId id) const {
    check_id(id, table_.size());
    return table_.row(id);
  }
  opencl::DeviceMemory& device_memory(BufferId id) {
    const auto i = static_cast<std::size_t>(id);
    return i < memory_.size() ? memory_[i] : extension_.at(i - memory_.size());
  }
  cl::Buffer& memory(BufferId id) { return device_memory(id).buffer; }

  BackendInfo info_;
  const std::string where_;
  cl::Device device_;
  std::shared_ptr<opencl::SharedContext> shared_;
  cl::Context context_;
  cl::CommandQueue queue_;
  opencl::KernelCache kernels_;
  const int local_size_;
  BufferTable table_;
  std::vector<opencl::DeviceMemory> memory_, extension_;
  std::multimap<KernelKey, cl::Kernel> spare_kernels_;
  PassTable<Prepared> passes_, extension_passes_;
  std::vector<Prepared*> list_;
  std::vector<Timed> events_;
  bool profiling_ = false;
};

std::unique_ptr<Backend> open(const cl::Device& device, int index, const OpenclOptions& options) {
  const std::string where = fmt::format("opening opencl:{}", index);
  auto backend = guarded(ErrorCode::bad_input, where, [&] {
    return std::make_unique<OpenclBackend>(device, opencl::describe_device(device, index), options);
  });
  if (options.probe) {
    const std::string difference = run_probe(*backend);
    backend->set_probe_result(difference.empty(), difference);
  } else {
    backend->set_probe_result(false, "not probed");
  }
  return backend;
}

}  // namespace

std::unique_ptr<Backend> make_opencl_backend(int index, const OpenclOptions& options) {
  const std::vector<cl::Device> devices = opencl::all_devices();
  if (devices.empty()) {
    throw Error(
        ErrorCode::bad_input,
        "there is no OpenCL device: the OpenCL loader found no platform, or no platform has a device. Install a driver, for "
        "example "
        "PoCL for the processor (Debian: apt install pocl-opencl-icd), or use the backend \"cpu\"" +
            (opencl_remark().empty() ? "" : ". " + opencl_remark()));
  }
  if (index < 0 || static_cast<std::size_t>(index) >= devices.size()) {
    throw Error(ErrorCode::bad_input,
                fmt::format("there is no OpenCL device {}: allowed are opencl:0 to opencl:{}", index, devices.size() - 1));
  }
  return open(devices[static_cast<std::size_t>(index)], index, options);
}

}  // namespace pliant
