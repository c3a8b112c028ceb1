// Twin of kernels/fault_reduce.cl.
#include "registry.h"

namespace pliant::ref {

template <class Scalar>
void fault_reduce(Range range, const std::int32_t* fault, std::int32_t* fault_summary, std::int32_t elements) {
  for (std::int64_t lane = range.begin; lane < range.end; ++lane) {
    std::int32_t step = 0, element = 0;
    for (std::int32_t e = static_cast<std::int32_t>(lane); e < elements; e += 256) {
      if (fault[e] > 0 && (step == 0 || fault[e] < step)) {
        step = fault[e];
        element = e;
      }
    }
    fault_summary[2 * lane] = step;
    fault_summary[2 * lane + 1] = element;
  }
}

void register_fault_reduce(Registry& registry) { registry.add("fault_reduce", fault_reduce<float>, fault_reduce<double>); }

}  // namespace pliant::ref
