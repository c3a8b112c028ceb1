// What the two backends that run the twins share: the processor, the registry of twins, and the clock of passes.
#pragma once
#include <chrono>
#include <string>
#include <utility>

#include "backends/interface/program_backend.h"
#include "backends/twins/prepared_twin.h"
#include "backends/twins/processor.h"

namespace pliant::ref {

/// Returns the properties that are the same for both.
inline BackendInfo twin_info(std::string name, std::string version) {
  BackendInfo info;
  info.name = std::move(name);
  info.device = processor_name();
  info.kind = "reference";
  info.platform = "Pliant";
  info.version = std::move(version);
  info.memory_bytes = info.max_buffer_bytes = physical_memory();
  return info;
}

template <class Store, class Prepared, class Scalar>
class TwinBackend : public ProgramBackend<Store, Prepared, Scalar> {
 public:
  void finish() final {}

 protected:
  /// `registry`: nullptr: the twins of kernels/.
  TwinBackend(BackendInfo info, std::size_t bytes_per_real, const Registry* registry)
      : ProgramBackend<Store, Prepared, Scalar>(info, info.name, bytes_per_real),
        registry_(registry != nullptr ? *registry : ref::registry()) {}

  /// `argument(id)` returns a buffer as an argument of the twin.
  template <class Argument>
  PreparedTwin<Scalar> twin_of(const Pass& pass, Argument&& argument) const {
    return prepare_twin<Scalar>(registry_, pass, this->table().size(), std::forward<Argument>(argument));
  }
  /// Runs a pass by `execute()`, and measures it while passes are profiled.
  template <class Execute>
  void run_timed(PassClock& clock, Execute&& execute) const {
    if (!this->profiling()) {
      execute();
      return;
    }
    const auto start = std::chrono::steady_clock::now();
    execute();
    clock.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ++clock.launches;
  }

 private:
  const Registry& registry_;
};

}  // namespace pliant::ref
