#include "backends/opencl/device_memory.h"

#include <algorithm>

#include "backends/interface/buffer_checks.h"

namespace pliant::opencl {
namespace {

DeviceMemory allocate(const cl::Context& context, std::size_t values) {
  return {cl::Buffer(context, CL_MEM_READ_WRITE, 4 * std::max<std::size_t>(values, 1)), values, false};
}

void initialize(Upload& upload, const Buffer& buffer, cl::Buffer& memory) {
  upload.write(buffer, 0, std::max<std::size_t>(buffer.values(), 1), memory);
}

}  // namespace

Upload::~Upload() {
  try {
    finish();
  } catch (const cl::Error&) {  // what was under way has failed already
  }
}

void Upload::write(const Buffer& buffer, std::size_t first, std::size_t last, cl::Buffer& memory) {
  const std::size_t end = std::max(first, std::min(last, initial_count(buffer))), count = end - first;
  const float padding = buffer.is_int() ? 0.0F : static_cast<float>(buffer.padding);  // of an integer: the same bits
  if (end < last) queue_.enqueueFillBuffer(memory, padding, 4 * end, 4 * (last - end));
  if (count == 0) return;
  if (buffer.is_int()) {
    queue_.enqueueWriteBuffer(memory, CL_FALSE, 4 * first, 4 * count, buffer.ints.data() + first);
    return;
  }
  float* values = staged_.emplace_back(std::make_unique_for_overwrite<float[]>(count)).get();
  round_reals(std::span(buffer.reals).subspan(first, count), values);
  queue_.enqueueWriteBuffer(memory, CL_FALSE, 4 * first, 4 * count, values);
}

void Upload::finish() {
  queue_.finish();
  staged_.clear();
}

DeviceMemory load_memory(const cl::Context& context, Upload& upload, const Buffer& buffer) {
  DeviceMemory memory = allocate(context, buffer.values());
  initialize(upload, buffer, memory.buffer);
  return memory;
}

DeviceMemory patch_memory(const cl::Context& context, Upload& upload, const BufferChange& change, DeviceMemory memory) {
  const Buffer& buffer = *change.next;
  const std::size_t needed = buffer.values();
  const bool fits = change.before != nullptr && needed <= memory.values && memory.values > 0;
  if (!fits) {
    const std::size_t room = std::min<std::size_t>(needed + needed / 2, change.most_bytes / 4);
    try {
      memory = allocate(context, change.before == nullptr ? needed : std::max(needed, room));
    } catch (const cl::Error&) {
      memory = allocate(context, needed);
    }
  }
  if (!fits || memory.written || buffer.role != BufferRole::constant) {
    initialize(upload, buffer, memory.buffer);
    memory.written = false;
    return memory;
  }
  for (const ValueRange& range : changed_values(*change.before, buffer)) {
    upload.write(buffer, range.first, range.last, memory.buffer);
  }
  return memory;
}

}  // namespace pliant::opencl
