#include "opencl/device_memory.h"

#include <algorithm>
#include <vector>

#include "solver/buffer_checks.h"

namespace pliant::opencl {
namespace {

DeviceMemory allocate(const cl::Context& context, std::size_t values) {
  return {cl::Buffer(context, CL_MEM_READ_WRITE, 4 * std::max<std::size_t>(values, 1)), values, false};
}

/// Initial values [first, last); those that are not given are zero.
void write_values(cl::CommandQueue& queue, const Buffer& buffer, const ValueRange& range, cl::Buffer& memory) {
  const std::size_t end = std::max(range.first, std::min(range.last, initial_count(buffer))), count = end - range.first;
  if (end < range.last) queue.enqueueFillBuffer(memory, cl_uint{0}, 4 * end, 4 * (range.last - end));
  if (count == 0) return;
  if (buffer.is_int()) {
    queue.enqueueWriteBuffer(memory, CL_TRUE, 4 * range.first, 4 * count, buffer.ints.data() + range.first);
    return;
  }
  std::vector<float> values(count);
  round_reals(std::span(buffer.reals).subspan(range.first, count), values.data());
  queue.enqueueWriteBuffer(memory, CL_TRUE, 4 * range.first, 4 * count, values.data());
}

void initialize(cl::CommandQueue& queue, const Buffer& buffer, cl::Buffer& memory) {
  write_values(queue, buffer, {0, std::max<std::size_t>(buffer.values(), 1)}, memory);
}

}  // namespace

DeviceMemory load_memory(const cl::Context& context, cl::CommandQueue& queue, const Buffer& buffer) {
  DeviceMemory memory = allocate(context, buffer.values());
  initialize(queue, buffer, memory.buffer);
  return memory;
}

DeviceMemory patch_memory(const cl::Context& context, cl::CommandQueue& queue, const BufferChange& change,
                          DeviceMemory memory) {
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
    initialize(queue, buffer, memory.buffer);
    memory.written = false;
    return memory;
  }
  for (const ValueRange& range : changed_values(*change.before, buffer)) write_values(queue, buffer, range, memory.buffer);
  return memory;
}

}  // namespace pliant::opencl
