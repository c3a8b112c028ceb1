// Forces of the hex8 cells of a lattice, a brick of 16 x 4 x 4 cells at a time (element as in tled_hex8_force, but for a cube).
//
// For a cube of edge d the mean gradients and the hourglass vectors are the seven non-constant rows of an 8 x 8 Hadamard matrix, so a
// butterfly replaces both products. With s_x, s_y, s_z = +-1 at the corners: m_x = sum_a s_x u_a, m_xy = sum_a s_x s_y u_a, ...;
// H = [m_x m_y m_z] / (4 d); q_x = fill d^3 / (4 d) P e_x, q_xy = fill k m_xy, ...; f_a = s_x q_x + ... + s_x s_y s_z q_xyz.
//
// The order of the sums is part of the Model: first along x (sum and difference of a row and its right neighbour), then y, then z; back in the
// transposed order. For each node plane the cells below precede the cells above, for each row the lower y precedes the higher; last, a node adds the
// force of the cell at its own x before that of the cell to its left.
//
// brick_neighbor: [bricks][16]. brick_rows: [bricks][2], layout.h. brick_fill: [bricks][256], 0 where there is no cell. brick_force: [bricks][1280] (layout.h) [N].
// gradient: 1 / (4 d) [1/m]; volume: d^3 / (4 d) [m^2]; stiffness: k [N/m]. fault: per cell slot from fault_base on.
#include "arith.cl"
#include "texels.cl"
#include "law.cl"
#include "brick_plane.cl"

__kernel void tled_hex8_brick_force(__global const float* node_u, __global const int* brick_neighbor,
                                    __global const int* brick_rows, __global const float* brick_fill, __global float* brick_force,
                                    __global int* fault, __global const float* restrict law_parameters, float gradient, float volume,
                                    float stiffness, int first_brick, int fault_base, int step) {
#if LANES == 16
  const int brick = first_brick + (int)get_global_id(0), lane = 0;
#else
  const int brick = first_brick + (int)get_global_id(0) / 16, lane = (int)get_local_id(0) % 16;
#endif
  __global const int* neighbor = brick_neighbor + brick * PLIANT_BRICK_NEIGHBORS;
  __global float* out = brick_force + brick * PLIANT_BRICK_FORCE;
  const vec3 zero = {0.0f, 0.0f, 0.0f};
  const face no_force = {zero, zero, zero, zero};
  const int rows = brick_rows[2 * brick], used = node_rows(rows);
  const law m = law_load(law_parameters);
  face below[4], pending[4];  // displacement butterflies of the plane below; forces of the cells below on the current plane
  for (int z = 0; z < 5; ++z) {
    face above[4];
    vec3 sum = zero, difference = zero;
    for (int y = 0; y < 5; ++y) {
      if (!ROW_USED(used, z, y)) continue;
      const int mask = (y == 4 ? 2 : 0) + (z == 4 ? 4 : 0);
      const int row = ((z & 3) * 4 + (y & 3)) * 16;
      const texels t = texels_load(node_u, neighbor[mask] * PLIANT_BRICK_NODES + row + lane);
      const vec3 lo = {texels_x(t), texels_y(t), texels_z(t)};
#if LANES == 16
      const float4 right = BLOCK4(node_u, neighbor[mask + 1] * PLIANT_BRICK_NODES + row);
      const vec3 hi = {FROM_RIGHT(lo.x, right.x), FROM_RIGHT(lo.y, right.y), FROM_RIGHT(lo.z, right.z)};
#else
      const int beside = lane == 15 ? neighbor[mask + 1] * PLIANT_BRICK_NODES + row : neighbor[mask] * PLIANT_BRICK_NODES + row + lane + 1;
      const float4 right = vload4(beside, node_u);
      const vec3 hi = {right.x, right.y, right.z};
#endif
      const vec3 s = add(lo, hi), d = sub(hi, lo);
      if (y > 0) {
        above[y - 1].ss = add(sum, s);
        above[y - 1].ds = add(difference, d);
        above[y - 1].sd = sub(s, sum);
        above[y - 1].dd = sub(d, difference);
      }
      sum = s;
      difference = d;
    }
    face forces[4];  // on the plane z - 1: of the cells below it, then of the cells above it
    for (int y = 0; y < 4; ++y) {
      if (z > 0) {
        face upper = no_force, lower = no_force;
        if (rows >> ((z - 1) * 4 + y) & 1) {
          const int cell = ((z - 1) * 4 + y) * 16 + lane;
          const real fill = LOAD(brick_fill, brick * PLIANT_BRICK_NODES + cell);
          const integer full = fill > 0.0f;
          const vec3 mx = add(below[y].ds, above[y].ds), my = add(below[y].sd, above[y].sd), mxy = add(below[y].dd, above[y].dd);
          const vec3 mz = sub(above[y].ss, below[y].ss), mxz = sub(above[y].ds, below[y].ds);
          const vec3 myz = sub(above[y].sd, below[y].sd), mxyz = sub(above[y].dd, below[y].dd);
          const real none = 0.0f;
          // As an fma, because a plain product might be contracted into the following sums.
          const real g = full ? (real)(gradient) : none;
          const mat3 h = {fma(g, mx.x, none), fma(g, my.x, none), fma(g, mz.x, none), fma(g, mx.y, none), fma(g, my.y, none),
                          fma(g, mz.y, none), fma(g, mx.z, none), fma(g, my.z, none), fma(g, mz.z, none)};
          const deformation d = deformation_of(h);
          integer kind;
          const mat3 p = stress_of(d, fill * volume, m, law_pressure(m, d.j), full, &kind);
          MARK_FAULT(kind, step, fault, fault_base + brick * PLIANT_BRICK_NODES + cell)
          const real k = fill * stiffness;
          const vec3 qx = {p.m00, p.m10, p.m20}, qy = {p.m01, p.m11, p.m21}, qz = {p.m02, p.m12, p.m22};
          const vec3 qxy = times(k, mxy);
          upper = (face){qz, times_add(k, mxz, qx), times_add(k, myz, qy), times_add(k, mxyz, qxy)};
          lower = (face){sub(zero, qz), times_add(-k, mxz, qx), times_add(-k, myz, qy), times_add(-k, mxyz, qxy)};
        }
        forces[y].ss = z > 1 ? add(pending[y].ss, lower.ss) : lower.ss;
        forces[y].ds = z > 1 ? add(pending[y].ds, lower.ds) : lower.ds;
        forces[y].sd = z > 1 ? add(pending[y].sd, lower.sd) : lower.sd;
        forces[y].dd = z > 1 ? add(pending[y].dd, lower.dd) : lower.dd;
        pending[y] = upper;
      }
    }
    // In a loop of its own: NVIDIA's compiler (driver 580.159) otherwise takes below[1] to below[3] for undefined.
    for (int y = 0; y < 4; ++y) below[y] = above[y];
    if (z > 0) write_plane(forces, used, out, z - 1, lane);
  }
  write_plane(pending, used, out, 4, lane);
}
