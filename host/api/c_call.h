// Common start of every C API call. Private to host/api.
#pragma once
#include <fmt/format.h>

#include <new>
#include <string>

#include "api/c_handles.h"
#include "api/c_structs.h"
#include "pliant/c/pliant.h"

namespace pliant::api {

/// The last error message of the calling thread.
inline thread_local std::string last_error;

/// Runs `call` and converts exceptions to a status.
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

inline void need(const void* pointer, const char* name) {
  if (pointer == nullptr) throw Error(ErrorCode::usage, fmt::format("\"{}\" is a null pointer", name));
}

/// Copies a surface of the caller. Throws Error (usage) for a struct of the wrong size and for null arrays.
inline SurfaceSpec surface_of(const pliant_surface& given) {
  const pliant_surface s = take_struct<pliant_surface>(given, PLIANT_SURFACE_INIT);
  if (s.vertex_count > 0) need(s.vertices, "vertices");
  if (s.triangle_count > 0) need(s.triangles, "triangles");
  SurfaceSpec spec;
  for (std::size_t v = 0; v < s.vertex_count; ++v) {
    spec.vertices.push_back({s.vertices[3 * v], s.vertices[3 * v + 1], s.vertices[3 * v + 2]});
  }
  for (std::size_t t = 0; t < s.triangle_count; ++t) {
    spec.triangles.push_back({s.triangles[3 * t], s.triangles[3 * t + 1], s.triangles[3 * t + 2]});
  }
  return spec;
}

/// Element i of an array of the caller's structs, which may be larger than this library's.
template <class T>
T* element(T* first, std::size_t i) {
  return reinterpret_cast<T*>(reinterpret_cast<char*>(first) + i * first->size);
}

template <class T>
void check_array(T* first, std::size_t count, const char* name) {
  if (count == 0) return;
  need(first, "out");
  check_struct(first);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t size = element(first, i)->size;
    if (size == first->size) continue;
    throw Error(ErrorCode::usage, fmt::format("{}::size is {} in out[{}] and {} in the first", name, size, i, first->size));
  }
}

inline void give_report(const StepReport& r, pliant_report* out) {
  thread_local std::string message;
  if (out == nullptr) return;
  message = r.message;
  give_struct<pliant_report>({0, r.done, r.step, r.time, r.dt, r.diverged ? 1 : 0, r.at_equilibrium ? 1 : 0, message.c_str()},
                             out);
}

template <class Call>
pliant_status on(pliant_world world, Call&& call) noexcept {
  return guarded([&] {
    const auto held = Handles::all().find(world.id);
    call(*held);
  });
}

inline void check_count(std::size_t given, std::size_t needed, const char* what) {
  if (given == needed) return;
  throw Error(ErrorCode::usage, fmt::format("the buffer for {} holds {} numbers, expected {}", what, given, needed));
}

inline Vec3d vector_of(const double* v, const char* name) {
  need(v, name);
  return {v[0], v[1], v[2]};
}

}  // namespace pliant::api
