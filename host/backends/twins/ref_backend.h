// The backend that runs the twins: plain C++ on the processor, in float (the same bits as the kernels) or in double (the
// oracle).
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
  int threads = 0;                          ///< 0: as many as the process may use
  bool probe = true;                        ///< run the known-answer probe (float only)
  std::uint64_t memory_bytes = 0;           ///< 0: the machine's memory; otherwise the most that a program may use
  const ref::Registry* registry = nullptr;  ///< nullptr: the twins of kernels/. Must outlive the backend.
};

/// Throws Error on a processor without hardware fma, where every fma would be emulated two hundred times slower.
std::unique_ptr<Backend> make_ref_backend(const RefOptions& options = {});

}  // namespace pliant
