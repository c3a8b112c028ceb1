// The bytes of buffers, as from Backend::read_bytes.
#pragma once
#include <cstdint>
#include <vector>

#include "backends/interface/backend.h"

namespace pliant {

/// Writes what read_bytes() of a backend with the same real numbers has returned. `buffer`: its description.
void write_bytes(Backend& backend, const Buffer& buffer, BufferId id, const std::vector<std::uint8_t>& bytes);

}  // namespace pliant
