// Once per batch: reduces the fault marks, each work-item over every 256th element. fault_summary: [256][4] step (0: none) and element of the first
// fault, number of inverted elements, and the lowest of them. The earliest step comes first, then the lowest element.
#include "arith.cl"

__kernel void fault_reduce(__global const int* fault, __global int* fault_summary, int elements) {
  const int lane = (int)get_global_id(0);
  int step = 0, element = 0, inverted = 0, lowest = 0;
  for (int e = lane; e < elements; e += 256) {
    const int found = fault[e];
    if (found > 0 && (step == 0 || found < step)) {
      step = found;
      element = e;
    }
    if (found < 0) {
      if (inverted == 0) lowest = e;
      ++inverted;
    }
  }
  __global int* out = fault_summary + PLIANT_FAULT_SUMMARY * lane;
  out[0] = step;
  out[1] = element;
  out[2] = inverted;
  out[3] = lowest;
}
