// The C API over pliant::World: null pointers and sizes are checked here, everything else there.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <mutex>
#include <new>
#include <string>

#include "api/c_handles.h"
#include "pliant/pliant.h"

namespace {

using pliant::Error;
using pliant::ErrorCode;

thread_local std::string last_error;

/// Runs `call` and turns what it throws into a status.
template <class Call>
pliant_status guarded(Call&& call) noexcept {
  try {
    last_error.clear();
    call();
    return PLIANT_OK;
  } catch (const Error& error) {
    try {
      last_error = error.what();
    } catch (...) {
    }
    return static_cast<pliant_status>(error.code());
  } catch (const std::bad_alloc&) {
    try {
      last_error = "out of memory";
    } catch (...) {
    }
  } catch (const std::exception& error) {
    try {
      last_error = error.what();
    } catch (...) {
    }
  } catch (...) {
    last_error.clear();
  }
  return PLIANT_INTERNAL;
}

void need(const void* pointer, const char* name) {
  if (pointer == nullptr) throw Error(ErrorCode::usage, fmt::format("\"{}\" is a null pointer", name));
}

template <class Call>
pliant_status on(pliant_world world, Call&& call) noexcept {
  return guarded([&] {
    const auto held = pliant::api::Handles::all().find(world.id);
    call(*held);
  });
}

pliant::WorldOptions options_of(const pliant_options* given) {
  pliant::WorldOptions options;
  if (given == nullptr) return options;
  if (given->size != sizeof(pliant_options)) {
    throw Error(ErrorCode::usage, fmt::format("pliant_options::size is {}, expected {}: begin with PLIANT_OPTIONS_INIT",
                                              given->size, sizeof(pliant_options)));
  }
  if (given->backend != nullptr) options.backend = given->backend;
  options.dt = given->dt;
  options.normals = given->normals != 0;
  options.interactive = given->interactive != 0;
  options.cutting = given->cutting != 0;
  return options;
}

void report(const pliant::StepReport& r, pliant_report* out) {
  if (out == nullptr) return;
  *out = {r.done, r.step, r.time, r.dt, r.diverged ? 1 : 0, r.at_equilibrium ? 1 : 0};
}

void result(const pliant::CutResult& r, pliant_cut* out) {
  if (out != nullptr) *out = {r.pending ? 1 : 0, r.changed ? 1 : 0, r.edges, r.seconds};
}

pliant_world made(pliant::World world) {
  return {pliant::api::Handles::all().add(std::make_shared<pliant::api::CWorld>(std::move(world)))};
}

void check_count(std::size_t given, std::size_t needed, const char* what) {
  if (given == needed) return;
  throw Error(ErrorCode::usage, fmt::format("the buffer for {} holds {} numbers, expected {}", what, given, needed));
}

/// x, y, z of each texel.
void copy_texels(pliant::View<pliant::Vec4f> texels, float* out, std::size_t count, const char* what) {
  need(out, "out");
  check_count(count, 3 * texels.size(), what);
  for (const pliant::Vec4f& t : texels) out = std::copy_n(t.data(), 3, out);
}

pliant::Vec3d vector_of(const double* v, const char* name) {
  need(v, name);
  return {v[0], v[1], v[2]};
}

pliant::SurfaceSpec surface_of(const pliant_surface& s) {
  if (s.vertex_count > 0) need(s.vertices, "vertices");
  if (s.triangle_count > 0) need(s.triangles, "triangles");
  pliant::SurfaceSpec spec;
  for (std::size_t v = 0; v < s.vertex_count; ++v) {
    spec.vertices.push_back({s.vertices[3 * v], s.vertices[3 * v + 1], s.vertices[3 * v + 2]});
  }
  for (std::size_t t = 0; t < s.triangle_count; ++t) {
    spec.triangles.push_back({s.triangles[3 * t], s.triangles[3 * t + 1], s.triangles[3 * t + 2]});
  }
  return spec;
}

}  // namespace

using pliant::api::CWorld;

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
    if (surface_count > 0) need(surfaces, "surfaces");
    std::vector<pliant::SurfaceSpec> copies;
    for (std::size_t s = 0; s < surface_count; ++s) copies.push_back(surface_of(surfaces[s]));
    *out = made(pliant::World::parse(scene_text, folder == nullptr ? "" : folder, options_of(options), copies));
  });
}

pliant_status pliant_world_destroy(pliant_world world) {
  return guarded([&] { pliant::api::Handles::all().remove(world.id); });
}

pliant_status pliant_world_info(pliant_world world, pliant_info* out) {
  return on(world, [&](CWorld& w) {
    need(out, "out");
    const pliant::WorldInfo& i = w.world.info();
    *out = {i.bodies.size(), i.vertices, i.triangles, i.nodes, i.elements, i.bit_exact ? 1 : 0};
  });
}

pliant_status pliant_world_backend(pliant_world world, char* text, size_t size) {
  return on(world, [&](CWorld& w) {
    need(text, "text");
    if (size == 0) throw Error(ErrorCode::usage, "the buffer for the backend's name has no room for its closing 0");
    const std::string name = w.world.info().backend + " (" + w.world.info().device + ")";
    const std::size_t length = std::min(name.size(), size - 1);
    std::memcpy(text, name.data(), length);
    text[length] = 0;
  });
}

pliant_status pliant_world_body_nodes(pliant_world world, size_t body, int64_t* out) {
  return on(world, [&](CWorld& w) {
    need(out, "out");
    const auto& bodies = w.world.info().bodies;
    if (body >= bodies.size()) {
      throw Error(ErrorCode::usage, fmt::format("there is no body {}; the scene has {}", body, bodies.size()));
    }
    *out = bodies[body].nodes;
  });
}

pliant_status pliant_world_step(pliant_world world, int64_t steps, pliant_report* out) {
  return on(world, [&](CWorld& w) { report(w.world.step(steps), out); });
}
pliant_status pliant_world_advance(pliant_world world, double seconds, pliant_report* out) {
  return on(world, [&](CWorld& w) { report(w.world.advance(seconds), out); });
}
pliant_status pliant_world_advance_async(pliant_world world, int64_t steps, int* started) {
  return on(world, [&](CWorld& w) {
    need(started, "started");
    *started = 0;
    *started = w.world.advance_async(steps) ? 1 : 0;
  });
}
pliant_status pliant_world_busy(pliant_world world, int* out) {
  return on(world, [&](CWorld& w) {
    need(out, "out");
    *out = w.world.busy() ? 1 : 0;
  });
}
pliant_status pliant_world_poll(pliant_world world, int* fresh) {
  return on(world, [&](CWorld& w) {
    need(fresh, "fresh");
    *fresh = w.world.poll() ? 1 : 0;
  });
}
pliant_status pliant_world_wait(pliant_world world, pliant_report* out) {
  return on(world, [&](CWorld& w) { report(w.world.wait(), out); });
}

pliant_status pliant_world_frame(pliant_world world, pliant_frame* out) {
  return on(world, [&](CWorld& w) {
    need(out, "out");
    const pliant::FramePtr frame = w.world.frame();
    const pliant::Frame& f = *frame;
    *out = {f.step,
            f.time,
            f.positions.empty() ? nullptr : f.positions.data()->data(),
            f.normals.empty() ? nullptr : f.normals.data()->data(),
            f.positions.size(),
            f.triangles.empty() ? nullptr : f.triangles.data()->data(),
            f.triangles.size(),
            f.cut_faces.empty() ? nullptr : f.cut_faces.data(),
            f.topology_version,
            f.dirty_vertices.first,
            f.dirty_vertices.count,
            f.dirty_triangles.first,
            f.dirty_triangles.count,
            &f.body_vertices.data()->first,
            &f.body_triangles.data()->first};
  });
}

pliant_status pliant_world_positions(pliant_world world, float* out, size_t count) {
  return on(world, [&](CWorld& w) { copy_texels(w.world.frame()->positions, out, count, "positions"); });
}
pliant_status pliant_world_normals(pliant_world world, float* out, size_t count) {
  return on(world, [&](CWorld& w) { copy_texels(w.world.frame()->normals, out, count, "normals"); });
}
pliant_status pliant_world_triangles(pliant_world world, int32_t* out, size_t count) {
  return on(world, [&](CWorld& w) {
    need(out, "out");
    const pliant::FramePtr frame = w.world.frame();
    check_count(count, 3 * frame->triangles.size(), "triangles");
    for (const pliant::Triangle& t : frame->triangles) out = std::copy(t.begin(), t.end(), out);
  });
}
pliant_status pliant_world_cut_faces(pliant_world world, uint8_t* out, size_t count) {
  return on(world, [&](CWorld& w) {
    need(out, "out");
    const pliant::FramePtr frame = w.world.frame();
    check_count(count, frame->triangles.size(), "cut_faces");
    std::fill_n(out, count, std::uint8_t{0});
    std::copy(frame->cut_faces.begin(), frame->cut_faces.end(), out);
  });
}
pliant_status pliant_world_displacements(pliant_world world, size_t body, double* out, size_t count) {
  return on(world, [&](CWorld& w) {
    need(out, "out");
    const std::vector<pliant::Vec3d> u = w.world.displacements(body);
    check_count(count, 3 * u.size(), "displacements");
    for (const pliant::Vec3d& v : u) out = std::copy(v.begin(), v.end(), out);
  });
}
pliant_status pliant_world_hash(pliant_world world, uint64_t* out) {
  return on(world, [&](CWorld& w) {
    need(out, "out");
    *out = w.world.hash();
  });
}

pliant_status pliant_world_grab(pliant_world world, int32_t vertex, double radius, double stiffness, double max_force,
                                uint64_t* out) {
  return on(world, [&](CWorld& w) {
    need(out, "out");
    *out = w.world.grab(vertex, {radius, stiffness, max_force});
  });
}
pliant_status pliant_world_move_grab(pliant_world world, uint64_t grab, const double target[3]) {
  return on(world, [&](CWorld& w) { w.world.move_grab(grab, vector_of(target, "target")); });
}
pliant_status pliant_world_release(pliant_world world, uint64_t grab) {
  return on(world, [&](CWorld& w) { w.world.release(grab); });
}
pliant_status pliant_world_push(pliant_world world, int32_t vertex, const double force[3]) {
  return on(world, [&](CWorld& w) { w.world.push(vertex, vector_of(force, "force")); });
}
pliant_status pliant_world_clear_tools(pliant_world world) {
  return on(world, [&](CWorld& w) { w.world.clear_tools(); });
}

pliant_status pliant_world_cut(pliant_world world, const double* triangles, size_t triangle_count, pliant_cut* out) {
  return on(world, [&](CWorld& w) {
    if (triangle_count > 0) need(triangles, "triangles");
    std::vector<std::array<pliant::Vec3d, 3>> copies(triangle_count);
    for (auto& t : copies) {
      for (pliant::Vec3d& corner : t) corner = {*triangles++, *triangles++, *triangles++};
    }
    result(w.world.cut(copies), out);
  });
}
pliant_status pliant_world_move_blade(pliant_world world, const char* blade, const double a[3], const double b[3],
                                      pliant_cut* out) {
  return on(world, [&](CWorld& w) {
    need(blade, "blade");
    result(w.world.move_blade(blade, vector_of(a, "a"), vector_of(b, "b")), out);
  });
}
pliant_status pliant_world_lift_blade(pliant_world world, const char* blade) {
  return on(world, [&](CWorld& w) {
    need(blade, "blade");
    w.world.lift_blade(blade);
  });
}
pliant_status pliant_world_pieces(pliant_world world, size_t body, int64_t* out) {
  return on(world, [&](CWorld& w) {
    need(out, "out");
    *out = w.world.pieces(body);
  });
}

pliant_status pliant_world_save(pliant_world world, const char* file) {
  return on(world, [&](CWorld& w) {
    need(file, "file");
    w.world.save(file);
  });
}
pliant_status pliant_world_load(pliant_world world, const char* file) {
  return on(world, [&](CWorld& w) {
    need(file, "file");
    w.world.load(file);
  });
}
pliant_status pliant_world_reset(pliant_world world) {
  return on(world, [&](CWorld& w) { w.world.reset(); });
}
