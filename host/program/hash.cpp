#include "program/hash.h"

#include <fmt/format.h>

// Compiled in, so that neither libpliant nor who links it needs the library at run time.
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace pliant {

struct Hasher::State {
  XXH3_state_t xxh;
};

Hasher::Hasher() : state_(std::make_unique<State>()) { XXH3_64bits_reset(&state_->xxh); }
Hasher::~Hasher() = default;
Hasher::Hasher(Hasher&&) noexcept = default;
Hasher& Hasher::operator=(Hasher&&) noexcept = default;

void Hasher::add(const void* data, std::size_t size) {
  if (size > 0) XXH3_64bits_update(&state_->xxh, data, size);
}

std::uint64_t Hasher::value() const { return XXH3_64bits_digest(&state_->xxh); }

std::uint64_t hash_bytes(const void* data, std::size_t size) { return XXH3_64bits(data, size); }
std::uint64_t hash_bytes(const std::string& text) { return hash_bytes(text.data(), text.size()); }

std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

}  // namespace pliant
