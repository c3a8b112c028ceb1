#include "devices/open_device.h"

#include <fmt/format.h>

#include "devices/datagram_device.h"
#include "devices/igtl_device.h"
#include "devices/osc.h"
#include "devices/shared_device.h"
#include "devices/spacenav_device.h"
#include "devices/stroke.h"
#include "devices/stroke_device.h"
#include "devices/websocket_device.h"
#include "pliant/error.h"

namespace pliant {
namespace devices {
namespace {

using Device = std::shared_ptr<HapticDevice>;

/// A kind of device: what stands before the colon, how a text of it looks, and what opens it from what stands after the colon.
struct DeviceKind {
  const char* name;
  const char* form;
  Device (*open)(const std::string& rest, const std::string& text);
};

const DeviceKind kKinds[] = {
    {"file", "file:STROKE.csv",
     [](const std::string& rest, const std::string&) -> Device { return std::make_shared<StrokeDevice>(read_stroke(rest)); }},
    {"udp", "udp:PORT",
     [](const std::string& rest, const std::string& text) -> Device {
       return std::make_shared<DatagramDevice>(kPackets, rest, text);
     }},
    {"shm", "shm:NAME",
     [](const std::string& rest, const std::string& text) -> Device { return std::make_shared<SharedDevice>(rest, text); }},
    {"websocket", "websocket:PORT", open_websocket},
    {"igtl", "igtl:PORT",
     [](const std::string& rest, const std::string& text) -> Device { return std::make_shared<IgtlDevice>(rest, text); }},
    {"osc", "osc:PORT",
     [](const std::string& rest, const std::string& text) -> Device {
       return std::make_shared<DatagramDevice>(kOsc, rest, text);
     }},
    {"spacenav", "spacenav", open_spacenav},
};

}  // namespace

std::shared_ptr<HapticDevice> open_device(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  const std::string rest = colon == std::string::npos ? "" : text.substr(colon + 1);
  std::string forms;
  for (const DeviceKind& kind : kKinds) {
    const std::string form = kind.form;
    if (name == kind.name) {
      if (rest.empty() && form.find(':') != std::string::npos) {
        throw Error(ErrorCode::usage, fmt::format("haptic device \"{}\": expected {}", text, form));
      }
      return kind.open(rest, text);
    }
    forms += (forms.empty() ? "" : ", ") + form;
  }
  throw Error(ErrorCode::usage,
              fmt::format("haptic device \"{}\": there is no kind \"{}\"; allowed are {}", text, name, forms));
}

}  // namespace devices

std::shared_ptr<HapticDevice> open_haptic_device(const std::string& text) { return devices::open_device(text); }

}  // namespace pliant
