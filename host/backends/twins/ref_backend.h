// The backend that runs the twins: plain C++ on the processor, in float (the same bits as the kernels) or in double (the
// reference for rounding errors).
#pragma once
#include <cstdint>
#include <memory>

#include "backends/interface/backend.h"

namespace pliant {

namespace ref {
class Registry;
}

struct RefOptions {
  bool double_precision = false;
  int threads = 0;                          ///< 0: as many as available to the process
  bool probe = true;                        ///< run the known-answer probe (float only)
  std::uint64_t memory_bytes = 0;           ///< limit for a program; 0: the machine's memory
  const ref::Registry* registry = nullptr;  ///< nullptr: the twins of kernels/; must outlive the backend
};

/// Throws Error on a processor without hardware fma, where emulation is two hundred times slower.
std::unique_ptr<Backend> make_ref_backend(const RefOptions& options = {});

}  // namespace pliant
