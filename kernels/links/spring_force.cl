// Forces of springs between two points of links, by spring_pull.cl: scale d on the first, the opposite on the second.
// spring_points: [tiles][2][16] texels of link_u of the ends a, b. spring_data: [tiles][8][16] D (3) [m], l0 [m], |D|^2 - l0^2 [m^2], two parameters of the law, damper [N s/m].
// link_force: texels from force_base on, the force on a [N].
#include "arith.cl"
#include "texels.cl"
#include "spring_pull.cl"

#define DATA(k) LOAD(data, (k)*PLIANT_TILE)

__kernel void spring_force(__global const float* link_u, __global const float* link_w, __global const int* spring_points,
                           __global const float* spring_data, __global const float* spring_curve, __global float* link_force,
                           __global const float* step_params, int segments, int force_base) {
  const int i = FIRST_INDEX;
  __global const int* points = spring_points + TILE_BASE(i, 2);
  __global const float* data = spring_data + TILE_BASE(i, PLIANT_SPRING_PLANES);
  const texels ua = texels_gather(link_u, points), ub = texels_gather(link_u, points + PLIANT_TILE);
  const real ux = texels_x(ub) - texels_x(ua), uy = texels_y(ub) - texels_y(ua), uz = texels_z(ub) - texels_z(ua), none = 0.0f;
#if VISCOUS
  const texels wa = texels_gather(link_w, points), wb = texels_gather(link_w, points + PLIANT_TILE);
  const real wx = texels_x(wb) - texels_x(wa), wy = texels_y(wb) - texels_y(wa), wz = texels_z(wb) - texels_z(wa);
#else
  const real wx = none, wy = none, wz = none;
#endif
  real dx, dy, dz;
  const real scale = spring_pull(DATA(0), DATA(1), DATA(2), ux, uy, uz, DATA(3), DATA(4), DATA(5), DATA(6), spring_curve, segments, wx, wy, wz,
                                 DATA(7), step_params[0], &dx, &dy, &dz);
  texels_store(scale * dx, scale * dy, scale * dz, none, link_force, force_base + i);
}
