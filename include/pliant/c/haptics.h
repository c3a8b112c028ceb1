/* Touch in the C API: see pliant/haptics.h of C++. Included by pliant/c/pliant.h.
 *
 * Loops have handles as worlds have; a call with the handle of a destroyed one returns PLIANT_STATE. Any thread may make these
 * calls, also while another does.
 */
#ifndef PLIANT_HAPTICS_H
#define PLIANT_HAPTICS_H

#include "pliant/c/haptic_device.h"
#include "pliant/c/types.h"
#include "pliant/export.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Handle of a loop. */
typedef struct pliant_haptic_loop {
  uint64_t id; /**< 0: no loop */
} pliant_haptic_loop;

/** Options of a loop, as pliant::HapticOptions. */
typedef struct pliant_haptic_options {
  size_t size;            /**< PLIANT_HAPTIC_OPTIONS_INIT */
  double rate;            /**< ticks per second, 300 to 10000 */
  const char* model;      /**< "buffer", "whole", "auto", "held" or "extrapolated"; null: "auto" */
  double share;           /**< "auto": share of a tick that the model may take, 0.01 to 0.9 */
  double predict;         /**< frames by which the simulation's tool is ahead of the device, 0 to 2 */
  double lead;            /**< frames by which the buffer's rim is ahead of the simulation's last state, 0 to 2 */
  double stiffness;       /**< of the coupling between device and tool [N/m]; 0: rigid */
  double damping;         /**< of the coupling [N s/m] */
  double turn_stiffness;  /**< [N m/rad]; 0: 0.002 m^2 of `stiffness` */
  double turn_damping;    /**< [N m s/rad] */
  double device_damping;  /**< of the device itself, at least [N s/m] */
  double stale_after;     /**< age of the newest frame beyond which the force fades out [s] */
  double ramp;            /**< time of fading out, and in at the start [s] */
  double greatest_force;  /**< limit in addition to the device's own; 0: none [N] */
  double greatest_torque; /**< [N m] */
  double motion_scale;    /**< way of the tool per way of the device */
  double force_scale;     /**< force on the hand per force on the tool */
  size_t log_samples;     /**< number of device samples to keep for pliant_haptic_loop_write_log; 0: none */
  int rings;              /**< "buffer": rings of elements around the nodes that the tool touches, 1 to 100 */
  int passive;            /**< 1: the device receives no more energy than it gave */
  int align;              /**< 1: device and tool start at the same place; 0: the device speaks in scene coordinates */
  int realtime;           /**< 1: request real-time priority */
  int grip_button;        /**< bit of the device's buttons that makes a tool with a grip hold tissue; -1: none */
} pliant_haptic_options;
#define PLIANT_HAPTIC_OPTIONS_INIT \
  { sizeof(pliant_haptic_options), 1000, NULL, 0.3, 1, 1, 0, 0, 0, 0, 0.1, 0.25, 0.1, 0, 0, 1, 1, 0, 3, 1, 1, 1, 0 }

/** One tick, as pliant::HapticSample. */
typedef struct pliant_haptic_sample {
  size_t size;        /**< PLIANT_HAPTIC_SAMPLE_INIT; the same in all elements of an array */
  int64_t tick;       /**< number since the start, from 1 */
  double time;        /**< wall time since the start [s] */
  double device[3];   /**< position of the device, in scene coordinates [m] */
  double position[3]; /**< of the tool's origin [m] */
  double tissue[3];   /**< force of the tissue on the tool [N] */
  double force[3];    /**< on the hand, in scene coordinates [N] */
} pliant_haptic_sample;
#define PLIANT_HAPTIC_SAMPLE_INIT                            \
  {                                                          \
    sizeof(pliant_haptic_sample), 0, 0, {0}, {0}, {0}, { 0 } \
  }

/** State of a loop, as pliant::HapticState. */
typedef struct pliant_haptic_state {
  size_t size;         /**< PLIANT_HAPTIC_STATE_INIT */
  int running;         /**< 1: until pliant_haptic_loop_stop */
  int realtime;        /**< 1: it got real-time priority */
  const char* model;   /**< in use; valid as long as the handle */
  int64_t ticks;       /**< so far */
  int64_t late;        /**< ticks that were left out because one before took too long */
  double work_mean;    /**< time of a tick's work: mean [s] */
  double work_most;    /**< largest [s] */
  double work_p999;    /**< the 99.9th percentile [s] */
  double delay_p999;   /**< how much later than planned ticks begin: the 99.9th percentile [s] */
  double delay_most;   /**< largest [s] */
  int64_t frames;      /**< received from the world */
  double age;          /**< of the newest one [s] */
  int64_t elements;    /**< of the buffer; 0: nothing is near the tool */
  int64_t buffers;     /**< built so far */
  int64_t resets;      /**< buffers that diverged and restarted */
  int64_t contacts;    /**< points that touch */
  int64_t stale;       /**< ticks without a recent frame */
  int64_t limited;     /**< ticks whose force was limited */
  int64_t not_finite;  /**< ticks whose force was no number, and became 0 */
  int64_t corrections; /**< ticks in which the force was reduced for passivity */
  double energy;       /**< of the device's account [J] */
  double least_energy; /**< at least so far [J] */
  int64_t refused;     /**< poses that the world refused */
  int rings;           /**< of the buffer; -1: the whole body */
  int substeps;        /**< of the buffer, in a tick */
} pliant_haptic_state;
#define PLIANT_HAPTIC_STATE_INIT \
  { sizeof(pliant_haptic_state), 0, 0, NULL, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 }

/** Starts a loop that couples a device with a tool of a world, as pliant::HapticLoop. `options` may be null. On failure `*out`
 * has id 0. The loop may live longer than the handles of world and device. */
PLIANT_API pliant_status pliant_haptic_loop_create(pliant_world world, const char* tool, pliant_haptic_device device,
                                                   const pliant_haptic_options* options, pliant_haptic_loop* out);
/** Ends its thread; the device gets a zero force, and the tool stays where it is. State, samples and log remain. */
PLIANT_API pliant_status pliant_haptic_loop_stop(pliant_haptic_loop loop);
/** The same, and frees its memory. */
PLIANT_API pliant_status pliant_haptic_loop_destroy(pliant_haptic_loop loop);
/** Its state, and the newest tick in `last`, which may be null, as may be `out`. */
PLIANT_API pliant_status pliant_haptic_loop_state(pliant_haptic_loop loop, pliant_haptic_state* out,
                                                  pliant_haptic_sample* last);
/** Fills the oldest `count` ticks that no call returned yet; `*given` receives how many those are. Later ones wait; when 65536
 * wait, further ones are left out. */
PLIANT_API pliant_status pliant_haptic_loop_samples(pliant_haptic_loop loop, pliant_haptic_sample* out, size_t count,
                                                    size_t* given);
/** Writes the device's samples as a stroke, which "file:" plays. PLIANT_STATE without `log_samples`. */
PLIANT_API pliant_status pliant_haptic_loop_write_log(pliant_haptic_loop loop, const char* file);

#ifdef __cplusplus
}
#endif

#endif
