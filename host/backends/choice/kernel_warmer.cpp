#include "backends/choice/kernel_warmer.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <exception>
#include <mutex>
#include <set>
#include <thread>

#include "backends/interface/buffer_bytes.h"
#include "backends/interface/float_environment.h"
#include "backends/interface/launch.h"
#include "backends/interface/pass_table.h"
#include "backends/opencl/opencl_backend.h"
#include "pliant/error.h"

namespace pliant {
namespace {

constexpr std::int64_t kListed = 16;    ///< indices of a list that is run: a work-group or two, whose size lists have in common
constexpr std::size_t kLargest = 4096;  ///< more than any preferred work-group size
/// A first launch takes 1 ms from the cache on disk and 0.1 s or more without [s].
constexpr double kCached = 0.04;
constexpr int kEnough = 10;                ///< launches that show that the cache has what scenes need
constexpr std::size_t kSmallGrid = 65535;  ///< PoCL 3.1 compiles launches of at most this size by themselves

template <class Lists>
auto lists_of(Lists& program) {
  return std::array{&program.step, &program.look, &program.force, &program.rates, &program.status};
}

/// The launches of a pass for which PoCL compiles, as texts.
std::vector<std::string> variants_of(const Pass& pass, int device, const BackendInfo& info) {
  const LaunchRules rules{info.lanes, 0, kLargest, true};
  const bool listed = pass.active != nullptr && pass.shape != Shape::items;
  std::vector<std::string> out;
  for (const Launch& launch : listed ? std::vector{plan_listed(kListed, rules)} : plan_launches(pass, rules)) {
    out.push_back(fmt::format("{} {} {} {} {} {}", device, pass.kernel, defines_text(pass.defines), launch.local,
                              launch.offset != 0, !listed && launch.global > kSmallGrid));
  }
  return out;
}

class Warmer {
 public:
  Warmer() = default;
  Warmer(const Warmer&) = delete;
  Warmer& operator=(const Warmer&) = delete;

  /// Never destroyed: a forked child, which lacks the thread, could not destroy what the thread waits for.
  static Warmer& get() {
    struct Stopped {
      Warmer* warmer = new Warmer;
      ~Stopped() { warmer->stop(); }
    };
    static const Stopped one;  // made after the driver was loaded, so that the thread ends before the driver
    return *one.warmer;
  }

  void start(std::shared_ptr<WarmJob> job) {
    if (forked()) return;
    {
      const std::lock_guard lock(mutex_);
      std::erase_if(jobs_, [](const auto& other) { return other->cancelled.load(); });  // with their copies of all values
      if (!thread_.joinable()) keep_loaded();
      jobs_.push_back(std::move(job));
      if (!thread_.joinable()) thread_ = std::thread([this] { serve(); });
    }
    changed_.notify_all();
  }

  /// Waits for a cancelled job at work.
  void settle() {
    if (forked()) return;
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return now_ == nullptr || !now_->cancelled; });
  }

  void forget() {
    const std::lock_guard lock(mutex_);
    warm_.clear();
    cached_.clear();
  }

  /// Also false while the thread compiles: PoCL lets launches wait until it has.
  bool has(const std::vector<std::string>& variants, int device) {
    if (forked()) return false;
    const std::lock_guard lock(mutex_);
    if (warming_) return false;
    if (cached_.contains(device)) return true;
    return std::all_of(variants.begin(), variants.end(), [&](const std::string& v) { return warm_.contains(v); });
  }

 private:
  /// In a child of the process, which lacks the thread, and where the thread may have held the lock.
  [[nodiscard]] bool forked() const { return process_ != ::getpid(); }

  /// Keeps a shared library that this is part of: unloading it would wait for the thread, which itself waits for the loader.
  static void keep_loaded() {
    Dl_info own;
    if (::dladdr(reinterpret_cast<void*>(&start_warming), &own) != 0)
      static_cast<void>(::dlopen(own.dli_fname, RTLD_NOW | RTLD_NOLOAD | RTLD_NODELETE));
  }

  void stop() {
    if (forked()) return;
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }

  void serve() {
    const DefaultFloatEnvironment environment;  // the thread may run kernels
    while (true) {
      std::shared_ptr<WarmJob> job;
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return stop_ || !jobs_.empty(); });
        if (stop_) return;
        now_ = job = std::move(jobs_.front());
        jobs_.pop_front();
        warming_ = !job->program.buffers.empty();
      }
      WarmJob::State result = WarmJob::State::done;
      try {
        warm(*job);
      } catch (const std::exception& error) {
        job->error = error.what();
        result = WarmJob::State::failed;
      }
      {
        const std::lock_guard lock(mutex_);
        warming_ = false;
        now_ = nullptr;
      }
      changed_.notify_all();
      if (!unwanted(*job)) job->state = result;
    }
  }

  bool unwanted(const WarmJob& job) const { return stop_ || job.cancelled; }

  void warm(WarmJob& job) {
    if (unwanted(job)) return;
    OpenclOptions options;
    options.probe = false;
    const std::unique_ptr<Backend> backend = make_opencl_backend(job.device, options);
    if (!job.program.buffers.empty()) run_all(job, *backend);
    for (const Program& program : job.later) build(job, program, *backend);
  }

  void run_all(WarmJob& job, Backend& backend) {
    build(job, job.program, backend);
    build(job, job.extension, backend);
    if (unwanted(job)) return;
    backend.load(job.program);
    backend.extend(nullptr, job.extension);
    for (std::size_t i = 0; i < job.values.size(); ++i) {
      const std::size_t own = job.program.buffers.size();
      const Buffer& buffer = i < own ? job.program.buffers[i] : job.extension.buffers[i - own];
      write_bytes(backend, buffer, static_cast<BufferId>(i), job.values[i]);
    }
    job.values = {};
    First first;
    for (const Program* program : {&job.program, &job.extension}) {
      for (const auto* list : lists_of(*program)) {
        for (const Pass& pass : *list) {
          if (unwanted(job)) return;
          run_one(first, job.device, backend, pass);
        }
      }
    }
    const std::lock_guard lock(mutex_);
    if (first.launches >= kEnough && first.longest < kCached) cached_.insert(job.device);
  }

  /// One pass after the other, so that the thread can stop in between; load() would build all in one call.
  void build(const WarmJob& job, const Program& program, Backend& backend) const {
    for (const auto* list : lists_of(program)) {
      for (const Pass& pass : *list) {
        if (unwanted(job)) return;
        Program one;
        one.step = {pass};
        backend.compile(one);
      }
    }
  }

  /// First launches, and the longest time of one.
  struct First {
    int launches = 0;
    double longest = 0;
  };

  void run_one(First& first, int device, Backend& backend, const Pass& pass) {
    const std::vector<std::string> variants = variants_of(pass, device, backend.info());
    const auto start = std::chrono::steady_clock::now();
    backend.run(pass, 0);
    backend.finish();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    // A compiler makes objects when it first needs them, and the process destroys them before what was made earlier: stop
    // first.
    static const int registered = std::atexit([] { get().stop(); });
    static_cast<void>(registered);
    const std::lock_guard lock(mutex_);
    const std::size_t before = warm_.size();
    warm_.insert(variants.begin(), variants.end());
    if (warm_.size() == before) return;
    ++first.launches;
    first.longest = std::max(first.longest, seconds);
  }

  const pid_t process_ = ::getpid();
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::shared_ptr<WarmJob>> jobs_;
  std::shared_ptr<WarmJob> now_;  ///< at work
  std::set<std::string> warm_;
  std::set<int> cached_;  ///< devices whose kernels came from the cache on disk
  bool warming_ = false;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace

Program outline_of(const Program& program) {
  static const auto listed = std::make_shared<const std::int64_t>(kListed);
  Program out;
  out.first = program.first;
  for (const Buffer& buffer : program.buffers) {
    Buffer& row = out.buffers.emplace_back();
    row.name = buffer.name, row.type = buffer.type, row.count = buffer.count, row.role = buffer.role;
    row.shape = buffer.shape, row.padding = buffer.padding;
  }
  const auto from = lists_of(program);
  const auto to = lists_of(out);
  for (std::size_t l = 0; l < from.size(); ++l) {
    *to[l] = *from[l];
    for (Pass& pass : *to[l]) {
      if (pass.active != nullptr) pass.active = listed;
    }
  }
  return out;
}

static std::atomic<bool> started{false};

void start_warming(std::shared_ptr<WarmJob> job) {
  started = true;
  Warmer::get().start(std::move(job));
}

void settle_warming() {
  if (started) Warmer::get().settle();
}

void forget_warm() { Warmer::get().forget(); }

bool is_warm(const Program& program, int device, const BackendInfo& info) {
  for (const auto* list : lists_of(program)) {
    for (const Pass& pass : *list) {
      if (!Warmer::get().has(variants_of(pass, device, info), device)) return false;
    }
  }
  return true;
}

}  // namespace pliant
