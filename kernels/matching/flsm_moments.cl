// The moments of a region: sums of plates along z links plus the entries that the ordered sums miss; see flsm_region.cl.
static inline float16 region_moments(__global const float* node_texels, __global const float* flsm_plates, __global const int* flsm_link,
                                     __global const int* missing_offset, __global const int* missing,
                                     __global const float* missing_factor, float4 origin, int i) {
  float16 sum = BLOCK16(flsm_plates, i);
  float4 moment = 0.0f;
  int below = i, above = i;
#pragma unroll
  for (int o = 1; o <= WIDTH; ++o) {
    below = flsm_link[2 * below];
    above = flsm_link[2 * above + 1];
    const float16 at_below = BLOCK16(flsm_plates, below), at_above = BLOCK16(flsm_plates, above);
    sum = (sum + at_below) + at_above;
    moment = fma((float4)((float)o), at_above.lo.lo - at_below.lo.lo, moment);
  }
  sum = (float16)(sum.lo, sum.hi.lo, moment);
  const int first = missing_offset[i], last = missing_offset[i + 1];
  if (first == last) return sum;
  // Four numbers at a time: PoCL compiles factors that are spread over sixteen lanes to twice as many instructions.
  float4 listed = -0.0f, listed_x = listed, listed_y = listed, listed_z = listed;
  for (int e = first; e < last; ++e) {
    const float4 u = BLOCK4(node_texels, missing[e]) - origin;
    __global const float* f = missing_factor + 4 * e;
    listed = fma((float4)(f[0]), u, listed);
    listed_x = fma((float4)(f[1]), u, listed_x);
    listed_y = fma((float4)(f[2]), u, listed_y);
    listed_z = fma((float4)(f[3]), u, listed_z);
  }
  return sum + (float16)(listed, listed_x, listed_y, listed_z);
}

// Returns sum m u (o - d)^T of a work-item's regions, and sum m u in ux, uy, uz.
static inline mat3 central_moments(const float* moments, real dx, real dy, real dz, real* ux, real* uy, real* uz) {
  const texels s = records_block(moments, 0), sx = records_block(moments, 1), sy = records_block(moments, 2), sz = records_block(moments, 3);
  *ux = texels_x(s), *uy = texels_y(s), *uz = texels_z(s);
  const mat3 e = {fma(-*ux, dx, texels_x(sx)), fma(-*ux, dy, texels_x(sy)), fma(-*ux, dz, texels_x(sz)),
                  fma(-*uy, dx, texels_y(sx)), fma(-*uy, dy, texels_y(sy)), fma(-*uy, dz, texels_y(sz)),
                  fma(-*uz, dx, texels_z(sx)), fma(-*uz, dy, texels_z(sy)), fma(-*uz, dz, texels_z(sz))};
  return e;
}
