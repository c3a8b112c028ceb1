// Records of shape matching: four blocks of four numbers per region (PLIANT_FLSM_RECORD), and access to their fields over lanes. The correction lists
// of the ordered sums hold per entry an index (of a node's slot or a region) and a block of factors s, s o_x, s o_y, s o_z with the offset o of the
// node from the region's centre; s = 1 for a node that the sums miss, -1 for one that they include wrongly. On the way to regions the factors are
// multiplied by the node's weight. Entries are summed separately, block by block.
static inline float16 add_entry(__global const float* factors, int entry, float16 numbers, float16 sum) {
  const float4 f = BLOCK4(factors, entry);
  return fma((float16)(f.xxxx, f.yyyy, f.zzzz, f.wwww), numbers, sum);
}

#if LANES == 16
#define RECORD_TEXELS(p, k)                                                                                      \
  texels t;                                                                                                      \
  t.a = (float8)(vload4(k, p), vload4((k) + 16, p)), t.b = (float8)(vload4((k) + 4, p), vload4((k) + 20, p));    \
  t.c = (float8)(vload4((k) + 8, p), vload4((k) + 24, p)), t.d = (float8)(vload4((k) + 12, p), vload4((k) + 28, p)); \
  t.e = (float8)(vload4((k) + 32, p), vload4((k) + 48, p)), t.f = (float8)(vload4((k) + 36, p), vload4((k) + 52, p)); \
  t.g = (float8)(vload4((k) + 40, p), vload4((k) + 56, p)), t.h = (float8)(vload4((k) + 44, p), vload4((k) + 60, p)); \
  return t;
static inline texels records_block(const float* p, int block) { RECORD_TEXELS(p, block) }
static inline texels records_load(__global const float* p, int i, int block) { RECORD_TEXELS(p, 4 * i + block) }
static inline void records_store_half(float8 x, float8 y, float8 z, float8 w, __global float* p) {
  const float8 xy0 = UNPACK_LO(x, y), xy1 = UNPACK_HI(x, y), zw0 = UNPACK_LO(z, w), zw1 = UNPACK_HI(z, w);
  const float8 a = PAIRS_LO(xy0, zw0), b = PAIRS_HI(xy0, zw0), c = PAIRS_LO(xy1, zw1), d = PAIRS_HI(xy1, zw1);
  vstore4(a.lo, 0, p), vstore4(b.lo, 4, p), vstore4(c.lo, 8, p), vstore4(d.lo, 12, p);
  vstore4(a.hi, 16, p), vstore4(b.hi, 20, p), vstore4(c.hi, 24, p), vstore4(d.hi, 28, p);
}
static inline void records_store(float16 x, float16 y, float16 z, float16 w, __global float* p, int i, int block) {
  records_store_half(x.lo, y.lo, z.lo, w.lo, p + PLIANT_FLSM_RECORD * i + 4 * block);
  records_store_half(x.hi, y.hi, z.hi, w.hi, p + PLIANT_FLSM_RECORD * (i + 8) + 4 * block);
}
#else
#define records_block(p, block) vload4(block, p)
#define records_load(p, i, block) vload4(4 * (i) + (block), p)
#define records_store(x, y, z, w, p, i, block) vstore4((float4)(x, y, z, w), 4 * (i) + (block), p)
#endif
