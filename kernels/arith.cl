// Arithmetic with the same bits on every device: no contraction, a fixed order of operations, lanes as a macro.
//
// Kernels are written once over `real` and `integer`. LANES is 1 on a GPU (one element or node per work-item) and 16 on a CPU (explicit vectors); it
// does not affect results. Every product that is added is an explicit fma.
#pragma OPENCL FP_CONTRACT OFF
#include "layout.h"

#if LANES == 16
typedef float16 real;
typedef int16 integer;
#define LOAD(p, i) vload16(0, (p) + (i))
#define STORE(v, p, i) vstore16(v, 0, (p) + (i))
#define ANY(c) any(c)
#define AS_INTEGER(x) as_int16(x)
#define AS_REAL(i) as_float16(i)
#else
typedef float real;
typedef int integer;
#define LOAD(p, i) ((p)[i])
#define STORE(v, p, i) ((p)[i] = (v))
#define ANY(c) (c)
#define AS_INTEGER(x) as_int(x)
#define AS_REAL(i) as_float(i)
#endif

// PoCL passes structures of vectors through memory to a function that it does not inline: 1344 bytes for a deformation.
#if LANES == 16
#define INLINE static inline __attribute__((always_inline))
#else
#define INLINE static inline
#endif

// Aligned blocks of 4, 8 or 16 numbers: block i of a buffer, whose memory is aligned to at least 128 bytes. PoCL takes a vload4, which may not be
// aligned, apart into pairs of numbers, with twice as many instructions in the sums of shape matching.
#define BLOCK4(p, i) (((__global const float4*)(p))[i])
#define BLOCK8(p, i) (((__global const float8*)(p))[i])
#define BLOCK16(p, i) (((__global const float16*)(p))[i])

// FIRST_INDEX: first element (or node) of this work-item. FIRST_LISTED: the same for a pass over a list of tiles (Pass::active), negative for an
// empty entry. TILE_BASE: position of element e in plane 0 of a tiled array.
#define FIRST_INDEX ((int)get_global_id(0) * LANES)
#define FIRST_LISTED(list) ((list)[FIRST_INDEX / PLIANT_TILE] * PLIANT_TILE + FIRST_INDEX % PLIANT_TILE)
#define TILE_BASE(e, planes) (((e) / PLIANT_TILE) * ((planes)*PLIANT_TILE) + (e) % PLIANT_TILE)

// Store the step of an element's first fault (counted from 1), negated while the element is only INVERTED (law.cl).
#define FAULT_STEP(kind, step, seen) \
  ((kind) > 1 && (seen) <= 0 ? (integer)((step) + 1) : (kind) == 1 && (seen) == 0 ? (integer)(-(step)-1) : (seen))
#if LANES == 16
#define MARK_FAULT(kind, step, fault, i)                 \
  if (ANY((kind) > 0)) {                                 \
    const integer seen = LOAD(fault, i);                 \
    STORE(FAULT_STEP(kind, step, seen), fault, i);       \
  }
#else
#define MARK_FAULT(kind, step, fault, i) \
  if ((kind) > 0) (fault)[i] = FAULT_STEP(kind, step, (fault)[i]);
#endif
