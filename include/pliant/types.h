/* The types of the C API (pliant/pliant.h).
 *
 * Structs grow: later versions add members at the end. Each begins with its size, which its PLIANT_..._INIT sets, so that a
 * program and a library of different versions understand each other. The library reads and writes no more than `size` bytes.
 * What it fills in but does not know is 0; what it is told but does not know has to be 0 (PLIANT_USAGE). A size below that of
 * the first version or above 4096 is PLIANT_USAGE, and nothing happens.
 */
#ifndef PLIANT_TYPES_H
#define PLIANT_TYPES_H

#include <stddef.h>
#include <stdint.h>

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

/** How a world runs its scene. */
typedef struct pliant_options {
  size_t size;         /**< PLIANT_OPTIONS_INIT */
  const char* backend; /**< auto, cpu, cpu:double, cpu:check, opencl or opencl:N; null: auto */
  double dt;           /**< [s]; 0: what the scene says */
  int normals;         /**< 1: frames have normals */
  int interactive;     /**< 1: grabs and pushes are possible */
  int cutting;         /**< 1: prepare for cuts at the start */
  int reserved;        /**< 0 */
} pliant_options;
#define PLIANT_OPTIONS_INIT \
  { sizeof(pliant_options), NULL, 0.0, 1, 0, 0, 0 }

/** A triangle surface in memory, which a scene names "memory:0", "memory:1", ... Copied. */
typedef struct pliant_surface {
  size_t size;              /**< PLIANT_SURFACE_INIT; the same in all of an array */
  const double* vertices;   /**< [m], shape [vertex_count][3] */
  size_t vertex_count;      /**< vertices */
  const int32_t* triangles; /**< shape [triangle_count][3], counter-clockwise from outside */
  size_t triangle_count;    /**< triangles */
} pliant_surface;
#define PLIANT_SURFACE_INIT \
  { sizeof(pliant_surface), NULL, 0, NULL, 0 }

/** Numbers that do not change while a world runs. */
typedef struct pliant_info {
  size_t size;      /**< PLIANT_INFO_INIT */
  size_t bodies;    /**< in the order of the scene */
  size_t vertices;  /**< of the surface, as of the start */
  size_t triangles; /**< likewise */
  int64_t nodes;    /**< of all bodies */
  int64_t elements; /**< of all bodies */
  int bit_exact;    /**< 1: the device passed the start-up probe */
  int reserved;     /**< 0 */
} pliant_info;
#define PLIANT_INFO_INIT \
  { sizeof(pliant_info), 0, 0, 0, 0, 0, 0, 0 }

/** One body: see pliant::BodyInfo. */
typedef struct pliant_body {
  size_t size;           /**< PLIANT_BODY_INIT */
  const char* name;      /**< as in the scene; holds until pliant_world_destroy */
  int64_t nodes;         /**< of its mesh or lattice */
  int64_t elements;      /**< cells or elements of the mesh */
  double mass;           /**< [kg] */
  size_t vertex_first;   /**< of its part of a frame, as of the start */
  size_t vertex_count;   /**< and how many */
  size_t triangle_first; /**< likewise */
  size_t triangle_count; /**< and how many */
} pliant_body;
#define PLIANT_BODY_INIT \
  { sizeof(pliant_body), NULL, 0, 0, 0.0, 0, 0, 0, 0 }

/** What a call of step did: see pliant::StepReport. */
typedef struct pliant_report {
  size_t size;         /**< PLIANT_REPORT_INIT */
  int64_t done;        /**< steps of this call */
  int64_t step;        /**< steps since the start */
  double time;         /**< [s] */
  double dt;           /**< [s], of the step to come */
  int diverged;        /**< 1: the world holds the last good state */
  int at_equilibrium;  /**< 1: nothing is left to do */
  const char* message; /**< of the divergence, "" without one; holds until this thread's next report */
} pliant_report;
#define PLIANT_REPORT_INIT \
  { sizeof(pliant_report), 0, 0, 0.0, 0.0, 0, 0, NULL }

/** The surface at one step: see pliant::Frame. The pointers hold until the next pliant_world_frame (pliant_world_frame_since:
 * of the same consumer) or pliant_world_destroy of the same world. */
typedef struct pliant_frame {
  size_t size;                  /**< PLIANT_FRAME_INIT */
  int64_t step;                 /**< steps since the start */
  double time;                  /**< [s] */
  const float* positions;       /**< [m], shape [vertex_count][4]; the fourth is 0 */
  const float* normals;         /**< unit length, shape [vertex_count][4], or null */
  const float* rest;            /**< positions at rest [m], shape [vertex_count][4] */
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
#define PLIANT_FRAME_INIT \
  { sizeof(pliant_frame), 0, 0.0, NULL, NULL, NULL, 0, NULL, 0, NULL, 0, 0, 0, 0, 0, NULL, NULL }

/** What a cut did: see pliant::CutResult. */
typedef struct pliant_cut {
  size_t size;    /**< PLIANT_CUT_INIT */
  int pending;    /**< 1: done at the start of the next batch of steps, nothing else is known */
  int changed;    /**< 1: elements were divided */
  int64_t edges;  /**< edges between nodes that were cut now */
  double seconds; /**< what it took [s] */
} pliant_cut;
#define PLIANT_CUT_INIT \
  { sizeof(pliant_cut), 0, 0, 0, 0.0 }

/** One quantity of a probe: see pliant::ProbeValue. The pointers hold until the next pliant_world_probes or
 * pliant_world_destroy of the same world. */
typedef struct pliant_probe_value {
  size_t size;           /**< PLIANT_PROBE_VALUE_INIT; the same in all of an array */
  const char* probe;     /**< its name in the scene */
  const char* quantity;  /**< position, displacement, velocity, stress, reaction, force or energy */
  const double* numbers; /**< shape [number_count] */
  size_t number_count;   /**< 3, of a stress 6, of an energy 2 */
} pliant_probe_value;
#define PLIANT_PROBE_VALUE_INIT \
  { sizeof(pliant_probe_value), NULL, NULL, NULL, 0 }

/** A rigid tool: see pliant::ToolForce. The name holds as long as the world. */
typedef struct pliant_tool_force {
  size_t size;        /**< PLIANT_TOOL_FORCE_INIT; the same in all of an array */
  const char* name;   /**< as in the scene */
  double position[3]; /**< of its origin [m] */
  double turn[4];     /**< unit quaternion x, y, z, w */
  double force[3];    /**< on the tool [N] */
  double torque[3];   /**< about its origin [N m] */
  double area;        /**< of the tissue that touches it, at rest [m^2] */
  double penetration; /**< of the deepest point [m] */
  int parked;         /**< 1: it touches nothing */
  int reserved;       /**< 0 */
} pliant_tool_force;
#define PLIANT_TOOL_FORCE_INIT \
  { sizeof(pliant_tool_force), NULL, {0}, {0}, {0}, {0}, 0, 0, 0, 0 }

#ifdef __cplusplus
}
#endif

#endif
