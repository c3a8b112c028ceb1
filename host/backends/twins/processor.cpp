#include "backends/twins/processor.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>

#include "pliant/error.h"

namespace pliant::ref {

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "processor";
}

std::uint64_t physical_memory() {
  return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE));
}

void require_fma() {
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("fma") || !__builtin_cpu_supports("avx2")) {
    throw Error(ErrorCode::bad_input, fmt::format("the processor ({}) has no hardware fma (FMA3 and AVX2), which the CPU "
                                                  "reference needs: use an OpenCL device instead",
                                                  processor_name()));
  }
#endif
}

}  // namespace pliant::ref
