// Once per batch: the first fault among every 256th element. fault_summary: [256][2] step (0: none) and element.
// The earliest step wins, then the lowest element.
#include "arith.cl"

__kernel void fault_reduce(__global const int* fault, __global int* fault_summary, int elements) {
  const int lane = (int)get_global_id(0);
  int step = 0, element = 0;
  for (int e = lane; e < elements; e += 256) {
    const int found = fault[e];
    if (found > 0 && (step == 0 || found < step)) {
      step = found;
      element = e;
    }
  }
  fault_summary[2 * lane] = step;
  fault_summary[2 * lane + 1] = element;
}
