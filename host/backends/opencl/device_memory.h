// Device buffers: created with initial values, or updated from one program to the next.
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
  std::size_t values = 0;  ///< capacity
  bool written = false;    ///< written by the host after its initial values
};

/// Batches transfers, because waiting for each one costs as much as several transfers.
class Upload {
 public:
  explicit Upload(cl::CommandQueue& queue) : queue_(queue) {}
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;
  ~Upload();
  /// Uploads initial values [first, last) of a buffer, which must not change until finish().
  void write(const Buffer& buffer, std::size_t first, std::size_t last, cl::Buffer& memory);
  void finish();

 private:
  cl::CommandQueue& queue_;
  std::vector<std::unique_ptr<float[]>> staged_;
};

DeviceMemory load_memory(const cl::Context& context, Upload& upload, const Buffer& buffer);

/// The same buffer in two programs; `before` is nullptr if the first one lacks it.
struct BufferChange {
  const Buffer* before;
  const Buffer* next;
  std::uint64_t most_bytes;  ///< limit of one allocation
};

/// `memory` contains change.before; the returned memory contains the initial values of change.next.
DeviceMemory patch_memory(const cl::Context& context, Upload& upload, const BufferChange& change, DeviceMemory memory);

}  // namespace pliant::opencl
