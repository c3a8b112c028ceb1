/* Pliant for C and for languages that can call C.
 *
 * Unless stated otherwise, a function returns a status: PLIANT_OK, or an error that pliant_last_error() describes. No
 * exception crosses this interface. A handle names a world and is never reused; a call with the handle of a destroyed
 * world returns PLIANT_STATE and has no effect. Null pointers are PLIANT_USAGE where not allowed explicitly. Threads: as
 * for pliant::World (pliant/world.h), any thread but one at a time per world; worlds may be created and destroyed from any
 * thread. SI units.
 */
#ifndef PLIANT_PLIANT_H
#define PLIANT_PLIANT_H

#include <stddef.h>
#include <stdint.h>

#include "pliant/c/blades.h"
#include "pliant/c/cut.h"
#include "pliant/c/haptics.h"
#include "pliant/c/live.h"
#include "pliant/c/state.h"
#include "pliant/c/types.h"
#include "pliant/export.h"
#include "pliant/version.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Returns the version of the loaded library, for example "0.1.0". */
PLIANT_API const char* pliant_version(void);
/** Returns the last error message of the calling thread, or "". Valid until the thread's next call. */
PLIANT_API const char* pliant_last_error(void);
/** Returns the name of a status: "ok", "input", ... */
PLIANT_API const char* pliant_status_name(pliant_status status);

/** Writes the names of the available backends, one per line, into `text`, truncated to `size` bytes including the closing
 * 0. `*needed` (may be null) receives the size in bytes that holds all of them. */
PLIANT_API pliant_status pliant_backend_names(char* text, size_t size, size_t* needed);

/** Loads a scene file. `options` may be null. On failure `*out` has id 0. */
PLIANT_API pliant_status pliant_world_open(const char* scene_file, const pliant_options* options, pliant_world* out);
/** The same from the text of a scene file; relative paths start from `folder` (null: the working folder). `surfaces` are
 * the surfaces that the scene refers to as "memory:0", "memory:1", ...; they are copied. */
PLIANT_API pliant_status pliant_world_parse(const char* scene_text, const char* folder, const pliant_surface* surfaces,
                                            size_t surface_count, const pliant_options* options, pliant_world* out);
/** Destroys a world and frees its memory. The handle becomes invalid. */
PLIANT_API pliant_status pliant_world_destroy(pliant_world world);

/** Fills `out` with the properties that do not change during the run. */
PLIANT_API pliant_status pliant_world_info(pliant_world world, pliant_info* out);
/** Writes the name and device of the backend, "opencl:0 (device)", into `text`, truncated to `size` bytes including the
 * closing 0. */
PLIANT_API pliant_status pliant_world_backend(pliant_world world, char* text, size_t size);
/** World::remarks of C++, one per line, with `size` and `needed` as in pliant_backend_names(). */
PLIANT_API pliant_status pliant_world_remarks(pliant_world world, char* text, size_t size, size_t* needed);
/** Fills `out` for body 0 .. pliant_info::bodies - 1. An index out of range is PLIANT_USAGE, here and in all calls with
 * `body`. */
PLIANT_API pliant_status pliant_world_body(pliant_world world, size_t body, pliant_body* out);
/** Number of nodes of a body. */
PLIANT_API pliant_status pliant_world_body_nodes(pliant_world world, size_t body, int64_t* out);
/** Time of the newest state [s]. */
PLIANT_API pliant_status pliant_world_time(pliant_world world, double* out);
/** Number of steps since the start. */
PLIANT_API pliant_status pliant_world_step_number(pliant_world world, int64_t* out);
/** Size of the next step [s]. */
PLIANT_API pliant_status pliant_world_dt(pliant_world world, double* out);
/** 2 / omega_max from the last estimate [s]; 0: no estimate was made. */
PLIANT_API pliant_status pliant_world_stable_dt(pliant_world world, double* out);

/** Performs `steps` (>= 0) steps. If the simulation diverges, this call still returns PLIANT_OK and sets `diverged`; the
 * next step call returns PLIANT_DIVERGED. `out` may be null. */
PLIANT_API pliant_status pliant_world_step(pliant_world world, int64_t steps, pliant_report* out);
/** Performs the whole steps that fit into `seconds` [s]; the remainder is added to the next call. `out` may be null. */
PLIANT_API pliant_status pliant_world_advance(pliant_world world, double seconds, pliant_report* out);
/** Starts `steps` steps on the worker thread. `*started` is 0 if the worker is still busy; the call then does nothing. */
PLIANT_API pliant_status pliant_world_step_async(pliant_world world, int64_t steps, int* started);
/** The same for `seconds` [s]. The remainder below a whole step is added to the next call, as in pliant_world_advance. */
PLIANT_API pliant_status pliant_world_advance_async(pliant_world world, double seconds, int* started);
/** `*out` is 1 while the worker runs. */
PLIANT_API pliant_status pliant_world_busy(pliant_world world, int* out);
/** `*fresh` is 1 if pliant_world_frame would return a different frame than the last time. */
PLIANT_API pliant_status pliant_world_poll(pliant_world world, int* fresh);
/** Waits for the worker and reports its last call; returns the error that the worker met, if any. `out` may be null. */
PLIANT_API pliant_status pliant_world_wait(pliant_world world, pliant_report* out);

/** Fills `out` with the newest frame, as World::frame of C++. */
PLIANT_API pliant_status pliant_world_frame(pliant_world world, pliant_frame* out);
/** The same for several consumers: `consumer` is an id of your choice, and the dirty ranges are relative to the last frame
 * that this consumer received. The pointers are valid until this consumer's next call. pliant_world_poll and other
 * consumers are unaffected. */
PLIANT_API pliant_status pliant_world_frame_since(pliant_world world, uint64_t consumer, pliant_frame* out);
/** Releases a consumer's frame and invalidates its pointers. A later frame_since of this id reports everything as dirty. */
PLIANT_API pliant_status pliant_world_forget_consumer(pliant_world world, uint64_t consumer);
/** Where the ray from `origin` [m] first meets the surface of the frame returned last (see pliant::World). `*hit` is 0 if it
 * misses, or before the first frame, and `out` is then as before. `out` may be null. */
PLIANT_API pliant_status pliant_world_pick(pliant_world world, const double origin[3], const double direction[3], int* hit,
                                           pliant_picked_point* out);
/** Copies an array of the newest frame, three numbers per vertex or triangle. `count` is the length of `out` in numbers and
 * must match exactly (PLIANT_USAGE). This one copies positions [m]. */
PLIANT_API pliant_status pliant_world_positions(pliant_world world, float* out, size_t count);
/** Unit normals, likewise; the length is 0 if the world was opened without normals. */
PLIANT_API pliant_status pliant_world_normals(pliant_world world, float* out, size_t count);
/** Vertex indices, likewise. */
PLIANT_API pliant_status pliant_world_triangles(pliant_world world, int32_t* out, size_t count);
/** One number per triangle: 1 on a cut, otherwise 0. */
PLIANT_API pliant_status pliant_world_cut_faces(pliant_world world, uint8_t* out, size_t count);
/** Evaluates the scene's probes at the current state and fills the first `count` of their quantities. `*needed` (may be
 * null) receives the number of quantities, which never changes. `out` may be null if `count` is 0. */
PLIANT_API pliant_status pliant_world_probes(pliant_world world, pliant_probe_value* out, size_t count, size_t* needed);
/** Copies a value per vertex at the current time (see pliant::World): at most `count` values. `*needed` (may be null) receives
 * the number of vertices. */
PLIANT_API pliant_status pliant_world_vertex_values(pliant_world world, const char* field, float* out, size_t count,
                                                    size_t* needed);
/** Measures the overlaps of tools and bodies, and of bodies and bodies, and fills the first `count` of those that overlap.
 * `*needed` (may be null) receives their number. `out` may be null if `count` is 0. */
PLIANT_API pliant_status pliant_world_interpenetrations(pliant_world world, pliant_interpenetration* out, size_t count,
                                                        size_t* needed);
/** XXH3 (64 bits) of displacements and increments; equal hashes mean equal bits. */
PLIANT_API pliant_status pliant_world_hash(pliant_world world, uint64_t* out);

/** Attaches a spring between the surface around `vertex` and a target, initially the vertex's position; `*out` receives its
 * id. `radius` [m], `stiffness` [N/m], `max_force` [N]: 0 for automatic, see pliant::GrabOptions. */
PLIANT_API pliant_status pliant_world_grab(pliant_world world, int32_t vertex, double radius, double stiffness,
                                           double max_force, uint64_t* out);
/** Moves the target of a grab to a point [m]. */
PLIANT_API pliant_status pliant_world_move_grab(pliant_world world, uint64_t grab, const double target[3]);
/** State of a grab, as pliant::GrabState. Pointers that are null receive nothing. */
PLIANT_API pliant_status pliant_world_grab_state(pliant_world world, uint64_t grab, double force[3], double gap[3],
                                                 int* limited);
/** Removes a grab. */
PLIANT_API pliant_status pliant_world_release(pliant_world world, uint64_t grab);
/** Applies a constant force [N] to a vertex until it is set again. */
PLIANT_API pliant_status pliant_world_push(pliant_world world, int32_t vertex, const double force[3]);
/** Applies a force [N] to a node of a body, likewise. The node must belong to a cell that carries the surface. */
PLIANT_API pliant_status pliant_world_push_node(pliant_world world, size_t body, int64_t node, const double force[3]);
/** Removes all grabs and pushes. */
PLIANT_API pliant_status pliant_world_clear_handles(pliant_world world);
/** Moves the focus, which operational regions can follow, to a point [m], where it stays. */
PLIANT_API pliant_status pliant_world_move_focus(pliant_world world, const double position[3]);
/** Adds a rigid tool (see pliant::World) from text, an entry of `tools` of a scene file; relative paths start from `folder`
 * (null: the working folder). Writes its name into `name`, truncated to `size` bytes including the closing 0; may be null
 * if `size` is 0. */
PLIANT_API pliant_status pliant_world_parse_tool(pliant_world world, const char* tool_text, const char* folder, char* name,
                                                 size_t size);
/** Removes a rigid tool. Its name may be reused. */
PLIANT_API pliant_status pliant_world_remove_tool(pliant_world world, const char* name);
/** Disables a tool until it is unparked, placed or driven. */
PLIANT_API pliant_status pliant_world_park_tool(pliant_world world, const char* name);
/** Enables a parked tool again. */
PLIANT_API pliant_status pliant_world_unpark_tool(pliant_world world, const char* name);
/** Lets a tool that has a grip hold the tissue that it touches (`hold` not 0), or let it go. */
PLIANT_API pliant_status pliant_world_grip_tool(pliant_world world, const char* name, int hold);
/** Moves a tool at once to a position [m] and orientation (unit quaternion x, y, z, w), where it stays. Its path ends. */
PLIANT_API pliant_status pliant_world_place_tool(pliant_world world, const char* name, const double position[3],
                                                 const double turn[4]);
/** Moves a tool from its current pose to the given one within `seconds` [s], after which it stays. Its path ends. */
PLIANT_API pliant_status pliant_world_drive_tool(pliant_world world, const char* name, const double position[3],
                                                 const double turn[4], double seconds);
/** Changes the shape of a mesh tool: at `time` [s] of the simulation it has this closed surface, in the tool's frame (see
 * pliant::World). */
PLIANT_API pliant_status pliant_world_set_tool_mesh(pliant_world world, const char* name, const pliant_surface* surface,
                                                    double time);
/** Fills the poses of the first `count` tools and the forces on them; `*needed` (may be null) receives the number of tools.
 * Does not wait. */
PLIANT_API pliant_status pliant_world_tool_forces(pliant_world world, pliant_tool_force* out, size_t count, size_t* needed);
/** Copies the surface of a tool in its own frame (see pliant::World): at most `vertex_count` vertices [m], shape [vertices][3],
 * and `triangle_count` triangles, shape [triangles][3]. `*vertices_needed` and `*triangles_needed` (may be null) receive their
 * numbers. */
PLIANT_API pliant_status pliant_world_tool_surface(pliant_world world, const char* name, double* vertices, size_t vertex_count,
                                                   int32_t* triangles, size_t triangle_count, size_t* vertices_needed,
                                                   size_t* triangles_needed);

/** Changes parameters (see pliant::World) by text, an entry of `changes` of a scene file without its time:
 * {"gravity": [0, 0, 0]}. */
PLIANT_API pliant_status pliant_world_parse_change(pliant_world world, const char* change_text);

/** Cuts all bodies where triangles [m], shape [triangle_count][3][3], intersect them now. `out` may be null. */
PLIANT_API pliant_status pliant_world_cut(pliant_world world, const double* triangles, size_t triangle_count, pliant_cut* out);
/** Moves a named blade to the segment from `a` to `b` [m] and cuts the surface that it sweeps. The first call for a name
 * only places it. `out` may be null. */
PLIANT_API pliant_status pliant_world_move_blade(pliant_world world, const char* blade, const double a[3], const double b[3],
                                                 pliant_cut* out);
/** Lifts a blade out of the tissue: its next move places it without cutting. */
PLIANT_API pliant_status pliant_world_lift_blade(pliant_world world, const char* blade);
/** Number of pieces of a body: sets of elements that share nodes. */
PLIANT_API pliant_status pliant_world_pieces(pliant_world world, size_t body, int64_t* out);

/** Writes a checkpoint. PLIANT_IO if the file cannot be written. */
PLIANT_API pliant_status pliant_world_save(pliant_world world, const char* file);
/** Restores a checkpoint of the same scene. PLIANT_IO, or PLIANT_INPUT for a checkpoint of a different scene. */
PLIANT_API pliant_status pliant_world_load(pliant_world world, const char* file);
/** Returns to the initial state, also after a divergence or a device failure. */
PLIANT_API pliant_status pliant_world_reset(pliant_world world);

#ifdef __cplusplus
}
#endif

#endif
