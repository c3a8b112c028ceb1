/* Pliant for C and for everything that can call C.
 *
 * Every function returns a status; the text of the last error of the calling thread is pliant_last_error(). No exception
 * crosses this interface. A world is named by a handle, a number that is never used again: a call with the handle of a
 * destroyed world is refused (PLIANT_STATE) and touches nothing. Threads: as for pliant::World (pliant/world.h), any thread but
 * one at a time per world; handles may be made and destroyed by all threads. SI units throughout.
 */
#ifndef PLIANT_PLIANT_H
#define PLIANT_PLIANT_H

#include <stddef.h>
#include <stdint.h>

#include "pliant/export.h"
#include "pliant/version.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The numbers of pliant::ErrorCode. */
typedef enum pliant_status {
  PLIANT_OK = 0,
  PLIANT_INTERNAL = 1, /**< a defect of Pliant itself, or out of memory */
  PLIANT_INPUT = 2,    /**< the scene, a mesh or an option */
  PLIANT_DIVERGED = 4, /**< the world had diverged before; its last good state can still be read */
  PLIANT_USAGE = 5,    /**< a null pointer, an index out of range, a buffer of the wrong size */
  PLIANT_IO = 6,       /**< a file is missing, cannot be read or cannot be written */
  PLIANT_DEVICE = 7,   /**< the backend cannot be opened or was lost; the last state that was read can still be read */
  PLIANT_STATE = 8     /**< the handle of a destroyed world, two threads at once, tools without `interactive` */
} pliant_status;

/** A world, or none (id 0). */
typedef struct pliant_world {
  uint64_t id; /**< 0: none */
} pliant_world;

/** Begin with PLIANT_OPTIONS_INIT, so that a library with more options knows which ones are set. */
typedef struct pliant_options {
  size_t size;         /**< sizeof(pliant_options) */
  const char* backend; /**< auto, cpu, cpu:double, cpu:check, opencl or opencl:N; null: auto */
  double dt;           /**< [s]; 0: what the scene says */
  int normals;         /**< 1: frames have normals */
  int interactive;     /**< 1: grabs and pushes are possible */
  int cutting;         /**< 1: prepare for cuts at the start */
} pliant_options;
#define PLIANT_OPTIONS_INIT \
  { sizeof(pliant_options), NULL, 0.0, 1, 0, 0 }

/** A triangle surface in memory, which a scene names "memory:0", "memory:1", ... Copied. */
typedef struct pliant_surface {
  const double* vertices;   /**< [m], shape [vertex_count][3] */
  size_t vertex_count;      /**< vertices */
  const int32_t* triangles; /**< shape [triangle_count][3], counter-clockwise from outside */
  size_t triangle_count;    /**< triangles */
} pliant_surface;

/** Numbers that do not change while a world runs. */
typedef struct pliant_info {
  size_t bodies;    /**< in the order of the scene */
  size_t vertices;  /**< of the surface, as of the start */
  size_t triangles; /**< likewise */
  int64_t nodes;    /**< of all bodies */
  int64_t elements; /**< of all bodies */
  int bit_exact;    /**< 1: the device passed the start-up probe */
} pliant_info;

/** What a call of step did: see pliant::StepReport. */
typedef struct pliant_report {
  int64_t done;       /**< steps of this call */
  int64_t step;       /**< steps since the start */
  double time;        /**< [s] */
  double dt;          /**< [s], of the step to come */
  int diverged;       /**< 1: the world holds the last good state */
  int at_equilibrium; /**< 1: nothing is left to do */
} pliant_report;

/** The surface at one step: see pliant::Frame. The pointers hold until the next pliant_world_frame or pliant_world_destroy of
 * the same world. */
typedef struct pliant_frame {
  int64_t step;                 /**< steps since the start */
  double time;                  /**< [s] */
  const float* positions;       /**< [m], shape [vertex_count][4]; the fourth is 0 */
  const float* normals;         /**< unit length, shape [vertex_count][4], or null */
  size_t vertex_count;          /**< vertices */
  const int32_t* triangles;     /**< shape [triangle_count][3] */
  size_t triangle_count;        /**< triangles */
  const uint8_t* cut_faces;     /**< shape [triangle_count], or null: there are none */
  uint64_t topology_version;    /**< changes when vertices or triangles are others than before */
  size_t dirty_vertex_first;    /**< first vertex that may have moved since the frame before */
  size_t dirty_vertex_count;    /**< and how many */
  size_t dirty_triangle_first;  /**< first triangle that may be another one */
  size_t dirty_triangle_count;  /**< and how many; 0 unless the topology changed */
  const size_t* body_vertices;  /**< first vertex and count, shape [bodies][2]; vertex k of a body is always the same */
  const size_t* body_triangles; /**< first triangle and count, likewise */
} pliant_frame;

/** What a cut did: see pliant::CutResult. */
typedef struct pliant_cut {
  int pending;    /**< 1: done at the start of the next batch of steps, nothing else is known */
  int changed;    /**< 1: elements were divided */
  int64_t edges;  /**< edges between nodes that were cut now */
  double seconds; /**< what it took [s] */
} pliant_cut;

/** "0.1.0", of the library that runs. */
PLIANT_API const char* pliant_version(void);
/** The last error of this thread; "" if there was none. Holds until this thread's next call. */
PLIANT_API const char* pliant_last_error(void);
/** "ok", "input", ... */
PLIANT_API const char* pliant_status_name(pliant_status status);

/** `options` may be null. On failure `out` names no world. */
PLIANT_API pliant_status pliant_world_open(const char* scene_file, const pliant_options* options, pliant_world* out);
/** The text of a scene file; relative paths start from `folder` (null: the working folder). */
PLIANT_API pliant_status pliant_world_parse(const char* scene_text, const char* folder, const pliant_surface* surfaces,
                                            size_t surface_count, const pliant_options* options, pliant_world* out);
PLIANT_API pliant_status pliant_world_destroy(pliant_world world);

PLIANT_API pliant_status pliant_world_info(pliant_world world, pliant_info* out);
/** Name and device of the backend into `text`, cut to `size` bytes with the closing 0. */
PLIANT_API pliant_status pliant_world_backend(pliant_world world, char* text, size_t size);
PLIANT_API pliant_status pliant_world_body_nodes(pliant_world world, size_t body, int64_t* out);

/** A divergence is PLIANT_OK here and told by `diverged`; the next step is PLIANT_DIVERGED. `out` may be null. */
PLIANT_API pliant_status pliant_world_step(pliant_world world, int64_t steps, pliant_report* out);
PLIANT_API pliant_status pliant_world_advance(pliant_world world, double seconds, pliant_report* out);
/** `*started` is 0 while the worker is still busy with the steps before. */
PLIANT_API pliant_status pliant_world_advance_async(pliant_world world, int64_t steps, int* started);
PLIANT_API pliant_status pliant_world_busy(pliant_world world, int* out);
/** `*fresh` is 1 if pliant_world_frame would give another frame than last time. */
PLIANT_API pliant_status pliant_world_poll(pliant_world world, int* fresh);
PLIANT_API pliant_status pliant_world_wait(pliant_world world, pliant_report* out);

PLIANT_API pliant_status pliant_world_frame(pliant_world world, pliant_frame* out);
/** Copies of the newest frame's arrays, three numbers per vertex or triangle; `count` is the length of `out` in numbers and
 * must fit. */
PLIANT_API pliant_status pliant_world_positions(pliant_world world, float* out, size_t count);
PLIANT_API pliant_status pliant_world_normals(pliant_world world, float* out, size_t count);
PLIANT_API pliant_status pliant_world_triangles(pliant_world world, int32_t* out, size_t count);
/** One number per triangle: 1 on a cut, else 0. */
PLIANT_API pliant_status pliant_world_cut_faces(pliant_world world, uint8_t* out, size_t count);
/** Displacements [m] of a body's nodes, three per node. */
PLIANT_API pliant_status pliant_world_displacements(pliant_world world, size_t body, double* out, size_t count);
/** Equal for equal bits of the state. */
PLIANT_API pliant_status pliant_world_hash(pliant_world world, uint64_t* out);

/** `radius` [m], `stiffness` [N/m] and `max_force` [N]: 0 for automatic, see pliant::GrabOptions. */
PLIANT_API pliant_status pliant_world_grab(pliant_world world, int32_t vertex, double radius, double stiffness,
                                           double max_force, uint64_t* out);
PLIANT_API pliant_status pliant_world_move_grab(pliant_world world, uint64_t grab, const double target[3]);
PLIANT_API pliant_status pliant_world_release(pliant_world world, uint64_t grab);
/** A force [N] on a vertex until it is set again. */
PLIANT_API pliant_status pliant_world_push(pliant_world world, int32_t vertex, const double force[3]);
PLIANT_API pliant_status pliant_world_clear_tools(pliant_world world);

/** Cut all bodies where triangles [m], shape [triangle_count][3][3], cross them now. `out` may be null. */
PLIANT_API pliant_status pliant_world_cut(pliant_world world, const double* triangles, size_t triangle_count, pliant_cut* out);
/** Move a blade of any name to the segment from `a` to `b` [m]; it cuts what it sweeps over. The first call only puts it there.
 * `out` may be null. */
PLIANT_API pliant_status pliant_world_move_blade(pliant_world world, const char* blade, const double a[3], const double b[3],
                                                 pliant_cut* out);
/** Take a blade out: the next move puts it somewhere else without a cut. */
PLIANT_API pliant_status pliant_world_lift_blade(pliant_world world, const char* blade);
/** Pieces that a body has come apart into. */
PLIANT_API pliant_status pliant_world_pieces(pliant_world world, size_t body, int64_t* out);

PLIANT_API pliant_status pliant_world_save(pliant_world world, const char* file);
PLIANT_API pliant_status pliant_world_load(pliant_world world, const char* file);
PLIANT_API pliant_status pliant_world_reset(pliant_world world);

#ifdef __cplusplus
}
#endif

#endif
