/* The motion of the nodes of a body, as numbers. Included by pliant/c/pliant.h.
 *
 * Nodes are in the order of the body's mesh or lattice. An array has three numbers per node, and `count` is its length in
 * numbers, which must be three times that of pliant_world_body_nodes() (PLIANT_USAGE).
 */
#ifndef PLIANT_C_STATE_H
#define PLIANT_C_STATE_H

#include <stddef.h>

#include "pliant/c/types.h"
#include "pliant/export.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Copies the displacements [m] of a body's nodes. */
PLIANT_API pliant_status pliant_world_displacements(pliant_world world, size_t body, double* out, size_t count);
/** Velocities [m/s], likewise. */
PLIANT_API pliant_status pliant_world_velocities(pliant_world world, size_t body, double* out, size_t count);
/** Undeformed positions [m], likewise. */
PLIANT_API pliant_status pliant_world_rest_positions(pliant_world world, size_t body, double* out, size_t count);
/** Sets displacements [m] and velocities [m/s] of a body's nodes (see pliant::World). A null pointer leaves what there is. */
PLIANT_API pliant_status pliant_world_set_state(pliant_world world, size_t body, const double* displacements,
                                                const double* velocities, size_t count);

#ifdef __cplusplus
}
#endif

#endif
