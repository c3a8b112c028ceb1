/* Devices that a hand holds, in the C API: see pliant/haptic_device.h of C++. Included by pliant/c/haptics.h.
 *
 * Devices have handles as worlds have; a call with the handle of a destroyed one returns PLIANT_STATE. Any thread may make
 * these calls, also while another does.
 */
#ifndef PLIANT_HAPTIC_DEVICE_H
#define PLIANT_HAPTIC_DEVICE_H

#include <math.h>

#include "pliant/c/types.h"
#include "pliant/export.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Handle of a device. */
typedef struct pliant_haptic_device {
  uint64_t id; /**< 0: no device */
} pliant_haptic_device;

/** Pose of a device when it was sampled, as pliant::DeviceSample. */
typedef struct pliant_device_sample {
  size_t size;        /**< PLIANT_DEVICE_SAMPLE_INIT */
  double position[3]; /**< of the tip [m] */
  double turn[4];     /**< orientation, unit quaternion x, y, z, w */
  double time;        /**< when it was sampled, on the device's own clock [s] */
  uint64_t number;    /**< number of samples so far; 0: none has come yet */
  uint32_t buttons;   /**< a bit per button */
  uint32_t reserved;  /**< 0 */
} pliant_device_sample;
#define PLIANT_DEVICE_SAMPLE_INIT \
  { sizeof(pliant_device_sample), {0}, {0, 0, 0, 1}, 0, 0, 0, 0 }

/** Force and torque on the hand that holds the device, as pliant::DeviceWrench. */
typedef struct pliant_device_wrench {
  size_t size;      /**< PLIANT_DEVICE_WRENCH_INIT */
  double force[3];  /**< [N] */
  double torque[3]; /**< about the tip [N m] */
  double time;      /**< pliant_device_sample::time of the sample that it answers [s] */
  uint64_t number;  /**< pliant_device_sample::number of this sample; 0: it answers none */
} pliant_device_wrench;
#define PLIANT_DEVICE_WRENCH_INIT \
  { sizeof(pliant_device_wrench), {0}, {0}, 0, 0 }

/** Greatest force and torque of a device, as pliant::DeviceLimits. */
typedef struct pliant_device_limits {
  size_t size;   /**< PLIANT_DEVICE_LIMITS_INIT */
  double force;  /**< greatest force [N] */
  double torque; /**< greatest torque [N m]; 0: it exerts none */
} pliant_device_limits;
#define PLIANT_DEVICE_LIMITS_INIT \
  { sizeof(pliant_device_limits), HUGE_VAL, HUGE_VAL }

/** Counts of the samples of a device, as pliant::DeviceCounts. */
typedef struct pliant_device_counts {
  size_t size;              /**< PLIANT_DEVICE_COUNTS_INIT */
  uint64_t received;        /**< samples */
  uint64_t refused;         /**< messages, or samples of callbacks, that were malformed, not finite or out of order */
  const char* last_refusal; /**< why the last one of them was refused; "": none was. Valid as long as the handle */
} pliant_device_counts;
#define PLIANT_DEVICE_COUNTS_INIT \
  { sizeof(pliant_device_counts), 0, 0, NULL }

/** A device of your own, as a class derived from pliant::HapticDevice. A loop calls `read` and then `write` once per tick, from
 * its own thread: they must return at once, without waiting for a lock, another thread or the network. */
typedef struct pliant_device_callbacks {
  size_t size; /**< PLIANT_DEVICE_CALLBACKS_INIT */
  void* user;  /**< handed to all of them */
  /** Fills in the newest sample; the members of `sample` are those of the last call before. A sample that is not finite, or
   * whose turn is no unit quaternion, is refused, and the last good one holds. */
  void (*read)(void* user, pliant_device_sample* sample);
  /** Exerts a wrench until the next call; null: the device exerts none. */
  void (*write)(void* user, const pliant_device_wrench* wrench);
  /** Called once, when neither the handle nor a loop needs `user` any more; may be null. */
  void (*release)(void* user);
} pliant_device_callbacks;
#define PLIANT_DEVICE_CALLBACKS_INIT \
  { sizeof(pliant_device_callbacks), NULL, NULL, NULL, NULL }

/** Opens a device by a text, as pliant::open_haptic_device: "udp:5000". On failure `*out` has id 0, as in all that follow. */
PLIANT_API pliant_status pliant_haptic_device_open(const char* text, pliant_haptic_device* out);
/** Makes a device of callbacks. `limits` may be null. */
PLIANT_API pliant_status pliant_haptic_device_create(const pliant_device_callbacks* callbacks,
                                                     const pliant_device_limits* limits, pliant_haptic_device* out);
/** Destroys a handle. The device itself lives until no loop uses it. */
PLIANT_API pliant_status pliant_haptic_device_destroy(pliant_haptic_device device);
/** Counts of the samples so far. */
PLIANT_API pliant_status pliant_haptic_device_counts(pliant_haptic_device device, pliant_device_counts* out);
/** Greatest force and torque. */
PLIANT_API pliant_status pliant_haptic_device_limits(pliant_haptic_device device, pliant_device_limits* out);
/** The port of UDP or TCP that it listens on; 0: none. */
PLIANT_API pliant_status pliant_haptic_device_port(pliant_haptic_device device, int* out);

/** Makes a device without hardware, as pliant::ManualDevice. `limits` may be null. */
PLIANT_API pliant_status pliant_manual_device_create(const pliant_device_limits* limits, pliant_haptic_device* out);
/** Moves it. A device of another kind is PLIANT_USAGE, here and in the next call. */
PLIANT_API pliant_status pliant_manual_device_set_pose(pliant_haptic_device device, const double position[3],
                                                       const double turn[4], uint32_t buttons);
/** Force and torque on the hand now. */
PLIANT_API pliant_status pliant_manual_device_wrench(pliant_haptic_device device, pliant_device_wrench* out);

#ifdef __cplusplus
}
#endif

#endif
