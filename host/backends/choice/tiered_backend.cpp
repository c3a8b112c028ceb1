#include "backends/choice/tiered_backend.h"

#include <fmt/format.h>

#include <atomic>
#include <exception>
#include <utility>

#include "backends/choice/kernel_warmer.h"
#include "backends/interface/buffer_bytes.h"
#include "pliant/error.h"

namespace pliant {
namespace {

class TieredBackend final : public Backend {
 public:
  TieredBackend(std::unique_ptr<Backend> twins, std::unique_ptr<Backend> opencl, int device)
      : twins_(std::move(twins)), opencl_(std::move(opencl)), device_(device) {}
  TieredBackend(const TieredBackend&) = delete;
  TieredBackend& operator=(const TieredBackend&) = delete;
  ~TieredBackend() override {
    cancel();
    if (rest_ != nullptr) rest_->cancelled = true;
  }

  [[nodiscard]] const BackendInfo& info() const override { return opencl_->info(); }
  [[nodiscard]] std::string remark() const override { return remark_; }
  [[nodiscard]] const BackendInfo& at_work() const override { return now_->info(); }

  void load(const Program& program) override {
    begin(program);
    now_->load(program);
    extended_ = false;
  }
  void update(const Program& loaded, const Program& next) override {
    const Backend* before = now_;
    begin(next);
    if (now_ == before) return now_->update(loaded, next);
    now_->load(next);
    extended_ = false;
  }
  void extend(const Program* before, const Program& extension) override {
    cancel();
    extension_ = nullptr;
    if (now_ == opencl_.get() && !launches_at_once(extension)) bring(*twins_);
    now_->extend(extended_ ? before : nullptr, extension);
    extension_ = &extension;
    extended_ = true;
  }
  void compile(const Program& program) override {
    later_.push_back(outline_of(program));
    if (now_ == opencl_.get()) compile_rest();
  }

  void compile_beside(const Program& program) override {
    // What would not launch at once is left to the thread of the kernel_warmer.
    if (on_opencl_ && is_warm(program, device_, opencl_->info())) opencl_->compile_beside(program);
  }

  void run(const std::vector<Pass>& passes, std::int32_t first, std::int32_t count, std::int64_t origin) override {
    if (now_ == twins_.get() && program_ != nullptr && &passes == &program_->step) look_at_job();
    now_->run(passes, first, count, origin);
  }
  void run(const Pass& pass, std::int32_t step_in_batch) override { now_->run(pass, step_in_batch); }
  void finish() override { now_->finish(); }
  void copy(BufferId from, BufferId to) override { now_->copy(from, to); }
  std::vector<double> read_reals(BufferId id) override { return now_->read_reals(id); }
  std::vector<std::int32_t> read_ints(BufferId id) override { return now_->read_ints(id); }
  void write_reals(BufferId id, const std::vector<double>& values) override { now_->write_reals(id, values); }
  void write_ints(BufferId id, const std::vector<std::int32_t>& values) override { now_->write_ints(id, values); }
  std::vector<std::uint8_t> read_bytes(BufferId id) override { return now_->read_bytes(id); }
  void read_into(BufferId id, void* out) override { now_->read_into(id, out); }

  void profile(bool on) override {
    twins_->profile(on);
    opencl_->profile(on);
  }
  std::vector<PassTime> take_profile() override {
    std::vector<PassTime> times = twins_->take_profile();
    for (PassTime& time : opencl_->take_profile()) times.push_back(std::move(time));
    return times;
  }

 private:
  [[nodiscard]] bool launches_at_once(const Program& program) const {
    return remark_.empty() && is_warm(program, device_, opencl_->info());
  }

  /// Chooses what runs a program that is about to be loaded.
  void begin(const Program& program) {
    cancel();
    program_ = &program;
    extension_ = nullptr;
    Backend* next = launches_at_once(program) ? opencl_.get() : twins_.get();
    if (next != now_) now_->load(nothing_);  // it would hold on to a program that may be gone
    let_work(*next);
  }

  void let_work(Backend& next) {
    now_ = &next;
    on_opencl_ = now_ == opencl_.get();
  }

  void cancel() {
    if (job_ != nullptr) job_->cancelled = true;
    job_ = nullptr;
  }

  /// Called between two steps, when the values of all buffers are those of a step.
  void look_at_job() {
    if (!remark_.empty() || (job_ != nullptr && job_->state == WarmJob::State::waiting)) return;
    try {
      if (job_ == nullptr) return start_job();
      const std::shared_ptr<WarmJob> job = std::exchange(job_, nullptr);
      if (job->state == WarmJob::State::failed) throw Error(ErrorCode::device, job->error);
      bring(*opencl_);
      compile_rest();
    } catch (const std::exception& error) {
      cancel();
      remark_ = fmt::format("{} computes in place of {}: {}", twins_->info().name, opencl_->info().name, error.what());
      try {
        if (now_ == twins_.get()) opencl_->load(nothing_);  // it may have half of the scene
      } catch (const std::exception&) {                     // never used again
      }
    }
  }

  void compile_rest() {
    if (later_.empty()) return;
    rest_ = std::make_shared<WarmJob>();
    rest_->device = device_;
    rest_->later = std::exchange(later_, {});
    start_warming(rest_);
  }

  void start_job() {
    job_ = std::make_shared<WarmJob>();
    job_->device = device_;
    job_->program = outline_of(*program_);
    if (extension_ != nullptr) job_->extension = outline_of(*extension_);
    for (std::size_t i = 0; i < buffers(); ++i) job_->values.push_back(now_->read_bytes(static_cast<BufferId>(i)));
    start_warming(job_);
  }

  [[nodiscard]] std::size_t buffers() const {
    return program_->buffers.size() + (extension_ != nullptr ? extension_->buffers.size() : 0);
  }
  [[nodiscard]] const Buffer& row(std::size_t i) const {
    const std::size_t own = program_->buffers.size();
    return i < own ? program_->buffers[i] : extension_->buffers[i - own];
  }

  /// Moves what is loaded, with the values of all buffers, to another backend.
  void bring(Backend& next) {
    next.load(*program_);
    if (extension_ != nullptr) next.extend(nullptr, *extension_);
    for (std::size_t i = 0; i < buffers(); ++i) {
      const auto id = static_cast<BufferId>(i);
      const std::vector<std::uint8_t> bytes = now_->read_bytes(id);
      // A constant that the host has not written is there; written again, update() could not know which parts differ.
      if (row(i).role == BufferRole::constant && next.read_bytes(id) == bytes) continue;
      write_bytes(next, row(i), id, bytes);
    }
    next.finish();
    now_->load(nothing_);
    let_work(next);
    extended_ = extension_ != nullptr;
  }

  const std::unique_ptr<Backend> twins_, opencl_;
  const int device_;
  const Program nothing_;
  Backend* now_ = twins_.get();
  std::atomic<bool> on_opencl_{false};
  const Program *program_ = nullptr, *extension_ = nullptr;
  bool extended_ = false;                ///< the values of an extension are there, also those of the one before an update()
  std::shared_ptr<WarmJob> job_, rest_;  ///< the latter for `later_`
  std::vector<Program> later_;           ///< outlines, for compile()
  std::string remark_;
};

}  // namespace

std::unique_ptr<Backend> make_tiered_backend(std::unique_ptr<Backend> twins, std::unique_ptr<Backend> opencl, int device) {
  return std::make_unique<TieredBackend>(std::move(twins), std::move(opencl), device);
}

}  // namespace pliant
