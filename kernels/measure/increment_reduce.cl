// Once per batch: the largest component of an increment, each work-item over every 256th node. increment_summary: [256] [m]; infinite if a component is
// not finite.
#include "arith.cl"

__kernel void increment_reduce(__global const float* node_w, __global float* increment_summary, int texels) {
  const int lane = (int)get_global_id(0);
  float most = 0.0f;
  bool finite = true;
  for (int i = lane; i < texels; i += 256) {
    for (int c = 0; c < 3; ++c) {
      const float size = fabs(node_w[4 * i + c]);
      finite = finite && size < INFINITY;
      most = size > most ? size : most;
    }
  }
  increment_summary[lane] = finite ? most : INFINITY;
}
