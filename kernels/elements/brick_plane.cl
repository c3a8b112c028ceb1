// The planes of nodes of a brick (tled_hex8_brick_force): butterflies of its faces and the output of its forces.
typedef struct {
  real x, y, z;
} vec3;
static inline vec3 add(vec3 a, vec3 b) {
  const vec3 r = {a.x + b.x, a.y + b.y, a.z + b.z};
  return r;
}
static inline vec3 sub(vec3 a, vec3 b) {
  const vec3 r = {a.x - b.x, a.y - b.y, a.z - b.z};
  return r;
}
static inline vec3 times(real s, vec3 a) {
  const vec3 r = {s * a.x, s * a.y, s * a.z};
  return r;
}
static inline vec3 times_add(real s, vec3 a, vec3 b) {
  const vec3 r = {fma(s, a.x, b.x), fma(s, a.y, b.y), fma(s, a.z, b.z)};
  return r;
}
// A cell face normal to z after the butterflies along x and y: sums, differences along x, along y, along both.
typedef struct {
  vec3 ss, ds, sd, dd;
} face;

// The rows of nodes (bit 5 z + y) of a brick's rows of cells (bit 4 z + y). An organ leaves half of its bricks' rows empty. On a GPU, whose work-items
// process rows side by side, they cost nothing.
static inline int node_rows(int cells) {
  int lower = 0;
  for (int z = 0; z < 4; ++z) lower |= (cells >> 4 * z & 15) << 5 * z;
  return lower | lower << 1 | lower << 5 | lower << 6;
}
#if LANES == 16
#define ROW_USED(used, z, y) ((used) >> (5 * (z) + (y)) & 1)
#else
#define ROW_USED(used, z, y) 1
#endif

// Inverse butterflies along y and x: what row y of a plane of nodes gets from the cells to its right, and what their right neighbours get.
static inline void row_forces(const face* forces, int y, vec3* lo, vec3* hi) {
  vec3 s, d;
  if (y > 0) {
    s = add(forces[y - 1].ss, forces[y - 1].sd);
    d = add(forces[y - 1].ds, forces[y - 1].dd);
    if (y < 4) {
      s = add(s, sub(forces[y].ss, forces[y].sd));
      d = add(d, sub(forces[y].ds, forces[y].dd));
    }
  } else {
    s = sub(forces[0].ss, forces[0].sd);
    d = sub(forces[0].ds, forces[0].dd);
  }
  *lo = sub(s, d);
  *hi = add(s, d);
}

#if LANES == 16
#define FROM_RIGHT(v, last) (float16)((v).s12345678, (v).s9abc, (v).sde, (v).sf, last)
#define FROM_LEFT(v) (float16)(-0.0f, (v).s01234567, (v).s89ab, (v).scd, (v).se)
static inline void write_plane(const face* forces, int used, __global float* out, int plane, int lane) {
  for (int y = 0; y < 5; ++y) {
    vec3 lo, hi;
    const int row = plane * 5 + y;
    __global float* last = out + PLIANT_BRICK_FORCE_X16 + 3 * row;
    if (!ROW_USED(used, plane, y)) {
      const real none = 0.0f;
      STORE(none, out, (3 * row) * 16);
      STORE(none, out, (3 * row + 1) * 16);
      STORE(none, out, (3 * row + 2) * 16);
      last[0] = last[1] = last[2] = 0.0f;
      continue;
    }
    row_forces(forces, y, &lo, &hi);
    STORE(lo.x + FROM_LEFT(hi.x), out, (3 * row) * 16);
    STORE(lo.y + FROM_LEFT(hi.y), out, (3 * row + 1) * 16);
    STORE(lo.z + FROM_LEFT(hi.z), out, (3 * row + 2) * 16);
    last[0] = hi.x.sf;
    last[1] = hi.y.sf;
    last[2] = hi.z.sf;
  }
}
#else
// With one lane, a row of sixteen work-items processes a brick, one or more per work-group. A work-item reads its right neighbour's displacement
// itself, and passes its force to it through the memory of the sums, because PoCL 3.1 shares a __local array between work-groups that run at the same
// time.
static inline void write_plane(const face* forces, int used, __global float* out, int plane, int lane) {
  __global float* sums = out + plane * (5 * 48) + lane;
  vec3 lo[5], hi[5];
  for (int y = 0; y < 5; ++y) {
    row_forces(forces, y, &lo[y], &hi[y]);
    sums[48 * y] = hi[y].x;
    sums[48 * y + 16] = hi[y].y;
    sums[48 * y + 32] = hi[y].z;
  }
  barrier(CLK_GLOBAL_MEM_FENCE);
  for (int y = 0; y < 5; ++y) {
    __global float* last = out + PLIANT_BRICK_FORCE_X16 + 3 * (plane * 5 + y);
    if (lane == 15) {
      last[0] = hi[y].x;
      last[1] = hi[y].y;
      last[2] = hi[y].z;
    }
    hi[y].x = lane > 0 ? sums[48 * y - 1] : -0.0f;
    hi[y].y = lane > 0 ? sums[48 * y + 15] : -0.0f;
    hi[y].z = lane > 0 ? sums[48 * y + 31] : -0.0f;
  }
  barrier(CLK_GLOBAL_MEM_FENCE);
  for (int y = 0; y < 5; ++y) {
    sums[48 * y] = lo[y].x + hi[y].x;
    sums[48 * y + 16] = lo[y].y + hi[y].y;
    sums[48 * y + 32] = lo[y].z + hi[y].z;
  }
}
#endif
