// Compiles the kernels of OpenCL processors in a thread beside the simulation. PoCL compiles a kernel for each work-group size
// when it is first launched, which takes 0.1 to 1 s each where its cache on disk is empty; no call only compiles. So the thread
// runs every pass once, on a backend and a copy of the values of its own.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "backends/interface/backend.h"

namespace pliant {

/// What one TieredBackend has asked for. The thread and the backend share it.
struct WarmJob {
  enum class State { waiting, done, failed };
  int device = 0;                                 ///< N of opencl:N
  Program program, extension;                     ///< without initial values
  std::vector<std::vector<std::uint8_t>> values;  ///< of every buffer of both, as from Backend::read_bytes
  std::vector<Program> later;                     ///< to build, without initial values: programs that are likely to be loaded

  std::atomic<bool> cancelled{false};
  std::atomic<State> state{State::waiting};
  std::string error;  ///< why it failed, once it has
};

/// Returns a copy without the initial values of its buffers and with lists (Pass::active) that let each pass run.
Program outline_of(const Program& program);

/// Leaves a job to the thread, which this process has one of. A forked child has none: its jobs wait for ever.
void start_warming(std::shared_ptr<WarmJob> job);

/// Waits while the thread works on a cancelled job: at most for one kernel. A process must not end while a compiler works,
/// whose objects would vanish under it.
void settle_warming();

/// Returns true if no launch of these passes takes long: this process has launched each on this device in the same work-group
/// sizes, or what it has launched so far came from the cache on disk.
bool is_warm(const Program& program, int device, const BackendInfo& info);

/// Forgets what was launched. For tests.
void forget_warm();

}  // namespace pliant
