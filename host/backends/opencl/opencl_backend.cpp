#include "backends/opencl/opencl_backend.h"

#include <fmt/format.h>

#include <mutex>

#include "backends/interface/launch.h"
#include "backends/interface/probe.h"
#include "backends/interface/program_backend.h"
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

struct Prepared : PassClock {
  cl::Kernel kernel;
  std::vector<cl_uint> step_args;
  LaunchRules rules{};
  std::vector<Launch> launches_of_one_run;
  std::string where;
};

BackendInfo limited(BackendInfo info, const OpenclOptions& options) {
  info.compiles = true;
  if (options.lanes != 0) info.lanes = options.lanes;
  if (options.memory_bytes != 0) info.memory_bytes = options.memory_bytes;
  if (options.max_buffer_bytes != 0) info.max_buffer_bytes = options.max_buffer_bytes;
  return info;
}

/// Waiting for a write costs as much as a pass: the values of small ones are copied, and the next read or finish() waits.
constexpr std::size_t kStagedBytes = 1 << 16, kStaged = 256;

std::string place_of(const BackendInfo& info) { return fmt::format("{} ({})", info.name, info.device); }

class OpenclBackend final : public ProgramBackend<opencl::DeviceMemory, Prepared, float> {
 public:
  OpenclBackend(const cl::Device& device, const BackendInfo& info, const OpenclOptions& options)
      : ProgramBackend(limited(info, options), place_of(info), sizeof(float)),
        device_(device),
        shared_(opencl::context_of(device)),
        context_(shared_->context()),
        queue_(context_, device, cl_command_queue_properties{0}),
        kernels_(shared_, device, all_files(options), where()),
        local_size_(options.local_size) {
    const int lanes = this->info().lanes;
    if (lanes != 1 && lanes != 16) {
      throw Error(ErrorCode::bad_input, fmt::format("lanes is {}; allowed are 1 and 16", lanes));
    }
  }

  OpenclBackend(const OpenclBackend&) = delete;
  OpenclBackend& operator=(const OpenclBackend&) = delete;
  ~OpenclBackend() override {
    try {
      queue_.finish();            // staged_ is read until then
    } catch (const cl::Error&) {  // a destructor has nobody to tell
    }
  }

  void extend(const Program* before, const Program& extension) override {
    ProgramBackend::extend(before, extension);
    spare_kernels_.clear();
  }

  void compile(const Program& program) override {
    for (const auto* passes : {&program.step, &program.look, &program.force, &program.rates, &program.status}) {
      for (const Pass& pass : *passes)
        kernels_.program(pass.kernel, pass.defines, pass.shape == Shape::items ? 1 : info().lanes);
    }
  }
  void compile_beside(const Program& program) override {
    try {
      compile(program);
    } catch (const Error&) {  // load() meets it again
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
    guarded(ErrorCode::internal, where(), [&] { queue_.finish(); });
    staged_.clear();
  }

  void read_into(BufferId id, void* out) override {
    const std::size_t bytes = bytes_of(id);
    if (bytes == 0) return;
    guarded(ErrorCode::internal, where(), [&] { queue_.enqueueReadBuffer(memory(id), CL_TRUE, 0, bytes, out); });
    staged_.clear();
  }

  void profile(bool on) override {
    begin_change();
    if (on == profiling()) return;
    ProgramBackend::profile(on);
    guarded(ErrorCode::internal, where(), [&] {
      queue_ = cl::CommandQueue(context_, device_, on ? cl_command_queue_properties{CL_QUEUE_PROFILING_ENABLE} : 0);
    });
  }

 protected:
  void begin_change() override {
    finish();
    collect_events();
  }

  /// Keeps the kernel objects: making them takes longer than setting their arguments.
  void release(PassTable<Prepared>& passes) override {
    passes.for_each([&](const Pass& pass, Prepared& p) {
      spare_kernels_.emplace(KernelKey{pass.kernel, pass.defines}, std::move(p.kernel));
    });
    passes.clear();
  }

  void copy_values(BufferId from, BufferId to) override {
    guarded(ErrorCode::internal, where(), [&] { queue_.enqueueCopyBuffer(memory(from), memory(to), 0, 0, bytes_of(from)); });
  }
  void write_from(BufferId id, const void* values) override {
    store(id).written = true;
    const std::size_t bytes = bytes_of(id);
    if (bytes == 0) return;
    if (bytes > kStagedBytes) {
      guarded(ErrorCode::internal, where(), [&] { queue_.enqueueWriteBuffer(memory(id), CL_TRUE, 0, bytes, values); });
      staged_.clear();
      return;
    }
    if (staged_.size() == kStaged) finish();
    const auto* first = static_cast<const std::byte*>(values);
    const std::vector<std::byte>& copy = staged_.emplace_back(first, first + bytes);
    guarded(ErrorCode::internal, where(), [&] { queue_.enqueueWriteBuffer(memory(id), CL_FALSE, 0, bytes, copy.data()); });
  }

  std::vector<opencl::DeviceMemory> make_stores(const Program* before, const Program& next,
                                                std::vector<opencl::DeviceMemory> old) override {
    opencl::Upload upload(queue_);
    auto stores = remake(
        before, next, std::move(old), [&](std::size_t, const Buffer& buffer, const Buffer* same, opencl::DeviceMemory* given) {
          opencl::DeviceMemory memory;
          guarded(ErrorCode::bad_input, place(buffer), [&] {
            if (same == nullptr) {
              memory = opencl::load_memory(context_, upload, buffer);
              if (before == nullptr) upload.finish();  // so that an allocation failure names the buffer
            } else {
              memory = opencl::patch_memory(context_, upload, {same, &buffer, info().max_buffer_bytes}, *given);
            }
          });
          return memory;
        });
    guarded(ErrorCode::internal, where(), [&] { upload.finish(); });
    return stores;
  }

  Prepared prepare(const Pass& pass) override {
    check_pass(pass, table().size());
    const int lanes = pass.shape == Shape::items ? 1 : info().lanes;
    Prepared p;
    p.where = fmt::format("pass \"{}\" (kernel {}{}{}) on {}", pass.label, pass.kernel, pass.defines.empty() ? "" : ", ",
                          defines_text(pass.defines), where());
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
      p.rules = {info().lanes, local_size_, largest, info().kind == "cpu"};
      p.launches_of_one_run = plan_launches(pass, p.rules);
    });
    return p;
  }

 private:
  using KernelKey = std::pair<std::string, std::vector<std::pair<std::string, int>>>;
  struct Timed {
    Prepared* pass;
    cl::Event event;
  };

  [[nodiscard]] std::string place(const Buffer& buffer) const {
    return fmt::format("buffer \"{}\" {} on {}", buffer.name, buffer.shape, where());
  }

  cl::Kernel make_kernel(const Pass& pass, int lanes) {
    const auto spare = spare_kernels_.find({pass.kernel, pass.defines});
    if (spare == spare_kernels_.end()) return kernels_.make(pass.kernel, pass.defines, lanes);
    cl::Kernel kernel = std::move(spare->second);
    spare_kernels_.erase(spare);
    return kernel;
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
        if (profiling()) {
          events_.push_back({&p, {}});
          event = &events_.back().event;
        }
        queue_.enqueueNDRangeKernel(p.kernel, launch.offset == 0 ? cl::NullRange : cl::NDRange(launch.offset),
                                    cl::NDRange(launch.global), cl::NDRange(launch.local), nullptr, event);
      }
    });
    if (profiling()) {
      ++p.launches;
      if (events_.size() >= 4096) {
        finish();
        collect_events();
      }
    }
  }

  void flush() {
    guarded(ErrorCode::internal, where(), [&] { queue_.flush(); });
  }

  /// Sums the times of finished events.
  void collect_events() {
    guarded(ErrorCode::internal, where(), [&] {
      for (const Timed& timed : events_) {
        const auto start = timed.event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
        const auto end = timed.event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
        timed.pass->seconds += 1e-9 * static_cast<double>(end - start);
      }
    });
    events_.clear();
  }

  cl::Buffer& memory(BufferId id) { return store(id).buffer; }

  cl::Device device_;
  std::shared_ptr<opencl::SharedContext> shared_;
  cl::Context context_;
  cl::CommandQueue queue_;
  opencl::KernelCache kernels_;
  const int local_size_;
  std::multimap<KernelKey, cl::Kernel> spare_kernels_;
  std::vector<Prepared*> list_;
  std::vector<Timed> events_;
  std::vector<std::vector<std::byte>> staged_;  ///< values of writes that nothing has waited for yet
};

/// On a processor the probe runs once in a process: it launches kernels, and a launch waits while another thread compiles.
std::string probe_once(OpenclBackend& backend, int index, const OpenclOptions& options) {
  if (backend.info().kind != "cpu" || !options.extra_kernels.empty() || options.local_size != 0) return run_probe(backend);
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  static std::map<std::pair<int, int>, std::string> found;
  const std::pair device{index, backend.info().lanes};
  const auto known = found.find(device);
  return known != found.end() ? known->second : found.emplace(device, run_probe(backend)).first->second;
}

std::unique_ptr<Backend> open(const cl::Device& device, int index, const OpenclOptions& options) {
  auto backend = guarded(ErrorCode::bad_input, fmt::format("opening opencl:{}", index), [&] {
    return std::make_unique<OpenclBackend>(device, opencl::describe_device(device, index), options);
  });
  backend->set_probe_result(options.probe ? probe_once(*backend, index, options) : "not probed");
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
