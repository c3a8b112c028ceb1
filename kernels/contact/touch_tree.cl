// Bounding boxes of groups of tiles (touch_box). touch_node: [nodes][4] in depth-first order: its box, the next node outside its subtree, first tile,
// last tile + 1; a node with one tile uses the tile's box.
#include "arith.cl"

__kernel void touch_tree(__global const int* touch_node, __global float* touch_box) {
  __global const int* node = touch_node + PLIANT_TOUCH_TREE * (int)get_global_id(0);
  if (node[3] - node[2] == 1) return;
  __global float* box = touch_box + PLIANT_TOUCH_BOX * node[0];
  for (int b = 0; b < PLIANT_TOUCH_BOX; ++b) {
    const int high = (b & 1) == 1 || b == 18;
    float most = touch_box[PLIANT_TOUCH_BOX * node[2] + b];
    for (int tile = node[2] + 1; tile < node[3]; ++tile) {
      const float v = touch_box[PLIANT_TOUCH_BOX * tile + b];
      most = (high ? v > most : v < most) ? v : most;
    }
    box[b] = most;
  }
}
