#include "devices/haply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "devices/listen.h"
#include "pliant/error.h"

namespace pliant::devices {
namespace {

using Json = nlohmann::json;

/// The member, or null.
const Json* member(const Json* object, const char* name) {
  if (object == nullptr || !object->is_object()) return nullptr;
  const auto found = object->find(name);
  return found == object->end() ? nullptr : &*found;
}

template <std::size_t n>
bool numbers(const Json* object, const std::array<const char*, n>& names, std::array<double, n>& out) {
  for (std::size_t i = 0; i < n; ++i) {
    const Json* value = member(object, names[i]);
    if (value == nullptr || !value->is_number()) return false;
    out[i] = value->get<double>();
  }
  return true;
}

const std::string* id_of(const Json& device) {
  const Json* id = member(&device, "device_id");
  return id == nullptr ? nullptr : id->get_ptr<const std::string*>();
}

/// The state of the first handle that has one.
const Json* handle_state(const Json& document) {
  for (const char* kind : {"wireless_verse_grip", "verse_grip", "custom_verse_grip"}) {
    const Json* handles = member(&document, kind);
    if (handles != nullptr && handles->is_array() && !handles->empty()) return member(&handles->front(), "state");
  }
  return nullptr;
}

std::uint32_t button_bits(const Json& buttons) {
  constexpr std::array<std::array<const char*, 2>, 4> names{
      {{"a", "button_0"}, {"b", "button_1"}, {"c", "button_2"}, {"d", "button_3"}}};
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (const char* name : names[i]) {
      const Json* value = member(&buttons, name);
      if (value != nullptr && value->is_boolean() && value->get<bool>()) bits |= 1U << i;
    }
  }
  return bits;
}

[[noreturn]] void fail_address(const std::string& text, const std::string& got) {
  throw Error(
      ErrorCode::usage,
      fmt::format(
          "haptic device \"{}\": got \"{}\", expected websocket:PORT or websocket:ws://HOST:PORT/PATH, "
          "perhaps with ?device=ID&force=FORM&answer=WHEN, where FORM is vector, values or plain, and WHEN soon or wrench",
          text, got));
}

void read_option(const std::string& option, const std::string& text, HaplyAddress& address) {
  const std::size_t equals = option.find('=');
  const std::string name = option.substr(0, equals), value = equals == std::string::npos ? "" : option.substr(equals + 1);
  if (name == "device" && !value.empty()) {
    address.device_id = value;
  } else if (name == "force" && (value == "vector" || value == "values" || value == "plain")) {
    address.force = value == "vector" ? HaplyForce::vector : value == "values" ? HaplyForce::values : HaplyForce::plain;
  } else if (name == "answer" && (value == "soon" || value == "wrench")) {
    address.waits = value == "wrench";
  } else {
    fail_address(text, option);
  }
}

}  // namespace

Refusal read_haply_state(std::span<const std::uint8_t> text, const std::string& device_id, HaplyState& state) {
  if (text.size() > kHaplyLargestState) return "a state of more than 65536 bytes";
  const Json document = Json::parse(text.begin(), text.end(), nullptr, false);
  if (document.is_discarded()) return "a message that is no JSON";
  const Json* devices = member(&document, "inverse3");
  if (devices == nullptr || !devices->is_array()) return "a message without inverse3";
  const Json* device = nullptr;
  for (const Json& candidate : *devices) {
    const std::string* id = id_of(candidate);
    if (device == nullptr && id != nullptr && (device_id.empty() || *id == device_id)) device = &candidate;
  }
  if (device == nullptr) return "a state without the device";
  DeviceSample sample = state.sample;
  if (!numbers<3>(member(member(device, "state"), "cursor_position"), {"x", "y", "z"}, sample.position)) {
    return "a state without x, y and z of cursor_position";
  }
  const Json* handle = handle_state(document);
  if (const Json* orientation = member(handle, "orientation"); orientation != nullptr && !orientation->is_null()) {
    std::array<double, 4> turn{};
    if (!numbers<4>(orientation, {"x", "y", "z", "w"}, turn)) return "a handle without x, y, z and w of orientation";
    if (turn != std::array<double, 4>{}) sample.turn = turn;
  }
  if (const Json* buttons = member(handle, "buttons"); buttons != nullptr) sample.buttons = button_bits(*buttons);
  sample.time = kNoTime;
  sample.number = 0;
  if (const Refusal why = check_sample(sample); why != nullptr) return why;
  state.sample = sample;
  state.device_id = *id_of(*device);
  return nullptr;
}

std::string haply_force(HaplyForce form, const std::string& device_id, const Vec3d& force) {
  const auto finite = [](double x) { return std::isfinite(x) ? x : 0; };
  const Json vector = {{"x", finite(force[0])}, {"y", finite(force[1])}, {"z", finite(force[2])}};
  Json message;
  if (form == HaplyForce::plain) {
    message = {{"device_id", device_id}, {"force", vector}};
  } else {
    const char* name = form == HaplyForce::vector ? "vector" : "values";
    const Json command = {{"device_id", device_id}, {"commands", {{"set_cursor_force", {{name, vector}}}}}};
    message["inverse3"] = Json::array({command});
  }
  return message.dump(-1, ' ', true, Json::error_handler_t::replace);
}

HaplyAddress parse_haply_address(const std::string& rest, const std::string& text) {
  HaplyAddress address;
  const std::size_t question = rest.find('?');
  std::string place = rest.substr(0, question);
  for (std::size_t from = question; from < rest.size();) {
    const std::size_t end = std::min(rest.find('&', from + 1), rest.size());
    read_option(rest.substr(from + 1, end - from - 1), text, address);
    from = end;
  }
  const std::string scheme = "ws://";
  const bool url = place.rfind(scheme, 0) == 0;
  if (url) {
    place = place.substr(scheme.size());
    const std::size_t slash = place.find('/');
    if (slash != std::string::npos) address.path = place.substr(slash);
    place.resize(std::min(slash, place.size()));
    const std::size_t colon = place.find(':');
    address.host = place.substr(0, colon);
    if (address.host.empty()) fail_address(text, rest);
    if (colon == std::string::npos) return address;
    place = place.substr(colon + 1);
  }
  address.port = static_cast<int>(whole_number(place, 1, 65535));
  if (address.port < 0) fail_address(text, rest);
  return address;
}

}  // namespace pliant::devices
