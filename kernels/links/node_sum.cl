// Sums of forces at the nodes of a list, which go to node_load.
// node: [tiles][2][16] slot, and whether another pass has written node_load in this step: 1, which is added to, or 0, which is overwritten; -1: padding,
// which repeats a node of its tile.
typedef struct {
  __global const int* slot;
  __global const int* written;
} node_list;
static inline node_list node_list_at(__global const int* node, int i) {
  const node_list list = {node + TILE_BASE(i, 2), node + TILE_BASE(i, 2) + PLIANT_TILE};
  return list;
}
INLINE void node_sum_begin(node_list list, __global const float* node_load, real* x, real* y, real* z) {
  const texels load = texels_gather(node_load, list.slot);
  const integer adds = LOAD(list.written, 0);
  const real none = 0.0f;
  *x = adds > 0 ? texels_x(load) : none;
  *y = adds > 0 ? texels_y(load) : none;
  *z = adds > 0 ? texels_z(load) : none;
}
INLINE void node_sum_store(node_list list, real x, real y, real z, __global float* node_load) {
#if LANES == 1
  if (list.written[0] < 0) return;
  node_load[4 * list.slot[0]] = x;
  node_load[4 * list.slot[0] + 1] = y;
  node_load[4 * list.slot[0] + 2] = z;
#else
  float force[3 * LANES];
  STORE(x, force, 0);
  STORE(y, force, LANES);
  STORE(z, force, 2 * LANES);
  for (int l = 0; l < LANES; ++l) {
    if (list.written[l] < 0) continue;
    __global float* to = node_load + 4 * list.slot[l];
    to[0] = force[l];
    to[1] = force[LANES + l];
    to[2] = force[2 * LANES + l];
  }
#endif
}
