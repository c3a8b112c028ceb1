#include "backends/interface/pass_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "pliant/error.h"

namespace pliant {
namespace {

bool same_arg(const Arg& a, const Arg& b) {
  if (a.index() != b.index()) return false;
  switch (a.index()) {
    case 0:
      return std::get<0>(a) == std::get<0>(b);
    case 1:
      return std::bit_cast<std::uint64_t>(std::get<1>(a)) == std::bit_cast<std::uint64_t>(std::get<1>(b));
    case 2:
      return std::get<2>(a) == std::get<2>(b);
    default:
      return true;
  }
}

std::uint64_t buffer_bytes(const Buffer& buffer, std::size_t real_bytes) {
  return std::uint64_t{std::max<std::size_t>(buffer.values(), 1)} * (buffer.is_int() ? sizeof(std::int32_t) : real_bytes);
}

}  // namespace

bool same_pass(const Pass& a, const Pass& b) {
  return a.shape == b.shape && a.count == b.count && a.kernel == b.kernel && a.label == b.label && a.defines == b.defines &&
         std::equal(a.args.begin(), a.args.end(), b.args.begin(), b.args.end(), same_arg);
}

std::string defines_text(const std::vector<std::pair<std::string, int>>& defines) {
  std::string text;
  for (const auto& [name, value] : defines) text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, value);
  return text;
}

std::string bytes_text(std::uint64_t bytes) {
  static constexpr const char* units[] = {"B", "KiB", "MiB", "GiB", "TiB"};
  double value = static_cast<double>(bytes);
  std::size_t unit = 0;
  while (value >= 1024 && unit + 1 < std::size(units)) {
    value /= 1024;
    ++unit;
  }
  return unit == 0 ? fmt::format("{} bytes", bytes) : fmt::format("{:.2f} {} ({} bytes)", value, units[unit], bytes);
}

void check_pass(const Pass& pass, std::size_t buffers) {
  const auto fail = [&](const std::string& what) {
    throw Error(ErrorCode::internal, fmt::format("pass \"{}\" (kernel {}): {}", pass.label, pass.kernel, what));
  };
  for (std::size_t i = 0; i < pass.args.size(); ++i) {
    if (pass.args[i].index() != 0) continue;
    const BufferId id = std::get<0>(pass.args[i]);
    if (id < 0 || static_cast<std::size_t>(id) >= buffers) {
      fail(fmt::format("argument {} names buffer {}, but the program has {} buffers", i, id, buffers));
    }
  }
  if (pass.count < 0 || pass.count > std::numeric_limits<std::int32_t>::max()) {
    fail(fmt::format("count {} is outside [0, 2147483647]", pass.count));
  }
  if (pass.shape == Shape::lanes && pass.count % 16 != 0) fail(fmt::format("count {} is not a multiple of 16", pass.count));
  if (pass.active != nullptr && pass.shape != Shape::lanes && pass.shape != Shape::items)
    fail("only passes over lanes or items run over lists");
}

void check_extension(const Program& extension, std::size_t buffers) {
  if (static_cast<std::size_t>(extension.first) == buffers) return;
  throw Error(ErrorCode::internal,
              fmt::format("an extension of a program of {} buffers cannot extend one of {}", extension.first, buffers));
}

void check_memory(const BufferTable& table, std::size_t real_bytes, std::uint64_t max_buffer, std::uint64_t total,
                  const std::string& device) {
  std::uint64_t needed = 0, largest = 0;
  const Buffer* largest_buffer = nullptr;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const Buffer& buffer = table.row(static_cast<BufferId>(i));
    const std::uint64_t bytes = buffer_bytes(buffer, real_bytes);
    needed += bytes;
    if (bytes > largest) {
      largest = bytes;
      largest_buffer = &buffer;
    }
  }
  if (largest_buffer == nullptr || (needed <= total && largest <= max_buffer)) return;
  std::string message;
  if (largest > max_buffer) {
    message = fmt::format("the scene does not fit on {}: buffer \"{}\" {} needs {}, the device allows {} in one allocation",
                          device, largest_buffer->name, largest_buffer->shape, bytes_text(largest), bytes_text(max_buffer));
  } else {
    message = fmt::format(
        "the scene does not fit on {}: it needs {}, the device has {}; the largest buffer is \"{}\" {} with {}", device,
        bytes_text(needed), bytes_text(total), largest_buffer->name, largest_buffer->shape, bytes_text(largest));
  }
  throw Error(ErrorCode::bad_input, message + ". Use a larger spacing or a device with more memory.");
}

}  // namespace pliant
