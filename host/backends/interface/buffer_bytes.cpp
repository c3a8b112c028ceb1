#include "backends/interface/buffer_bytes.h"

#include <cstring>

#include "backends/interface/float_environment.h"

namespace pliant {
namespace {

template <class T>
std::vector<T> values_of(const std::vector<std::uint8_t>& bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

}  // namespace

void write_bytes(Backend& backend, const Buffer& buffer, BufferId id, const std::vector<std::uint8_t>& bytes) {
  if (bytes.empty()) return;
  if (buffer.is_int()) return backend.write_ints(id, values_of<std::int32_t>(bytes));
  if (backend.info().real_bytes == 8) return backend.write_reals(id, values_of<double>(bytes));
  const std::vector<float> values = values_of<float>(bytes);
  const DefaultFloatEnvironment environment;  // a caller that flushes denormals would lose them in the conversion
  backend.write_reals(id, {values.begin(), values.end()});
}

}  // namespace pliant
