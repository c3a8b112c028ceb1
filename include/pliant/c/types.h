/* Types of the C API (pliant/c/pliant.h).
 *
 * Structs grow: later versions append members. Each struct begins with its size, set by its PLIANT_..._INIT macro, so that a
 * program and a library of different versions are compatible. The library reads and writes at most `size` bytes. In an output
 * struct, it sets members that it does not know to 0; in an input struct, such members must be 0 (PLIANT_USAGE), and a size
 * below that of the first version or above 4096 is PLIANT_USAGE.
 */
#ifndef PLIANT_TYPES_H
#define PLIANT_TYPES_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Status codes, with the values of pliant::ErrorCode. */
typedef enum pliant_status {
  PLIANT_OK = 0,
  PLIANT_INTERNAL = 1, /**< a bug in Pliant, or out of memory */
  PLIANT_INPUT = 2,    /**< invalid scene, mesh or option */
  PLIANT_DIVERGED = 4, /**< the world had diverged before; its last good state can still be read */
  PLIANT_USAGE = 5,    /**< a null pointer, an index out of range, a buffer of the wrong size */
  PLIANT_IO = 6,       /**< a file is missing, cannot be read or cannot be written */
  PLIANT_DEVICE = 7,   /**< the backend cannot be opened or failed; the last state read is still available */
  PLIANT_STATE = 8     /**< destroyed world, two threads at once, tools without `interactive` */
} pliant_status;

/** Handle of a world. */
typedef struct pliant_world {
  uint64_t id; /**< 0: no world */
} pliant_world;

/** Options for running a scene. */
typedef struct pliant_options {
  size_t size;         /**< PLIANT_OPTIONS_INIT */
  const char* backend; /**< auto, cpu, cpu:double, cpu:check, opencl or opencl:N; null: auto */
  double dt;           /**< time step [s]; 0: as in the scene */
  int normals;         /**< 1: compute normals for frames */
  int interactive;     /**< 1: allow grabs and pushes */
  int cutting;         /**< 1: prepare for cuts at the start */
  int reserved;        /**< must be 0 */
} pliant_options;
#define PLIANT_OPTIONS_INIT \
  { sizeof(pliant_options), NULL, 0.0, 1, 0, 0, 0 }

/** A triangle surface in memory, which a scene refers to as "memory:0", "memory:1", ... The library copies it. */
typedef struct pliant_surface {
  size_t size;              /**< PLIANT_SURFACE_INIT; the same in all elements of an array */
  const double* vertices;   /**< [m], shape [vertex_count][3] */
  size_t vertex_count;      /**< number of vertices */
  const int32_t* triangles; /**< shape [triangle_count][3], counter-clockwise from outside */
  size_t triangle_count;    /**< number of triangles */
} pliant_surface;
#define PLIANT_SURFACE_INIT \
  { sizeof(pliant_surface), NULL, 0, NULL, 0 }
/** Properties of a world that do not change while it runs. */
typedef struct pliant_info {
  size_t size;      /**< PLIANT_INFO_INIT */
  size_t bodies;    /**< number of bodies */
  size_t vertices;  /**< number of surface vertices, before any cut */
  size_t triangles; /**< number of surface triangles, before any cut */
  int64_t nodes;    /**< number of nodes of all bodies */
  int64_t elements; /**< number of elements of all bodies */
  int bit_exact;    /**< 1: the device passed the start-up probe */
  int reserved;     /**< 0 */
} pliant_info;
#define PLIANT_INFO_INIT \
  { sizeof(pliant_info), 0, 0, 0, 0, 0, 0, 0 }

/** One body, as pliant::BodyInfo. */
typedef struct pliant_body {
  size_t size;           /**< PLIANT_BODY_INIT */
  const char* name;      /**< name in the scene; valid until pliant_world_destroy */
  int64_t nodes;         /**< number of nodes of its mesh or lattice */
  int64_t elements;      /**< number of cells or mesh elements */
  double mass;           /**< [kg] */
  size_t vertex_first;   /**< its vertices in a frame, before any cut: the first */
  size_t vertex_count;   /**< and their number */
  size_t triangle_first; /**< its triangles in a frame, before any cut: the first */
  size_t triangle_count; /**< and their number */
} pliant_body;
#define PLIANT_BODY_INIT \
  { sizeof(pliant_body), NULL, 0, 0, 0.0, 0, 0, 0, 0 }

/** Result of a stepping call, as pliant::StepReport. */
typedef struct pliant_report {
  size_t size;         /**< PLIANT_REPORT_INIT */
  int64_t done;        /**< number of steps performed by this call */
  int64_t step;        /**< number of steps since the start */
  double time;         /**< simulated time [s] */
  double dt;           /**< size of the next step [s] */
  int diverged;        /**< 1: diverged; the world holds the last good state */
  int at_equilibrium;  /**< 1: dynamic relaxation has converged; further steps do nothing */
  const char* message; /**< describes the divergence, "" without one; valid until this thread's next report */
} pliant_report;
#define PLIANT_REPORT_INIT \
  { sizeof(pliant_report), 0, 0, 0.0, 0.0, 0, 0, NULL }

/** The surface at one step, as pliant::Frame. The pointers are valid until the next pliant_world_frame (for
 * pliant_world_frame_since: until the same consumer's next call) or pliant_world_destroy of the same world. */
typedef struct pliant_frame {
  size_t size;                  /**< PLIANT_FRAME_INIT */
  int64_t step;                 /**< number of steps since the start */
  double time;                  /**< simulated time [s] */
  const float* positions;       /**< [m], shape [vertex_count][4]; the fourth number is 0 */
  const float* normals;         /**< unit length, shape [vertex_count][4]; null without normals */
  const float* rest;            /**< undeformed positions [m], shape [vertex_count][4] */
  size_t vertex_count;          /**< number of vertices */
  const int32_t* triangles;     /**< vertex indices, shape [triangle_count][3] */
  size_t triangle_count;        /**< number of triangles */
  const uint8_t* cut_faces;     /**< 1 on a cut, shape [triangle_count]; null if there are none */
  uint64_t topology_version;    /**< incremented whenever the vertex or triangle list changes */
  size_t dirty_vertex_first;    /**< first vertex that may differ from the previous frame */
  size_t dirty_vertex_count;    /**< and the number of such vertices */
  size_t dirty_triangle_first;  /**< first triangle that may differ from the previous frame */
  size_t dirty_triangle_count;  /**< and their number; 0 unless the topology changed */
  const size_t* body_vertices;  /**< first vertex and count, shape [bodies][2]; cuts do not renumber a body's vertices */
  const size_t* body_triangles; /**< first triangle and count, shape [bodies][2] */
} pliant_frame;
#define PLIANT_FRAME_INIT \
  { sizeof(pliant_frame), 0, 0.0, NULL, NULL, NULL, 0, NULL, 0, NULL, 0, 0, 0, 0, 0, NULL, NULL }

/** One quantity of a probe, as pliant::ProbeValue. Pointers are valid until the world's next pliant_world_probes or its end. */
typedef struct pliant_probe_value {
  size_t size;           /**< PLIANT_PROBE_VALUE_INIT; the same in all elements of an array */
  const char* probe;     /**< name of the probe in the scene */
  const char* quantity;  /**< position, displacement, velocity, stress, green_strain, almansi_strain, reaction, force, energy
                            or interpenetration */
  const double* numbers; /**< shape [number_count], as ProbeValue::numbers */
  size_t number_count;   /**< 3; for a stress or strain 6, for an energy 2, for an interpenetration 10 */
} pliant_probe_value;
#define PLIANT_PROBE_VALUE_INIT \
  { sizeof(pliant_probe_value), NULL, NULL, NULL, 0 }

/** Pose of a rigid tool and the load on it, as pliant::ToolForce. The name is valid as long as the world. */
typedef struct pliant_tool_force {
  size_t size;        /**< PLIANT_TOOL_FORCE_INIT; the same in all elements of an array */
  const char* name;   /**< name in the scene, or as added */
  double position[3]; /**< position of its origin [m] */
  double turn[4];     /**< orientation, unit quaternion x, y, z, w */
  double force[3];    /**< contact force on the tool [N] */
  double torque[3];   /**< contact torque about its origin [N m] */
  double area;        /**< undeformed area of the tissue in contact [m^2] */
  double penetration; /**< greatest depth of a point inside the tool [m] */
  int parked;         /**< 1: parked, without contact */
  int reserved;       /**< 0 */
} pliant_tool_force;
#define PLIANT_TOOL_FORCE_INIT \
  { sizeof(pliant_tool_force), NULL, {0}, {0}, {0}, {0}, 0, 0, 0, 0 }

/** The overlap of a tool and a body, or of two bodies, as pliant::Interpenetration. Names are valid as long as the world. */
typedef struct pliant_interpenetration {
  size_t size;        /**< PLIANT_INTERPENETRATION_INIT; the same in all elements of an array */
  const char* first;  /**< name of a tool or a body */
  const char* second; /**< name of a body */
  double volume;      /**< [m^3] */
  double centroid[3]; /**< of this volume [m] */
  double area[2];     /**< of the first one's surface inside the second, and of the second one's inside the first [m^2] */
  double depth;       /**< greatest distance of a vertex inside the other from the other's surface [m] */
  double deepest[3];  /**< this vertex [m]; meaningless if the depth is 0 */
  int tool;           /**< 1: the first is a tool */
  int reserved;       /**< 0 */
} pliant_interpenetration;
#define PLIANT_INTERPENETRATION_INIT \
  { sizeof(pliant_interpenetration), NULL, NULL, 0.0, {0}, {0}, 0.0, {0}, 0, 0 }

/** Where a ray meets the surface of the frame returned last, as pliant::PickedPoint. */
typedef struct pliant_picked_point {
  size_t size;       /**< PLIANT_PICKED_POINT_INIT */
  size_t body;       /**< index of the body */
  size_t triangle;   /**< number of the triangle */
  double weights[3]; /**< of the triangle's vertices; the point is their weighted mean */
  double point[3];   /**< [m] */
  double normal[3];  /**< outward normal of the triangle, unit length */
  double distance;   /**< from the origin of the ray to the point [m], whatever the length of its direction */
  int32_t vertex;    /**< the vertex of the triangle nearest to the point, for pliant_world_grab and pliant_world_push */
  int reserved;      /**< 0 */
} pliant_picked_point;
#define PLIANT_PICKED_POINT_INIT \
  { sizeof(pliant_picked_point), 0, 0, {0}, {0}, {0}, 0.0, 0, 0 }

#ifdef __cplusplus
}
#endif

#endif
