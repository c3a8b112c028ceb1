/* Free running of a world in the C API: see pliant/live.h of C++. Included by pliant/c/pliant.h. */
#ifndef PLIANT_LIVE_H
#define PLIANT_LIVE_H

#include "pliant/c/types.h"
#include "pliant/export.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Options of pliant_world_run_live, as pliant::LiveOptions. */
typedef struct pliant_live_options {
  size_t size;  /**< PLIANT_LIVE_OPTIONS_INIT */
  double rate;  /**< frames per second of wall time, 1 to 1000 */
  double speed; /**< simulated seconds per second of wall time, 0.001 to 1000 */
  int ahead;    /**< frames that the worker may be ahead of the display, 0 to 4 */
  int reserved; /**< 0 */
} pliant_live_options;
#define PLIANT_LIVE_OPTIONS_INIT \
  { sizeof(pliant_live_options), 60, 1, 0, 0 }

/** Performance of a world that runs freely, as pliant::LiveState. */
typedef struct pliant_live_state {
  size_t size;      /**< PLIANT_LIVE_STATE_INIT */
  int running;      /**< 1 between pliant_world_run_live and pliant_world_stop_live */
  int reserved;     /**< 0 */
  int64_t frames;   /**< frames made */
  int64_t late;     /**< periods in which no frame was begun */
  int64_t dropped;  /**< frames that nobody fetched */
  double real_time; /**< simulated time over `speed` times wall time of the last second */
  double load;      /**< share of a period that a frame of full length takes */
  double lost;      /**< simulated time that was given up [s] */
} pliant_live_state;
#define PLIANT_LIVE_STATE_INIT \
  { sizeof(pliant_live_state), 0, 0, 0, 0, 0, 0, 0, 0 }

/** Something that happened, as pliant::Event. The texts are valid until the next pliant_world_events of this world. */
typedef struct pliant_event {
  size_t size;         /**< PLIANT_EVENT_INIT; the same in all elements of an array */
  const char* kind;    /**< kind of event, for example "cut" */
  const char* subject; /**< name of the body or tool, id of the grab, or file; empty: the whole scene */
  const char* text;    /**< a sentence for people */
  int64_t step;        /**< steps since the start */
  double time;         /**< [s] */
  double position[3];  /**< where it happened [m], if `placed` */
  double amount;       /**< how much, according to `kind` */
  int placed;          /**< 1: `position` is set */
  int reserved;        /**< 0 */
} pliant_event;
#define PLIANT_EVENT_INIT \
  { sizeof(pliant_event), NULL, NULL, NULL, 0, 0, {0}, 0, 0, 0 }

/** Force of one step on a tool, or of one update of a grab on the tissue, as pliant::ForceSample. */
typedef struct pliant_force_sample {
  size_t size;      /**< PLIANT_FORCE_SAMPLE_INIT; the same in all elements of an array */
  int64_t step;     /**< the step at whose end it acted */
  double time;      /**< [s] */
  double force[3];  /**< [N] */
  double torque[3]; /**< about the tool's origin [N m]; zero for grabs */
} pliant_force_sample;
#define PLIANT_FORCE_SAMPLE_INIT                  \
  {                                               \
    sizeof(pliant_force_sample), 0, 0, {0}, { 0 } \
  }

/** Lets the worker run freely, paced by the wall clock (see pliant::World). `options` may be null. */
PLIANT_API pliant_status pliant_world_run_live(pliant_world world, const pliant_live_options* options);
/** Ends that after the frame at work, and reports as pliant_world_wait. `out` may be null. */
PLIANT_API pliant_status pliant_world_stop_live(pliant_world world, pliant_report* out);
/** What free running achieves. */
PLIANT_API pliant_status pliant_world_live_state(pliant_world world, pliant_live_state* out);
/** Fills the oldest `count` events that no call returned yet; `*given` receives how many those are. Later ones wait. */
PLIANT_API pliant_status pliant_world_events(pliant_world world, pliant_event* out, size_t count, size_t* given);
/** Fills the forces on a tool in the last steps after step `after` (-1: all), the oldest `count` of them. `*needed` (may be
 * null) receives how many there are, 4096 at most. */
PLIANT_API pliant_status pliant_world_force_trace(pliant_world world, const char* tool, int64_t after, pliant_force_sample* out,
                                                  size_t count, size_t* needed);
/** The same for each update of a grab. */
PLIANT_API pliant_status pliant_world_grab_trace(pliant_world world, uint64_t grab, int64_t after, pliant_force_sample* out,
                                                 size_t count, size_t* needed);
/** After a divergence, continues from the last good state, at rest (see pliant::World). */
PLIANT_API pliant_status pliant_world_recover(pliant_world world);

#ifdef __cplusplus
}
#endif

#endif
