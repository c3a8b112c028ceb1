/* Cuts in the C API. Included by pliant/c/pliant.h. */
#ifndef PLIANT_C_CUT_H
#define PLIANT_C_CUT_H

#include "pliant/c/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Result of a cut, as pliant::CutResult. */
typedef struct pliant_cut {
  size_t size;      /**< PLIANT_CUT_INIT */
  int pending;      /**< 1: the worker will cut before its next batch of steps; the other members are 0 */
  int changed;      /**< 1: elements were split */
  int64_t edges;    /**< number of edges cut by this call, faces that it passed, or elements that it removed */
  double seconds;   /**< duration [s] */
  int64_t in_part;  /**< elements that still hold together where edges of theirs were cut */
  int64_t elements; /**< by how many there are more (decomposition); negative: fewer (removal) */
  double mass_lost; /**< with the elements that were removed [kg] */
} pliant_cut;
#define PLIANT_CUT_INIT \
  { sizeof(pliant_cut), 0, 0, 0, 0.0, 0, 0, 0.0 }

#ifdef __cplusplus
}
#endif

#endif
