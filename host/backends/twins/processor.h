// Properties of the processor for the backends that run the twins.
#pragma once
#include <cstdint>
#include <string>

namespace pliant::ref {

/// The processor's name.
std::string processor_name();

/// Memory of the whole machine [bytes].
std::uint64_t physical_memory();

/// Throws Error on a processor without hardware fma, where emulation is two hundred times slower.
void require_fma();

}  // namespace pliant::ref
