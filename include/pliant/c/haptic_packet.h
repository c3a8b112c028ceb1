/* Packets that a driver of a haptic device exchanges with Pliant (docs/haptic_devices.md), for "udp:PORT" and "shm:NAME". A
 * driver may include this header alone: it needs no library. All numbers are little-endian, all floating-point numbers have 64
 * bits.
 *
 * UDP: a datagram to Pliant is one pliant_haptic_pose, a datagram back is one pliant_haptic_wrench.
 * Shared memory: one pliant_haptic_shared; the driver publishes `pose`, Pliant publishes `wrench`.
 */
#ifndef PLIANT_HAPTIC_PACKET_H
#define PLIANT_HAPTIC_PACKET_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define PLIANT_HAPTIC_POSE_MAGIC 0x50484c50u   /**< the bytes "PLHP" */
#define PLIANT_HAPTIC_WRENCH_MAGIC 0x57484c50u /**< the bytes "PLHW" */
#define PLIANT_HAPTIC_SHARED_MAGIC 0x53484c50u /**< the bytes "PLHS" */
#define PLIANT_HAPTIC_VERSION 1u

/** From the driver: where the device is. */
typedef struct pliant_haptic_pose {
  uint32_t magic;     /**< PLIANT_HAPTIC_POSE_MAGIC */
  uint32_t version;   /**< PLIANT_HAPTIC_VERSION */
  uint32_t size;      /**< sizeof(pliant_haptic_pose): 88 */
  uint32_t buttons;   /**< a bit per button */
  uint64_t number;    /**< 1 for the first pose of a run of the driver, then increasing */
  double stamp;       /**< when it was sampled, on the driver's clock [s] */
  double position[3]; /**< of the tip [m] */
  double turn[4];     /**< orientation, unit quaternion x, y, z, w */
} pliant_haptic_pose;

/** To the driver: force and torque on the hand. */
typedef struct pliant_haptic_wrench {
  uint32_t magic;    /**< PLIANT_HAPTIC_WRENCH_MAGIC */
  uint32_t version;  /**< PLIANT_HAPTIC_VERSION */
  uint32_t size;     /**< sizeof(pliant_haptic_wrench): 80 */
  uint32_t reserved; /**< 0 */
  uint64_t number;   /**< `number` of the pose that it answers */
  double stamp;      /**< `stamp` of this pose [s] */
  double force[3];   /**< [N] */
  double torque[3];  /**< about the tip [N m] */
} pliant_haptic_wrench;

/** A message in shared memory. `sequence` is odd while its one writer changes `words`. A reader copies the words between two
 * reads of an even sequence, and has read nothing if these differ. Written and read by the functions below. */
typedef struct pliant_haptic_pose_slot {
  uint64_t sequence;                              /**< 0: nothing was published yet */
  uint64_t words[sizeof(pliant_haptic_pose) / 8]; /**< the bytes of a pliant_haptic_pose */
} pliant_haptic_pose_slot;

/** The same for a wrench. */
typedef struct pliant_haptic_wrench_slot {
  uint64_t sequence;
  uint64_t words[sizeof(pliant_haptic_wrench) / 8];
} pliant_haptic_wrench_slot;

/** The shared memory of the device "shm:NAME", at shm_open("/NAME"). Whoever comes first creates it, 256 bytes of zeros, and
 * sets the first three members, `magic` last. The name is removed by whoever created it. */
typedef struct pliant_haptic_shared {
  uint32_t magic;                   /**< PLIANT_HAPTIC_SHARED_MAGIC */
  uint32_t version;                 /**< PLIANT_HAPTIC_VERSION */
  uint32_t size;                    /**< sizeof(pliant_haptic_shared): 256 */
  uint32_t reserved;                /**< 0 */
  uint64_t gap[2];                  /**< 0 */
  pliant_haptic_pose_slot pose;     /**< written by the driver */
  uint64_t gap_before_wrench[4];    /**< 0; keeps the two writers on cache lines of their own */
  pliant_haptic_wrench_slot wrench; /**< written by Pliant */
  uint64_t gap_at_end;              /**< 0 */
} pliant_haptic_shared;

#if defined(__cplusplus)
#define PLIANT_HAPTIC_ASSERT(holds) static_assert(holds, #holds)
#else
#define PLIANT_HAPTIC_ASSERT(holds) _Static_assert(holds, #holds)
#endif
PLIANT_HAPTIC_ASSERT(sizeof(pliant_haptic_pose) == 88);
PLIANT_HAPTIC_ASSERT(offsetof(pliant_haptic_pose, number) == 16 && offsetof(pliant_haptic_pose, turn) == 56);
PLIANT_HAPTIC_ASSERT(sizeof(pliant_haptic_wrench) == 80);
PLIANT_HAPTIC_ASSERT(offsetof(pliant_haptic_wrench, number) == 16 && offsetof(pliant_haptic_wrench, torque) == 56);
PLIANT_HAPTIC_ASSERT(sizeof(pliant_haptic_shared) == 256);
PLIANT_HAPTIC_ASSERT(offsetof(pliant_haptic_shared, pose) == 32 && offsetof(pliant_haptic_shared, wrench) == 160);
#undef PLIANT_HAPTIC_ASSERT

#if defined(__GNUC__)

/** Publishes `count` words in a slot. Only one thread may publish in a slot. Never waits. */
static inline void pliant_haptic_publish(uint64_t* sequence, uint64_t* slot, const uint64_t* words, size_t count) {
  const uint64_t before = __atomic_load_n(sequence, __ATOMIC_RELAXED);
  __atomic_store_n(sequence, before | 1, __ATOMIC_RELAXED);
  for (size_t i = 0; i < count; ++i) __atomic_store_n(slot + i, words[i], __ATOMIC_RELEASE); /* after the odd sequence */
  __atomic_store_n(sequence, (before | 1) + 1, __ATOMIC_RELEASE);
}

/** Copies `count` words out of a slot. Returns the sequence that they belong to, or 0 if nothing was published yet or the
 * other side was writing: then `words` is of no use, and the caller may try again. Never waits. */
static inline uint64_t pliant_haptic_copy(const uint64_t* sequence, const uint64_t* slot, uint64_t* words, size_t count) {
  const uint64_t before = __atomic_load_n(sequence, __ATOMIC_ACQUIRE);
  if (before & 1) return 0;
  for (size_t i = 0; i < count; ++i) words[i] = __atomic_load_n(slot + i, __ATOMIC_ACQUIRE); /* before the second read */
  return __atomic_load_n(sequence, __ATOMIC_RELAXED) == before ? before : 0;
}

#endif

#ifdef __cplusplus
}
#endif

#endif
