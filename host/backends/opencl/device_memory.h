// Buffers on a device: made with their initial values, or brought from one program's values to the next's.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "backends/opencl/opencl.h"
#include "program/buffer.h"

namespace pliant::opencl {

struct DeviceMemory {
  cl::Buffer buffer;
  std::size_t values = 0;  ///< there is room for
  bool written = false;    ///< by the host, since its initial values
};

/// Transfers that the host does not wait for one by one: each wait costs as much as several of them.
class Upload {
 public:
  explicit Upload(cl::CommandQueue& queue) : queue_(queue) {}
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;
  ~Upload();
  /// Initial values [first, last) of a buffer, which must stay as it is until finish().
  void write(const Buffer& buffer, std::size_t first, std::size_t last, cl::Buffer& memory);
  void finish();

 private:
  cl::CommandQueue& queue_;
  std::vector<std::unique_ptr<float[]>> staged_;
};

DeviceMemory load_memory(const cl::Context& context, Upload& upload, const Buffer& buffer);

/// The same table row in two programs; `before` is nullptr if the first has none.
struct BufferChange {
  const Buffer* before;
  const Buffer* next;
  std::uint64_t most_bytes;  ///< of one allocation
};

/// `memory` holds change.before. What it returns holds the initial values of change.next.
DeviceMemory patch_memory(const cl::Context& context, Upload& upload, const BufferChange& change, DeviceMemory memory);

}  // namespace pliant::opencl
