// The JSON messages of Haply's Inverse service (ws://localhost:10001), which drives the Inverse3 and its handles.
//
// A state, from the service:
//   {"inverse3": [{"device_id": "04AF", "state": {"cursor_position": {"x": 0.01, "y": -0.15, "z": 0.2}}}],
//    "wireless_verse_grip": [{"state": {"orientation": {"x": 0, "y": 0, "z": 0, "w": 1}, "buttons": {"a": false, "b": true}}}]}
// Forces, to the service, by its version: see HaplyForce.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "devices/check_sample.h"

namespace pliant::devices {

inline constexpr std::size_t kHaplyLargestState = 65536;  ///< bytes; longer states are refused

/// A state: the tip of one Inverse3.
struct HaplyState {
  DeviceSample sample;
  std::string device_id;
};

/// Reads a state. `device_id` chooses among several devices; empty: the first. The orientation is that of the first handle,
/// whatever its kind; a state without a handle, or with one that has not turned yet (all zeros), keeps `sample.turn`, and one
/// without buttons keeps `sample.buttons`. Buttons a, b, c, or button_0 to button_3, are bits 0 to 3. The time is kNoTime, the
/// number 0. Refused: no JSON, too long, no such device, numbers that are missing, what check_sample refuses.
Refusal read_haply_state(std::span<const std::uint8_t> text, const std::string& device_id, HaplyState& state);

/// How a version of the service wants its forces.
enum class HaplyForce {
  vector,  ///< 3.5: {"inverse3": [{"device_id": ID, "commands": {"set_cursor_force": {"vector": {"x": ...}}}}]}
  values,  ///< 3.1: "values" instead of "vector"
  plain    ///< before: {"device_id": ID, "force": {"x": ...}}
};

/// The message that sets a force [N]. A force that is not finite is sent as 0.
std::string haply_force(HaplyForce form, const std::string& device_id, const Vec3d& force);

/// Where the service listens, and the data requested from it.
struct HaplyAddress {
  std::string host = "127.0.0.1";
  int port = 10001;
  std::string path = "/";
  std::string device_id;
  HaplyForce force = HaplyForce::vector;
  bool waits = false;  ///< a state is answered when a wrench is written, however long that takes
};

/// PORT or ws://HOST[:PORT][/PATH], either with ?device=ID, &force=vector, values or plain, and &answer=soon or wrench. Throws
/// Error `usage` for anything else; `text` is the whole text of the device.
HaplyAddress parse_haply_address(const std::string& rest, const std::string& text);

}  // namespace pliant::devices
