// The C API over pliant::World: null pointers and sizes are checked here, everything else by World.
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "api/c_call.h"

namespace {

using namespace pliant::api;
using pliant::Error;
using pliant::ErrorCode;

pliant::WorldOptions options_of(const pliant_options* pointer) {
  const pliant_options given =
      pointer == nullptr ? pliant_options PLIANT_OPTIONS_INIT : take_struct<pliant_options>(*pointer, PLIANT_OPTIONS_INIT);
  if (given.reserved != 0)
    throw Error(ErrorCode::usage, fmt::format("pliant_options::reserved is {}; 0 is allowed", given.reserved));
  pliant::WorldOptions options;
  if (given.backend != nullptr) options.backend = given.backend;
  options.dt = given.dt;
  options.normals = given.normals != 0;
  options.interactive = given.interactive != 0;
  options.cutting = given.cutting != 0;
  return options;
}

/// Copies `text` into a buffer of `size` bytes, truncated to fit including the closing 0.
void give_text(const std::string& text, char* out, std::size_t size) {
  need(out, "text");
  if (size == 0) throw Error(ErrorCode::usage, "the buffer for the text has no room for its closing 0");
  const std::size_t length = std::min(text.size(), size - 1);
  std::memcpy(out, text.data(), length);
  out[length] = 0;
}

/// Writes one line per entry; `needed` receives the number of bytes for all of them.
void give_lines(const std::vector<std::string>& lines, char* out, std::size_t size, std::size_t* needed) {
  const std::string text = fmt::format("{}", fmt::join(lines, "\n"));
  give_text(text, out, size);
  if (needed != nullptr) *needed = text.size() + 1;
}

template <class T>
void give(const T& value, T* out) {
  need(out, "out");
  *out = value;
}

pliant_world made(pliant::World world) { return {Handles::all().add(std::make_shared<CWorld>(std::move(world)))}; }

const pliant::BodyInfo& body_of(CWorld& w, std::size_t body) {
  const auto& bodies = w.world.info().bodies;
  if (body < bodies.size()) return bodies[body];
  throw Error(ErrorCode::usage, fmt::format("there is no body {}; the scene has {}", body, bodies.size()));
}

/// Converts an array of the caller's structs, which may be larger than this library's.
std::vector<pliant::SurfaceSpec> surfaces_of(const pliant_surface* first, std::size_t count) {
  std::vector<pliant::SurfaceSpec> surfaces;
  if (count > 0) need(first, "surfaces");
  for (std::size_t s = 0; s < count; ++s) {
    const auto* const at = reinterpret_cast<const pliant_surface*>(reinterpret_cast<const char*>(first) + s * first->size);
    if (at->size != first->size) {
      throw Error(ErrorCode::usage,
                  fmt::format("pliant_surface::size is {} in surfaces[{}] and {} in the first", at->size, s, first->size));
    }
    surfaces.push_back(surface_of(*at));
  }
  return surfaces;
}

/// Copies x, y, z of each texel.
void copy_texels(pliant::View<pliant::Vec4f> texels, float* out, std::size_t count, const char* what) {
  need(out, "out");
  check_count(count, 3 * texels.size(), what);
  for (const pliant::Vec4f& t : texels) out = std::copy_n(t.data(), 3, out);
}

/// Copies x, y, z of each node.
void copy_vectors(const std::vector<pliant::Vec3d>& vectors, double* out, std::size_t count, const char* what) {
  need(out, "out");
  check_count(count, 3 * vectors.size(), what);
  for (const pliant::Vec3d& v : vectors) out = std::copy(v.begin(), v.end(), out);
}

/// Three numbers for each node; null: none.
std::vector<pliant::Vec3d> vectors_of(const double* numbers, std::size_t count) {
  std::vector<pliant::Vec3d> vectors(numbers == nullptr ? 0 : count / 3);
  if (!vectors.empty()) std::copy_n(numbers, 3 * vectors.size(), vectors.front().data());
  return vectors;
}

void give_frame(const pliant::Frame& f, const pliant::IndexRange& vertices, const pliant::IndexRange& triangles,
                pliant_frame* out) {
  const auto floats = [](pliant::View<pliant::Vec4f> v) { return v.empty() ? nullptr : v.data()->data(); };
  pliant_frame frame = PLIANT_FRAME_INIT;
  frame.step = f.step;
  frame.time = f.time;
  frame.positions = floats(f.positions);
  frame.normals = floats(f.normals);
  frame.rest = floats(f.rest);
  frame.vertex_count = f.positions.size();
  frame.triangles = f.triangles.empty() ? nullptr : f.triangles.data()->data();
  frame.triangle_count = f.triangles.size();
  frame.cut_faces = f.cut_faces.data();
  frame.topology_version = f.topology_version;
  frame.dirty_vertex_first = vertices.first;
  frame.dirty_vertex_count = vertices.count;
  frame.dirty_triangle_first = triangles.first;
  frame.dirty_triangle_count = triangles.count;
  frame.body_vertices = &f.body_vertices.data()->first;
  frame.body_triangles = &f.body_triangles.data()->first;
  give_struct(frame, out);
}

/// Returns the newest frame without affecting poll().
pliant::FramePtr newest(CWorld& w) { return w.world.frame_since(nullptr).frame; }

}  // namespace

static_assert(sizeof(pliant::IndexRange) == 2 * sizeof(size_t));  // pliant_frame::body_vertices

const char* pliant_version(void) { return pliant::version(); }
const char* pliant_last_error(void) { return last_error.c_str(); }

const char* pliant_status_name(pliant_status status) {
  switch (status) {
    case PLIANT_OK:
      return "ok";
    case PLIANT_INTERNAL:
      return "internal";
    case PLIANT_INPUT:
      return "input";
    case PLIANT_DIVERGED:
      return "diverged";
    case PLIANT_USAGE:
      return "usage";
    case PLIANT_IO:
      return "io";
    case PLIANT_DEVICE:
      return "device";
    case PLIANT_STATE:
      return "state";
  }
  return "unknown";
}

pliant_status pliant_backend_names(char* text, size_t size, size_t* needed) {
  return guarded([&] { give_lines(pliant::backend_names(), text, size, needed); });
}

pliant_status pliant_world_open(const char* scene_file, const pliant_options* options, pliant_world* out) {
  return guarded([&] {
    need(out, "out");
    *out = {0};
    need(scene_file, "scene_file");
    *out = made(pliant::World::open(scene_file, options_of(options)));
  });
}

pliant_status pliant_world_parse(const char* scene_text, const char* folder, const pliant_surface* surfaces,
                                 size_t surface_count, const pliant_options* options, pliant_world* out) {
  return guarded([&] {
    need(out, "out");
    *out = {0};
    need(scene_text, "scene_text");
    *out = made(pliant::World::parse(scene_text, folder == nullptr ? "" : folder, options_of(options),
                                     surfaces_of(surfaces, surface_count)));
  });
}

pliant_status pliant_world_destroy(pliant_world world) {
  return guarded([&] { Handles::all().remove(world.id); });
}

pliant_status pliant_world_info(pliant_world world, pliant_info* out) {
  return on(world, [&](CWorld& w) {
    need(out, "out");
    check_struct(out);
    const pliant::WorldInfo& i = w.world.info();
    give_struct({0, i.bodies.size(), i.vertices, i.triangles, i.nodes, i.elements, i.bit_exact ? 1 : 0, 0}, out);
  });
}

pliant_status pliant_world_remarks(pliant_world world, char* text, size_t size, size_t* needed) {
  return on(world, [&](CWorld& w) { give_lines(w.world.remarks(), text, size, needed); });
}

pliant_status pliant_world_backend(pliant_world world, char* text, size_t size) {
  return on(world, [&](CWorld& w) { give_text(w.world.info().backend + " (" + w.world.info().device + ")", text, size); });
}

pliant_status pliant_world_body(pliant_world world, size_t body, pliant_body* out) {
  return on(world, [&](CWorld& w) {
    need(out, "out");
    check_struct(out);
    const pliant::BodyInfo& b = body_of(w, body);
    give_struct({0, b.name.c_str(), b.nodes, b.elements, b.mass, b.vertices.first, b.vertices.count, b.triangles.first,
                 b.triangles.count},
                out);
  });
}
pliant_status pliant_world_body_nodes(pliant_world world, size_t body, int64_t* out) {
  return on(world, [&](CWorld& w) { give(body_of(w, body).nodes, out); });
}

pliant_status pliant_world_time(pliant_world world, double* out) {
  return on(world, [&](CWorld& w) { give(w.world.time(), out); });
}
pliant_status pliant_world_step_number(pliant_world world, int64_t* out) {
  return on(world, [&](CWorld& w) { give(w.world.step_number(), out); });
}
pliant_status pliant_world_dt(pliant_world world, double* out) {
  return on(world, [&](CWorld& w) { give(w.world.dt(), out); });
}
pliant_status pliant_world_stable_dt(pliant_world world, double* out) {
  return on(world, [&](CWorld& w) { give(w.world.stable_dt(), out); });
}

pliant_status pliant_world_step(pliant_world world, int64_t steps, pliant_report* out) {
  return on(world, [&](CWorld& w) {
    check_struct(out);
    give_report(w.world.step(steps), out);
  });
}
pliant_status pliant_world_advance(pliant_world world, double seconds, pliant_report* out) {
  return on(world, [&](CWorld& w) {
    check_struct(out);
    give_report(w.world.advance(seconds), out);
  });
}
pliant_status pliant_world_step_async(pliant_world world, int64_t steps, int* started) {
  return on(world, [&](CWorld& w) {
    need(started, "started");
    *started = 0;
    *started = w.world.step_async(steps) ? 1 : 0;
  });
}
pliant_status pliant_world_advance_async(pliant_world world, double seconds, int* started) {
  return on(world, [&](CWorld& w) {
    need(started, "started");
    *started = 0;
    *started = w.world.advance_async(seconds) ? 1 : 0;
  });
}
pliant_status pliant_world_busy(pliant_world world, int* out) {
  return on(world, [&](CWorld& w) { give(w.world.busy() ? 1 : 0, out); });
}
pliant_status pliant_world_poll(pliant_world world, int* fresh) {
  return on(world, [&](CWorld& w) {
    need(fresh, "fresh");
    *fresh = w.world.poll() ? 1 : 0;
  });
}
pliant_status pliant_world_wait(pliant_world world, pliant_report* out) {
  return on(world, [&](CWorld& w) {
    check_struct(out);
    give_report(w.world.wait(), out);
  });
}

pliant_status pliant_world_frame(pliant_world world, pliant_frame* out) {
  return on(world, [&](CWorld& w) {
    need(out, "out");
    check_struct(out);
    const pliant::FramePtr frame =
        w.world.frame();  // the World holds it until the next call of frame(), which only this function makes
    give_frame(*frame, frame->dirty_vertices, frame->dirty_triangles, out);
  });
}
pliant_status pliant_world_frame_since(pliant_world world, uint64_t consumer, pliant_frame* out) {
  return on(world, [&](CWorld& w) {
    need(out, "out");
    check_struct(out);
    pliant::FramePtr seen;
    {
      const std::lock_guard lock(w.mutex);
      const auto found = w.seen.find(consumer);
      if (found != w.seen.end()) seen = found->second;
    }
    const pliant::FrameChange change = w.world.frame_since(seen);
    give_frame(*change.frame, change.dirty_vertices, change.dirty_triangles, out);
    const std::lock_guard lock(w.mutex);
    w.seen[consumer] = change.frame;
  });
}
pliant_status pliant_world_forget_consumer(pliant_world world, uint64_t consumer) {
  return on(world, [&](CWorld& w) {
    const std::lock_guard lock(w.mutex);
    if (w.seen.erase(consumer) == 0) throw Error(ErrorCode::usage, fmt::format("no consumer {} has got a frame", consumer));
  });
}

pliant_status pliant_world_positions(pliant_world world, float* out, size_t count) {
  return on(world, [&](CWorld& w) { copy_texels(newest(w)->positions, out, count, "positions"); });
}
pliant_status pliant_world_normals(pliant_world world, float* out, size_t count) {
  return on(world, [&](CWorld& w) { copy_texels(newest(w)->normals, out, count, "normals"); });
}
pliant_status pliant_world_triangles(pliant_world world, int32_t* out, size_t count) {
  return on(world, [&](CWorld& w) {
    need(out, "out");
    const pliant::FramePtr frame = newest(w);
    check_count(count, 3 * frame->triangles.size(), "triangles");
    for (const pliant::Triangle& t : frame->triangles) out = std::copy(t.begin(), t.end(), out);
  });
}
pliant_status pliant_world_cut_faces(pliant_world world, uint8_t* out, size_t count) {
  return on(world, [&](CWorld& w) {
    need(out, "out");
    const pliant::FramePtr frame = newest(w);
    check_count(count, frame->triangles.size(), "cut_faces");
    std::fill_n(out, count, std::uint8_t{0});
    std::copy(frame->cut_faces.begin(), frame->cut_faces.end(), out);
  });
}
pliant_status pliant_world_displacements(pliant_world world, size_t body, double* out, size_t count) {
  return on(world, [&](CWorld& w) { copy_vectors(w.world.displacements(body), out, count, "displacements"); });
}
pliant_status pliant_world_velocities(pliant_world world, size_t body, double* out, size_t count) {
  return on(world, [&](CWorld& w) { copy_vectors(w.world.velocities(body), out, count, "velocities"); });
}
pliant_status pliant_world_rest_positions(pliant_world world, size_t body, double* out, size_t count) {
  return on(world, [&](CWorld& w) { copy_vectors(w.world.rest_positions(body), out, count, "rest_positions"); });
}
pliant_status pliant_world_set_state(pliant_world world, size_t body, const double* displacements, const double* velocities,
                                     size_t count) {
  return on(world, [&](CWorld& w) {
    check_count(count, 3 * w.world.rest_positions(body).size(), "the state");
    w.world.set_state(body, vectors_of(displacements, count), vectors_of(velocities, count));
  });
}
pliant_status pliant_world_hash(pliant_world world, uint64_t* out) {
  return on(world, [&](CWorld& w) { give(w.world.hash(), out); });
}
