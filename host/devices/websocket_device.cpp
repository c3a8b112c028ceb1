#include "devices/websocket_device.h"

#include <fmt/format.h>

#include "devices/haply.h"
#include "pliant/error.h"

#ifndef PLIANT_WEBSOCKETS_LIBRARY

namespace pliant::devices {

std::shared_ptr<HapticDevice> open_websocket(const std::string& rest, const std::string& text) {
  parse_haply_address(rest, text);
  throw Error(ErrorCode::bad_input, fmt::format("haptic device \"{}\": this build has no WebSocket (libwebsockets)", text));
}

}  // namespace pliant::devices

#else

#include <libwebsockets.h>

#include <chrono>
#include <cstring>
#include <limits>
#include <thread>
#include <vector>

#include "devices/dynamic_library.h"
#include "devices/threaded_device.h"

namespace pliant::devices {
namespace {

constexpr double kPatience = 2e-3;               ///< for the force that answers a state [s]
constexpr std::chrono::microseconds kLook{100};  ///< how often it is looked for
constexpr int kAgain = 30;                       ///< between attempts to connect [10 ms]

/// What is called of the library.
struct Websockets {
  explicit Websockets(const std::string& device) {
    const DynamicLibrary library(PLIANT_WEBSOCKETS_LIBRARY, device);
    library.find(create_context, "lws_create_context");
    library.find(context_destroy, "lws_context_destroy");
    library.find(client_connect, "lws_client_connect_via_info");
    library.find(service, "lws_service");
    library.find(cancel_service, "lws_cancel_service");
    library.find(callback_on_writable, "lws_callback_on_writable");
    library.find(write, "lws_write");
    library.find(is_final_fragment, "lws_is_final_fragment");
    library.find(remaining_payload, "lws_remaining_packet_payload");
    library.find(context_of, "lws_get_context");
    library.find(user_of, "lws_context_user");
    library.find(set_log_level, "lws_set_log_level");
  }
  decltype(lws_create_context)* create_context;
  decltype(lws_context_destroy)* context_destroy;
  decltype(lws_client_connect_via_info)* client_connect;
  decltype(lws_service)* service;
  decltype(lws_cancel_service)* cancel_service;
  decltype(lws_callback_on_writable)* callback_on_writable;
  decltype(lws_write)* write;
  decltype(lws_is_final_fragment)* is_final_fragment;
  decltype(lws_remaining_packet_payload)* remaining_payload;
  decltype(lws_get_context)* context_of;
  decltype(lws_context_user)* user_of;
  decltype(lws_set_log_level)* set_log_level;
};

/// The library, loaded for the first device.
const Websockets& websockets(const std::string& device) {
  static const Websockets library(device);
  return library;
}

class WebsocketDevice final : public ThreadedDevice {
 public:
  WebsocketDevice(HaplyAddress address, const std::string& text);
  ~WebsocketDevice() override;
  [[nodiscard]] DeviceLimits limits() const noexcept override { return {DeviceLimits{}.force, 0}; }

 private:
  static int on_event(lws* connection, lws_callback_reasons reason, void* user, void* data, std::size_t size);
  void serve() override;
  void wake() noexcept override;
  void answer();
  void connect();
  void handle(lws* connection, lws_callback_reasons reason, const void* data, std::size_t size);
  void receive(lws* connection, const void* data, std::size_t size);
  void send(lws* connection);
  void lose();

  HaplyAddress address_;
  const Websockets& library_;
  lws_protocols protocols_[2]{};
  lws_context* context_ = nullptr;
  lws* connection_ = nullptr;
  bool connecting_ = false;
  bool lost_ = false;         ///< told since the last connection
  bool owed_ = false;         ///< a state has come that no force has answered
  double due_ = 0;            ///< when it is answered by the force before [s since the device was opened]
  std::uint64_t number_ = 0;  ///< of the newest sample
  bool too_long_ = false;
  std::vector<std::uint8_t> message_;
  HaplyState state_;
  Vec3d force_{};
};

WebsocketDevice::WebsocketDevice(HaplyAddress address, const std::string& text)
    : address_(std::move(address)), library_(websockets(text)) {
  library_.set_log_level(LLL_ERR, nullptr);
  protocols_[0].name = "pliant";
  protocols_[0].callback = on_event;
  protocols_[0].rx_buffer_size = 8192;
  lws_context_creation_info info{};
  info.port = CONTEXT_PORT_NO_LISTEN;
  info.protocols = protocols_;
  info.gid = static_cast<gid_t>(-1);
  info.uid = static_cast<uid_t>(-1);
  info.user = this;
  context_ = library_.create_context(&info);
  if (context_ == nullptr)
    throw Error(ErrorCode::bad_input, fmt::format("haptic device \"{}\": libwebsockets cannot begin", text));
  message_.reserve(kHaplyLargestState);
  start();
}

WebsocketDevice::~WebsocketDevice() {
  stop();
  library_.context_destroy(context_);
}

void WebsocketDevice::wake() noexcept { library_.cancel_service(context_); }

void WebsocketDevice::serve() {
  while (!stopping()) {
    if (connection_ == nullptr && !connecting_) {
      for (int i = 0; lost_ && i < kAgain && !stopping(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
      connect();
    }
    if (owed_) {
      answer();
    } else {
      library_.service(context_, 0);
    }
  }
}

/// Looks for the wrench that answers the newest state; nobody is woken for it.
void WebsocketDevice::answer() {
  std::this_thread::sleep_for(kLook);
  const std::optional<DeviceWrench> wrench = newest_wrench();
  if (wrench) force_ = wrench->force;
  if ((wrench && wrench->number == number_) || elapsed() > due_) library_.callback_on_writable(connection_);
  library_.service(context_, -1);  // does what there is to do
}

void WebsocketDevice::connect() {
  lws_client_connect_info info{};
  info.context = context_;
  info.address = address_.host.c_str();
  info.port = address_.port;
  info.path = address_.path.c_str();
  info.host = info.address;
  info.origin = info.address;
  info.local_protocol_name = "pliant";
  connecting_ = true;
  // It may fail at once, or tell of it by an event.
  if (library_.client_connect(&info) == nullptr) lose();
}

void WebsocketDevice::lose() {
  connecting_ = false;
  connection_ = nullptr;
  owed_ = false;
  force_ = {};
  if (!lost_) refuse("no connection to the service");
  lost_ = true;
}

int WebsocketDevice::on_event(lws* connection, lws_callback_reasons reason, void* /*user*/, void* data, std::size_t size) {
  switch (reason) {
    case LWS_CALLBACK_CLIENT_ESTABLISHED:
    case LWS_CALLBACK_CLIENT_CONNECTION_ERROR:
    case LWS_CALLBACK_CLIENT_CLOSED:
    case LWS_CALLBACK_CLIENT_RECEIVE:
    case LWS_CALLBACK_CLIENT_WRITEABLE:
      break;
    default:
      return 0;
  }
  const Websockets& library = websockets("");
  static_cast<WebsocketDevice*>(library.user_of(library.context_of(connection)))->handle(connection, reason, data, size);
  return 0;
}

void WebsocketDevice::handle(lws* connection, lws_callback_reasons reason, const void* data, std::size_t size) {
  switch (reason) {
    case LWS_CALLBACK_CLIENT_ESTABLISHED:
      connecting_ = false;
      lost_ = false;
      connection_ = connection;
      message_.clear();
      break;
    case LWS_CALLBACK_CLIENT_RECEIVE:
      receive(connection, data, size);
      break;
    case LWS_CALLBACK_CLIENT_WRITEABLE:
      if (owed_) send(connection);
      break;
    default:
      lose();
  }
}

void WebsocketDevice::receive(lws* connection, const void* data, std::size_t size) {
  too_long_ = too_long_ || message_.size() + size > kHaplyLargestState;
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  if (!too_long_) message_.insert(message_.end(), bytes, bytes + size);
  if (library_.is_final_fragment(connection) == 0 || library_.remaining_payload(connection) != 0) return;
  const Refusal why = too_long_ ? "a state of more than 65536 bytes" : read_haply_state(message_, address_.device_id, state_);
  message_.clear();
  too_long_ = false;
  if (why != nullptr) {
    refuse(why);
  } else {
    number_ = publish(state_.sample);
  }
  if (owed_ || state_.device_id.empty()) return;
  owed_ = true;
  due_ = address_.waits ? std::numeric_limits<double>::infinity() : elapsed() + kPatience;
}

void WebsocketDevice::send(lws* connection) {
  owed_ = false;
  const std::string text = haply_force(address_.force, state_.device_id, force_);
  std::vector<unsigned char> bytes(LWS_PRE + text.size());
  std::memcpy(bytes.data() + LWS_PRE, text.data(), text.size());
  library_.write(connection, bytes.data() + LWS_PRE, text.size(), LWS_WRITE_TEXT);
}

}  // namespace

std::shared_ptr<HapticDevice> open_websocket(const std::string& rest, const std::string& text) {
  return std::make_shared<WebsocketDevice>(parse_haply_address(rest, text), text);
}

}  // namespace pliant::devices

#endif
