// What runs a Program. Implemented by host/opencl (float) and cpu_ref (float and double).
#pragma once
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "program/program.h"

namespace pliant {

struct BackendInfo {
  std::string name;    ///< what --backend takes: "cpu", "cpu:double", "opencl:0"
  std::string device;  ///< the processor's own name
  std::string kind;    ///< "reference", "cpu", "gpu", "accelerator"
  std::string platform, version, driver;
  bool bit_exact = false;        ///< passed the start-up probe
  std::string tolerance_reason;  ///< why not, if it did not
  std::uint64_t memory_bytes = 0;
  std::uint64_t max_buffer_bytes = 0;  ///< largest single allocation
  int compute_units = 0;
  bool single_thread = false;  ///< computes on the caller's thread: better for small scenes
  bool compiles = false;       ///< kernels are compiled when a program is loaded
  int real_bytes = 4;          ///< of a real number: 4 or 8
  int lanes = 1;               ///< indices per work-item of a `lanes` pass
};

/// Device time of one pass, summed.
struct PassTime {
  std::string kernel, label;
  double seconds = 0;
  std::int64_t launches = 0;
};

class Backend {
 public:
  virtual ~Backend() = default;
  [[nodiscard]] virtual const BackendInfo& info() const = 0;
  /// Compile what the program needs, allocate its buffers and upload their initial values. The program must outlive the use;
  /// an extension of the one before is gone. Throws Error (memory: needed and available; build failure: the log).
  virtual void load(const Program& program) = 0;
  /// As load(next) after load(loaded), with the same bits in every buffer, but only what differs goes to the device: changed
  /// ranges of constant buffers, and the initial values of what passes write. Buffers that grow get half as much again. After
  /// an error the backend wants a load().
  virtual void update(const Program& loaded, const Program& next) {
    (void)loaded;
    load(next);
  }
  /// Load an extension (Program::first) beside the loaded program; `before`: the extension that it replaces, of which only what
  /// differs goes to the device, or nullptr. An extension wants to be loaded again after load() or update().
  virtual void extend(const Program* before, const Program& extension) = 0;
  /// Compile now what a program may need later, without loading it.
  virtual void compile(const Program& program) { (void)program; }
  /// Run `passes` for steps first .. first + count - 1 of the current batch, in order, without host synchronisation in between.
  /// `origin` is the number in the whole run of the batch's step 0: it decides when a pass runs that does not run in every
  /// step.
  virtual void run(const std::vector<Pass>& passes, std::int32_t first, std::int32_t count, std::int64_t origin = 0) = 0;
  /// Run one pass, whatever its rhythm (used by compare and by the tests).
  virtual void run(const Pass& pass, std::int32_t step_in_batch) = 0;
  virtual void finish() = 0;
  /// Copy one buffer onto another of the same size, on the device.
  virtual void copy(BufferId from, BufferId to) = 0;
  /// Blocking transfers. Real buffers arrive as the backend's own reals widened to double, which is exact.
  virtual std::vector<double> read_reals(BufferId id) = 0;
  virtual std::vector<std::int32_t> read_ints(BufferId id) = 0;
  virtual void write_reals(BufferId id, const std::vector<double>& values) = 0;
  virtual void write_ints(BufferId id, const std::vector<std::int32_t>& values) = 0;
  /// The buffer's bytes, for comparison and hashing (4 or 8 bytes per value).
  virtual std::vector<std::uint8_t> read_bytes(BufferId id) = 0;
  /// The same into the caller's memory, which must have exactly the buffer's size.
  virtual void read_into(BufferId id, void* out) {
    const std::vector<std::uint8_t> bytes = read_bytes(id);
    if (!bytes.empty()) std::memcpy(out, bytes.data(), bytes.size());
  }
  /// Turn per-pass timing on (it may serialise launches) or off, and collect it.
  virtual void profile(bool on) = 0;
  virtual std::vector<PassTime> take_profile() = 0;
};

}  // namespace pliant
