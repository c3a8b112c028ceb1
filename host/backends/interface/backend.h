// The interface for running a Program. Implemented by host/opencl (float) and cpu_ref (float and double).
#pragma once
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "program/program.h"

namespace pliant {

struct BackendInfo {
  std::string name;    ///< as for --backend: "cpu", "cpu:double", "opencl:0"
  std::string device;  ///< name of the GPU or processor
  std::string kind;    ///< "reference", "cpu", "gpu", "accelerator"
  std::string platform, version, driver;
  bool bit_exact = false;        ///< passed the start-up probe
  std::string tolerance_reason;  ///< reason if it did not
  std::uint64_t memory_bytes = 0;
  std::uint64_t max_buffer_bytes = 0;  ///< largest possible allocation
  int compute_units = 0;
  bool single_thread = false;  ///< runs on the caller's thread: better for small scenes
  bool compiles = false;       ///< compiles kernels when a program is loaded
  int real_bytes = 4;          ///< size of a real number: 4 or 8
  int lanes = 1;               ///< indices per work-item of a `lanes` pass
};

/// Total device time of one pass.
struct PassTime {
  std::string kernel, label;
  double seconds = 0;
  std::int64_t launches = 0;
};

class Backend {
 public:
  virtual ~Backend() = default;
  [[nodiscard]] virtual const BackendInfo& info() const = 0;
  /// Returns what a user should know of how it computes; empty: nothing.
  [[nodiscard]] virtual std::string remark() const { return {}; }
  /// Returns what computes at present.
  [[nodiscard]] virtual const BackendInfo& at_work() const { return info(); }
  /// Compiles the program, allocates its buffers and uploads their initial values. The program must outlive its use; a
  /// previous extension is dropped. Throws Error (memory: needed and available; build failure: the log).
  virtual void load(const Program& program) = 0;
  /// Equivalent to load(next) after load(loaded), but uploads only differences: changed ranges of constant buffers, and the
  /// initial values of buffers that passes write. Buffers that grow get half as much space again. After an error, call
  /// load().
  virtual void update(const Program& loaded, const Program& next) {
    (void)loaded;
    load(next);
  }
  /// Loads an extension (Program::first) in addition to the loaded program. `before` (may be null): the extension that it
  /// replaces, so that only differences are uploaded. Repeat this after load() or update().
  virtual void extend(const Program* before, const Program& extension) = 0;
  /// Compiles a program that may be loaded later.
  virtual void compile(const Program& program) { (void)program; }
  /// The same on any thread, while the backend works. What does not compile is left to load(), which tells why.
  virtual void compile_beside(const Program& program) { (void)program; }
  /// Runs `passes` for steps first .. first + count - 1 of the current batch, in order, without host synchronization in
  /// between. `origin`: number of the batch's step 0 in the run; it determines in which steps passes with Pass::every run.
  virtual void run(const std::vector<Pass>& passes, std::int32_t first, std::int32_t count, std::int64_t origin = 0) = 0;
  /// Runs one pass, regardless of Pass::every (used by compare and by the tests).
  virtual void run(const Pass& pass, std::int32_t step_in_batch) = 0;
  virtual void finish() = 0;
  /// Copies a buffer to another of the same size, on the device.
  virtual void copy(BufferId from, BufferId to) = 0;
  /// Blocking transfers. read_reals() converts the backend's reals to double, which is exact.
  virtual std::vector<double> read_reals(BufferId id) = 0;
  virtual std::vector<std::int32_t> read_ints(BufferId id) = 0;
  virtual void write_reals(BufferId id, const std::vector<double>& values) = 0;
  virtual void write_ints(BufferId id, const std::vector<std::int32_t>& values) = 0;
  /// Returns the buffer's bytes, for comparison and hashing (4 or 8 bytes per value).
  virtual std::vector<std::uint8_t> read_bytes(BufferId id) = 0;
  /// Reads the same bytes into the caller's memory, which must have exactly the buffer's size.
  virtual void read_into(BufferId id, void* out) {
    const std::vector<std::uint8_t> bytes = read_bytes(id);
    if (!bytes.empty()) std::memcpy(out, bytes.data(), bytes.size());
  }
  /// Turns per-pass timing on (which may serialize launches) or off; take_profile() returns and resets the times.
  virtual void profile(bool on) = 0;
  virtual std::vector<PassTime> take_profile() = 0;
};

}  // namespace pliant
