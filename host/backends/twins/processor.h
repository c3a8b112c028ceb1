// What the backends that run the twins say and ask of the processor.
#pragma once
#include <cstdint>
#include <string>

namespace pliant::ref {

/// As the processor calls itself.
std::string processor_name();

/// Of the whole machine [bytes].
std::uint64_t physical_memory();

/// Throws Error on a processor without hardware fma, where every fma would be emulated two hundred times slower.
void require_fma();

}  // namespace pliant::ref
