// Twin of kernels/measure/fault_reduce.cl.
#include "cpu_ref/registry.h"
#include "layout.h"

namespace pliant::ref {

template <class Scalar>
void fault_reduce(Range range, const std::int32_t* fault, std::int32_t* fault_summary, std::int32_t elements) {
  for (std::int64_t lane = range.begin; lane < range.end; ++lane) {
    std::int32_t step = 0, element = 0, inverted = 0, lowest = 0;
    for (std::int32_t e = static_cast<std::int32_t>(lane); e < elements; e += 256) {
      if (fault[e] > 0 && (step == 0 || fault[e] < step)) {
        step = fault[e];
        element = e;
      }
      if (fault[e] < 0 && inverted++ == 0) lowest = e;
    }
    std::int32_t* out = fault_summary + PLIANT_FAULT_SUMMARY * lane;
    out[0] = step;
    out[1] = element;
    out[2] = inverted;
    out[3] = lowest;
  }
}

void register_fault_reduce(Registry& registry) { registry.add("fault_reduce", fault_reduce<float>, fault_reduce<double>); }

}  // namespace pliant::ref
