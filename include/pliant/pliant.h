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
#include "pliant/types.h"
#include "pliant/version.h"

#ifdef __cplusplus
extern "C" {
#endif

/** "0.1.0", of the library that runs. */
PLIANT_API const char* pliant_version(void);
/** The last error of this thread; "" if there was none. Holds until this thread's next call. */
PLIANT_API const char* pliant_last_error(void);
/** "ok", "input", ... */
PLIANT_API const char* pliant_status_name(pliant_status status);

/** What `backend` of pliant_options takes on this machine, one per line, into `text`, cut to `size` bytes with the closing 0.
 * `*needed` (may be null) is the size that would hold all. */
PLIANT_API pliant_status pliant_backend_names(char* text, size_t size, size_t* needed);

/** `options` may be null. On failure `out` names no world. */
PLIANT_API pliant_status pliant_world_open(const char* scene_file, const pliant_options* options, pliant_world* out);
/** The text of a scene file; relative paths start from `folder` (null: the working folder). */
PLIANT_API pliant_status pliant_world_parse(const char* scene_text, const char* folder, const pliant_surface* surfaces,
                                            size_t surface_count, const pliant_options* options, pliant_world* out);
PLIANT_API pliant_status pliant_world_destroy(pliant_world world);

PLIANT_API pliant_status pliant_world_info(pliant_world world, pliant_info* out);
/** Name and device of the backend into `text`, cut to `size` bytes with the closing 0. */
PLIANT_API pliant_status pliant_world_backend(pliant_world world, char* text, size_t size);
/** World::remarks of C++, one sentence per line, as pliant_backend_names gives its names. */
PLIANT_API pliant_status pliant_world_remarks(pliant_world world, char* text, size_t size, size_t* needed);
PLIANT_API pliant_status pliant_world_body(pliant_world world, size_t body, pliant_body* out);
PLIANT_API pliant_status pliant_world_body_nodes(pliant_world world, size_t body, int64_t* out);
/** Of the newest state [s]. */
PLIANT_API pliant_status pliant_world_time(pliant_world world, double* out);
/** Steps since the start. */
PLIANT_API pliant_status pliant_world_step_number(pliant_world world, int64_t* out);
/** Of the next step [s]. */
PLIANT_API pliant_status pliant_world_dt(pliant_world world, double* out);
/** 2 / omega_max as of the last estimate [s]; 0: none was made. */
PLIANT_API pliant_status pliant_world_stable_dt(pliant_world world, double* out);

/** A divergence is PLIANT_OK here and told by `diverged`; the next step is PLIANT_DIVERGED. `out` may be null. */
PLIANT_API pliant_status pliant_world_step(pliant_world world, int64_t steps, pliant_report* out);
PLIANT_API pliant_status pliant_world_advance(pliant_world world, double seconds, pliant_report* out);
/** Ask the worker; `*started` is 0, and nothing happens, while it is still busy with the steps before. */
PLIANT_API pliant_status pliant_world_step_async(pliant_world world, int64_t steps, int* started);
/** The same in seconds. What is left below a whole step goes into the next call, as in pliant_world_advance. */
PLIANT_API pliant_status pliant_world_advance_async(pliant_world world, double seconds, int* started);
PLIANT_API pliant_status pliant_world_busy(pliant_world world, int* out);
/** `*fresh` is 1 if pliant_world_frame would give another frame than last time. */
PLIANT_API pliant_status pliant_world_poll(pliant_world world, int* fresh);
PLIANT_API pliant_status pliant_world_wait(pliant_world world, pliant_report* out);

PLIANT_API pliant_status pliant_world_frame(pliant_world world, pliant_frame* out);
/** The same for one of several consumers, who give themselves numbers: the dirty ranges tell what differs from what this
 * consumer got last, and its pointers hold until it calls again. pliant_world_poll and other consumers do not notice. */
PLIANT_API pliant_status pliant_world_frame_since(pliant_world world, uint64_t consumer, pliant_frame* out);
/** This consumer's pointers are used no more; the next frame_since of its number finds everything dirty. */
PLIANT_API pliant_status pliant_world_forget_consumer(pliant_world world, uint64_t consumer);
/** Copies of the newest frame's arrays, three numbers per vertex or triangle; `count` is the length of `out` in numbers and
 * must fit. */
PLIANT_API pliant_status pliant_world_positions(pliant_world world, float* out, size_t count);
PLIANT_API pliant_status pliant_world_normals(pliant_world world, float* out, size_t count);
PLIANT_API pliant_status pliant_world_triangles(pliant_world world, int32_t* out, size_t count);
/** One number per triangle: 1 on a cut, else 0. */
PLIANT_API pliant_status pliant_world_cut_faces(pliant_world world, uint8_t* out, size_t count);
/** Displacements [m] of a body's nodes, three per node. */
PLIANT_API pliant_status pliant_world_displacements(pliant_world world, size_t body, double* out, size_t count);
/** [m/s], likewise. */
PLIANT_API pliant_status pliant_world_velocities(pliant_world world, size_t body, double* out, size_t count);
/** [m], likewise. */
PLIANT_API pliant_status pliant_world_rest_positions(pliant_world world, size_t body, double* out, size_t count);
/** What the scene's probes say of the present state: the first `count` of their quantities. `*needed` (may be null) is how many
 * there are; the same at all times. `out` may be null where `count` is 0. */
PLIANT_API pliant_status pliant_world_probes(pliant_world world, pliant_probe_value* out, size_t count, size_t* needed);
/** Equal for equal bits of the state. */
PLIANT_API pliant_status pliant_world_hash(pliant_world world, uint64_t* out);

/** `radius` [m], `stiffness` [N/m] and `max_force` [N]: 0 for automatic, see pliant::GrabOptions. */
PLIANT_API pliant_status pliant_world_grab(pliant_world world, int32_t vertex, double radius, double stiffness,
                                           double max_force, uint64_t* out);
PLIANT_API pliant_status pliant_world_move_grab(pliant_world world, uint64_t grab, const double target[3]);
PLIANT_API pliant_status pliant_world_release(pliant_world world, uint64_t grab);
/** A force [N] on a vertex until it is set again. */
PLIANT_API pliant_status pliant_world_push(pliant_world world, int32_t vertex, const double force[3]);
/** A force [N] on a node of a body, likewise. The node must belong to a cell of the surface. */
PLIANT_API pliant_status pliant_world_push_node(pliant_world world, size_t body, int64_t node, const double force[3]);
PLIANT_API pliant_status pliant_world_clear_handles(pliant_world world);
/** Put the focus, which operational regions can follow, at a point [m], where it stays. */
PLIANT_API pliant_status pliant_world_move_focus(pliant_world world, const double position[3]);
/** Rigid tools: see pliant::World. An entry of `tools` of a scene file as text becomes a tool; relative files start from
 * `folder` (null: the working folder). Its name into `name` (may be null), cut to `size` bytes with the closing 0. */
PLIANT_API pliant_status pliant_world_parse_tool(pliant_world world, const char* tool_text, const char* folder, char* name,
                                                 size_t size);
PLIANT_API pliant_status pliant_world_remove_tool(pliant_world world, const char* name);
/** It stays known and touches nothing, until it is unparked, placed or driven. */
PLIANT_API pliant_status pliant_world_park_tool(pliant_world world, const char* name);
PLIANT_API pliant_status pliant_world_unpark_tool(pliant_world world, const char* name);
/** A tool is at this place [m] and turn (unit quaternion x, y, z, w) at once, and stays; its path is over. */
PLIANT_API pliant_status pliant_world_place_tool(pliant_world world, const char* name, const double position[3],
                                                 const double turn[4]);
/** A tool goes to this place and turn, gets there after `seconds`, and stays; its path is over. */
PLIANT_API pliant_status pliant_world_drive_tool(pliant_world world, const char* name, const double position[3],
                                                 const double turn[4], double seconds);
/** What the tools feel: the first `count` of them, `*needed` (may be null) is how many there are. Does not wait. */
PLIANT_API pliant_status pliant_world_tool_forces(pliant_world world, pliant_tool_force* out, size_t count, size_t* needed);

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
