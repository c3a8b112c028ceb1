// Buffers on a device: made with their initial values, or brought from one program's values to the next's.
#pragma once
#include <cstddef>
#include <cstdint>

#include "opencl/opencl.h"
#include "state/buffer.h"

namespace pliant::opencl {

struct DeviceMemory {
  cl::Buffer buffer;
  std::size_t values = 0;  ///< there is room for
  bool written = false;    ///< by the host, since its initial values
};

DeviceMemory load_memory(const cl::Context& context, cl::CommandQueue& queue, const Buffer& buffer);

/// The same table row in two programs; `before` is nullptr if the first has none.
struct BufferChange {
  const Buffer* before;
  const Buffer* next;
  std::uint64_t most_bytes;  ///< of one allocation
};

/// `memory` holds change.before. What it returns holds the initial values of change.next.
DeviceMemory patch_memory(const cl::Context& context, cl::CommandQueue& queue, const BufferChange& change, DeviceMemory memory);

}  // namespace pliant::opencl
