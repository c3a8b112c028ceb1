// Conversion of C API structs of other versions; pliant/c/types.h states the contract.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "pliant/c/blades.h"
#include "pliant/c/cut.h"
#include "pliant/c/haptics.h"
#include "pliant/c/live.h"
#include "pliant/c/types.h"
#include "pliant/error.h"

namespace pliant::api {

constexpr std::size_t kLargestStruct = 4096;  // larger values indicate an uninitialized `size`

/// Name and size in 0.2.0, the first version with sizes in its structs: up to the last member of that version, padded. Later
/// members start after that.
template <class T>
struct CStruct;

#define PLIANT_C_STRUCT(type, last)                                                                      \
  template <>                                                                                            \
  struct CStruct<type> {                                                                                 \
    static constexpr const char* name = #type;                                                           \
    static constexpr std::size_t first_size =                                                            \
        (offsetof(type, last) + sizeof(type::last) + alignof(type) - 1) / alignof(type) * alignof(type); \
  }
PLIANT_C_STRUCT(pliant_options, reserved);
PLIANT_C_STRUCT(pliant_surface, triangle_count);
PLIANT_C_STRUCT(pliant_info, reserved);
PLIANT_C_STRUCT(pliant_body, triangle_count);
PLIANT_C_STRUCT(pliant_report, message);
PLIANT_C_STRUCT(pliant_frame, body_triangles);
PLIANT_C_STRUCT(pliant_cut, mass_lost);
PLIANT_C_STRUCT(pliant_probe_value, number_count);
PLIANT_C_STRUCT(pliant_tool_force, reserved);
PLIANT_C_STRUCT(pliant_blade_force, pressing);
PLIANT_C_STRUCT(pliant_cut_attempt, reserved);
PLIANT_C_STRUCT(pliant_interpenetration, reserved);
PLIANT_C_STRUCT(pliant_picked_point, reserved);
PLIANT_C_STRUCT(pliant_live_options, speed);
PLIANT_C_STRUCT(pliant_live_state, lost);
PLIANT_C_STRUCT(pliant_event, reserved);
PLIANT_C_STRUCT(pliant_force_sample, torque);
PLIANT_C_STRUCT(pliant_device_sample, reserved);
PLIANT_C_STRUCT(pliant_device_wrench, number);
PLIANT_C_STRUCT(pliant_device_limits, torque);
PLIANT_C_STRUCT(pliant_device_counts, last_refusal);
PLIANT_C_STRUCT(pliant_device_callbacks, release);
PLIANT_C_STRUCT(pliant_haptic_options, realtime);
PLIANT_C_STRUCT(pliant_haptic_sample, force);
PLIANT_C_STRUCT(pliant_haptic_state, substeps);
#undef PLIANT_C_STRUCT

/// Throws Error (usage) for an invalid size.
template <class T>
void check_struct(const T* given) {
  if (given == nullptr || (given->size >= CStruct<T>::first_size && given->size <= kLargestStruct)) return;
  throw Error(ErrorCode::usage,
              fmt::format("{}::size is {}; allowed are {} (of 0.2.0) to {}: sizeof({}) in your program", CStruct<T>::name,
                          given->size, CStruct<T>::first_size, kLargestStruct, CStruct<T>::name));
}

/// Returns the caller's struct, with defaults for members that an older caller lacks. Throws Error (usage) for an invalid
/// size, and if a newer caller sets a member that this library does not know.
template <class T>
T take_struct(const T& given, T defaults) {
  check_struct(&given);
  const std::size_t known = std::min(given.size, sizeof(T));
  const auto* bytes = reinterpret_cast<const unsigned char*>(&given);
  const auto* unknown = std::find_if(bytes + known, bytes + given.size, [](unsigned char b) { return b != 0; });
  if (unknown != bytes + given.size) {
    throw Error(ErrorCode::usage, fmt::format("{}: the member at byte {} is set, and this library knows {} bytes: it is older "
                                              "than the headers of your program",
                                              CStruct<T>::name, unknown - bytes, sizeof(T)));
  }
  std::memcpy(&defaults, &given, known);
  return defaults;
}

/// Copies `value` up to the caller's size, and zeros members that only a newer caller knows. `out` must be checked.
template <class T>
void give_struct(T value, T* out) {
  if (out == nullptr) return;
  const std::size_t size = out->size, known = std::min(size, sizeof(T));
  value.size = size;
  std::memcpy(out, &value, known);
  std::memset(reinterpret_cast<unsigned char*>(out) + known, 0, size - known);
}

}  // namespace pliant::api
