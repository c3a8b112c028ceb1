/* Blades of a scene that cut by force (docs/cutting.md), in the C API. Included by pliant/c/pliant.h. */
#ifndef PLIANT_C_BLADES_H
#define PLIANT_C_BLADES_H

#include <stddef.h>

#include "pliant/c/types.h"
#include "pliant/export.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Place of a blade that cuts by force and the load on it, as pliant::BladeForce. The name is valid as long as the world. */
typedef struct pliant_blade_force {
  size_t size;          /**< PLIANT_BLADE_FORCE_INIT; the same in all elements of an array */
  const char* name;     /**< name in the scene */
  double a[3];          /**< one end of its edge [m] */
  double b[3];          /**< the other end [m] */
  double force[3];      /**< on the blade in the last step [N] */
  double torque[3];     /**< about the middle of its edge [N m] */
  double max_force;     /**< largest force so far [N] */
  double work;          /**< done on tissue so far [J] */
  double fracture;      /**< of it, what cutting took [J] */
  double gave_way;      /**< time at which tissue first gave way [s]; -1: not yet */
  int present;          /**< 0: its path has not begun or has ended, or it is lifted */
  int pressing;         /**< 1: a part of its edge is in contact */
  double face_force[3]; /**< of the force, that on its two faces [N] */
  double face_normal;   /**< sum of the forces that press on its two sides, across it [N] */
  double face_work;     /**< of the work, that of its faces [J] */
} pliant_blade_force;
#define PLIANT_BLADE_FORCE_INIT \
  { sizeof(pliant_blade_force), NULL, {0}, {0}, {0}, {0}, 0, 0, 0, 0, 0, 0, {0}, 0, 0 }

/** A potential cutting attempt, as pliant::CutAttempt. The names are valid as long as the world. */
typedef struct pliant_cut_attempt {
  size_t size;        /**< PLIANT_CUT_ATTEMPT_INIT; the same in all elements of an array */
  const char* blade;  /**< name in the scene */
  const char* body;   /**< name in the scene */
  int64_t stroke;     /**< of the blade, counted from 0 */
  double time;        /**< [s] */
  double position[3]; /**< of the point of contact [m] */
  double rest[3];     /**< the same place on the undeformed surface [m] */
  int32_t from;       /**< vertex that was in contact, of frames before any cut */
  int32_t to;         /**< vertex that is */
  int gave_way;       /**< 1: tissue had given way there; 0: the blade pressed on it */
  int reserved;       /**< 0 */
} pliant_cut_attempt;
#define PLIANT_CUT_ATTEMPT_INIT \
  { sizeof(pliant_cut_attempt), NULL, NULL, 0, 0, {0}, {0}, 0, 0, 0, 0 }

/** Moves a blade of the scene that cuts by force to the segment from `a` to `b` [m] within `seconds` (see pliant::World). */
PLIANT_API pliant_status pliant_world_drive_blade(pliant_world world, const char* blade, const double a[3], const double b[3],
                                                  double seconds);
/** Fills the first `count` blades that cut by force; `*needed` (may be null) receives their number. Does not wait. */
PLIANT_API pliant_status pliant_world_blade_forces(pliant_world world, pliant_blade_force* out, size_t count, size_t* needed);
/** Fills the oldest `count` attempts that no call returned yet; `*given` receives how many those are. Later ones wait. */
PLIANT_API pliant_status pliant_world_cut_attempts(pliant_world world, pliant_cut_attempt* out, size_t count, size_t* given);

#ifdef __cplusplus
}
#endif

#endif
