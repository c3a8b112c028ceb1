// Once per batch: the largest component of an increment, each work-item over every 256th node. increment_summary: [256] [m]. NaN is skipped: it shows
// up as a fault of an element.
#include "arith.cl"

__kernel void increment_reduce(__global const float* node_w, __global float* increment_summary, int texels) {
  const int lane = (int)get_global_id(0);
  float most = 0.0f;
  for (int i = lane; i < texels; i += 256) {
    for (int c = 0; c < 3; ++c) {
      const float size = fabs(node_w[4 * i + c]);
      most = size > most ? size : most;
    }
  }
  increment_summary[lane] = most;
}
