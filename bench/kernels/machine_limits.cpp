#include "bench/kernels/machine_limits.h"

#include "backends/interface/timing.h"

namespace pliant::bench {
namespace {

Buffer numbers(const char* name, std::int64_t count) {
  return {name, BufferType::real, static_cast<std::size_t>(count), BufferRole::scratch, "[numbers]", "1", "bench", {}, {}};
}

}  // namespace

double triad_bandwidth(Backend& backend, std::int64_t footprint) {
  const std::int64_t bytes = backend.info().real_bytes;
  const std::int64_t count = std::max<std::int64_t>(footprint / (3 * bytes) / 1024, 1) * 1024;
  Program program;
  const BufferId a = program.add(numbers("a", count)), b = program.add(numbers("b", count)),
                 c = program.add(numbers("c", count));
  program.step.push_back({"limit_triad",
                          {},
                          {buffer_arg(a), buffer_arg(b), buffer_arg(c), real_arg(0.5)},
                          Shape::lanes,
                          count,
                          "triad",
                          count,
                          12,
                          2});
  backend.load(program);
  return 3.0 * static_cast<double>(bytes * count) / time_passes(backend, program.step).best;
}

double fma_rate(Backend& backend) {
  const std::int64_t count = std::int64_t{1} << 18;
  Program program;
  const BufferId a = program.add(numbers("a", count));
  program.step.push_back({"limit_fma", {}, {buffer_arg(a), real_arg(0.5)}, Shape::lanes, count, "fma", count, 8, 1024});
  backend.load(program);
  return 1024.0 * static_cast<double>(count) / time_passes(backend, program.step).best;
}

}  // namespace pliant::bench
