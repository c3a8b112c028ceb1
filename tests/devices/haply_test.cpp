// The device websocket:PORT, with a WebSocket server of Python in the part of Haply's service.
#include "devices/haply.h"

#include <sys/wait.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "device_ends.h"
#include "devices/open_device.h"
#include "support/source_dir.h"
#include "support/temp_folder.h"

namespace pliant::device_test::haply {
namespace {

using devices::haply_force;
using devices::HaplyForce;
using devices::HaplyState;
using devices::open_device;
using devices::parse_haply_address;

constexpr const char* kState =
    R"({"inverse3": [{"device_id": "04AF", "state": {"cursor_position": {"x": 0.01, "y": -0.15, "z": 0.2}}},
        {"device_id": "04B0", "state": {"cursor_position": {"x": 1, "y": 2, "z": 3}, "cursor_velocity": {"x": 0, "y": 0, "z": 0}}}],
        "wireless_verse_grip": [{"state": {"orientation": {"x": 0, "y": 0.6, "z": 0, "w": 0.8}, "buttons": {"a": false, "b": true}}}]})";

std::string why_refused(const std::string& text, HaplyState& state, const std::string& id = "") {
  const devices::Refusal why =
      devices::read_haply_state({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, id, state);
  return why == nullptr ? "" : why;
}

TEST(HaplyFormat, StatesGiveThePoseOfTheDeviceAndItsHandle) {
  HaplyState state;
  EXPECT_EQ(why_refused(kState, state), "");
  EXPECT_EQ(state.device_id, "04AF");
  EXPECT_EQ(state.sample.position, (Vec3d{0.01, -0.15, 0.2}));
  EXPECT_EQ(state.sample.turn, (std::array<double, 4>{0, 0.6, 0, 0.8}));
  EXPECT_EQ(state.sample.buttons, 2U);
  EXPECT_EQ(why_refused(kState, state, "04B0"), "");
  EXPECT_EQ(state.sample.position, (Vec3d{1, 2, 3}));
  // Without a handle, orientation and buttons stay; a handle of another kind counts as well.
  const std::string device = R"({"inverse3": [{"device_id": "1", "state": {"cursor_position": {"x": 0, "y": 0, "z": 0}}}])";
  EXPECT_EQ(why_refused(device + "}", state), "");
  EXPECT_EQ(state.sample.turn[1], 0.6);
  EXPECT_EQ(state.sample.buttons, 2U);
  const std::string still = R"("state": {"orientation": {"x": 0, "y": 0, "z": 0, "w": 0}, "buttons": {"button_0": true}})";
  EXPECT_EQ(why_refused(device + R"(, "verse_grip": [{)" + still + "}]}", state), "");
  EXPECT_EQ(state.sample.turn[1], 0.6);
  EXPECT_EQ(state.sample.buttons, 1U);
}

TEST(HaplyFormat, GarbageIsRefusedAndChangesNothing) {
  HaplyState state;
  ASSERT_EQ(why_refused(kState, state), "");
  const HaplyState before = state;
  EXPECT_EQ(why_refused("", state), "a message that is no JSON");
  EXPECT_EQ(why_refused("{", state), "a message that is no JSON");
  EXPECT_EQ(why_refused(std::string(70000, '['), state), "a state of more than 65536 bytes");
  EXPECT_EQ(why_refused("[1]", state), "a message without inverse3");
  EXPECT_EQ(why_refused(R"({"inverse3": {}})", state), "a message without inverse3");
  EXPECT_EQ(why_refused(R"({"inverse3": [7, {"device_id": 3}]})", state), "a state without the device");
  EXPECT_EQ(why_refused(kState, state, "0000"), "a state without the device");
  const auto at = [](const std::string& position) {
    return R"({"inverse3": [{"device_id": "1", "state": )" + position + "}]}";
  };
  for (const char* bad : {"null", "{}", R"({"cursor_position": [0, 0, 0]})", R"({"cursor_position": {"x": 0, "y": 0}})",
                          R"({"cursor_position": {"x": 0, "y": 0, "z": "0"}})"}) {
    EXPECT_EQ(why_refused(at(bad), state), "a state without x, y and z of cursor_position") << bad;
  }
  EXPECT_EQ(why_refused(at(R"({"cursor_position": {"x": 1e5, "y": 0, "z": 0}})"), state), "a position beyond 1000 m");
  std::string turned = kState;
  turned.replace(turned.find("0.6"), 3, "0.9");
  EXPECT_EQ(why_refused(turned, state), "a quaternion that is not of unit length");
  EXPECT_EQ(state.sample.position, before.sample.position);
  EXPECT_EQ(state.sample.turn, before.sample.turn);
  EXPECT_EQ(state.device_id, before.device_id);
}

TEST(HaplyFormat, ForcesAreWrittenForEachVersionOfTheService) {
  EXPECT_EQ(haply_force(HaplyForce::vector, "04AF", {1, -2, 0.5}),
            R"({"inverse3":[{"commands":{"set_cursor_force":{"vector":{"x":1.0,"y":-2.0,"z":0.5}}},"device_id":"04AF"}]})");
  EXPECT_NE(haply_force(HaplyForce::values, "04AF", {1, -2, 0.5}).find(R"("set_cursor_force":{"values":{"x":1.0)"),
            std::string::npos);
  EXPECT_EQ(haply_force(HaplyForce::plain, "a\"b\xff", {NAN, INFINITY, 0}),
            R"({"device_id":"a\"b\ufffd","force":{"x":0.0,"y":0.0,"z":0.0}})");
}

TEST(HaplyFormat, AddressesAreReadWhole) {
  EXPECT_EQ(parse_haply_address("10002", "t").port, 10002);
  const auto whole = parse_haply_address("ws://lab.local:9/v2?device=04AF&force=plain", "t");
  EXPECT_EQ(whole.host + " " + std::to_string(whole.port) + " " + whole.path + " " + whole.device_id, "lab.local 9 /v2 04AF");
  EXPECT_EQ(whole.force, HaplyForce::plain);
  EXPECT_EQ(parse_haply_address("ws://lab.local", "t").port, 10001);
  for (const char* bad :
       {"x", "0", "65536", "wss://lab:1", "ws://:1", "ws://lab:x", "1?", "1?force=strong", "1?device=", "1?force=plain&x"}) {
    EXPECT_THROW(parse_haply_address(bad, "t"), Error) << bad;
  }
}

/// tests/devices/haply_service.py in a process of its own.
class Service {
 public:
  explicit Service(const std::string& mode) {
    for (const char* python : {"python3", "/usr/bin/python3"}) {  // the first may be one without Debian's modules
      exit_ = 0;
      start(python, mode);
      if (!missing()) return;
    }
  }
  ~Service() { end(); }
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;
  void end() {
    if (process_ == 0) return;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    process_ = 0;
  }
  /// Whether Python has no module websockets.
  [[nodiscard]] bool missing() const { return exit_ == 77 || exit_ == 127; }
  [[nodiscard]] int port() const { return port_; }
  /// The messages that it has received.
  [[nodiscard]] std::vector<nlohmann::json> received() const {
    std::ifstream stream(folder_.path() / "log");
    std::vector<nlohmann::json> messages;
    for (std::string line; std::getline(stream, line);) {
      nlohmann::json message = nlohmann::json::parse(line, nullptr, false);
      if (!message.is_discarded()) messages.push_back(std::move(message));
    }
    return messages;
  }

 private:
  void start(const char* python, const std::string& mode) {
    const std::string script = test::source_dir() + "/tests/devices/haply_service.py";
    const std::string file = (folder_.path() / "port").string(), log = (folder_.path() / "log").string();
    process_ = fork();
    if (process_ == 0) {
      execlp(python, python, "-B", script.c_str(), file.c_str(), log.c_str(), mode.c_str(), nullptr);
      _exit(127);
    }
    EXPECT_TRUE(until([&] {
      int status = 0;
      if (waitpid(process_, &status, WNOHANG) == process_) {
        exit_ = WEXITSTATUS(status);
        process_ = 0;
      }
      std::ifstream(file) >> port_;
      return port_ > 0 || process_ == 0;
    }));
  }

  test::TempFolder folder_;
  pid_t process_ = 0;
  int exit_ = 0, port_ = 0;
};

/// Opens the device, or returns null where this build or this machine has no WebSocket.
std::shared_ptr<HapticDevice> open_or_skip(const std::string& text) {
  try {
    return open_device(text);
  } catch (const Error& error) {
    const std::string what = error.what();
    EXPECT_TRUE(what.find("has no WebSocket (libwebsockets)") != std::string::npos ||
                what.find("not installed") != std::string::npos)
        << what;
    return nullptr;
  }
}

TEST(HaplyDevice, AServiceIsHeardAndEachStateAnsweredByOneForce) {
  const Service service("lockstep");
  if (service.missing()) GTEST_SKIP() << "needs Python 3 with websockets (python3-websockets)";
  const auto device = open_or_skip("websocket:" + std::to_string(service.port()));
  if (!device) GTEST_SKIP() << "needs libwebsockets";
  EXPECT_EQ(device->limits().torque, 0);
  // The service sends state i at x = i mm, the next one when it has its force: a state without a wrench is answered, too.
  const DeviceSample silent = wait_sample(*device, 5);
  EXPECT_NEAR(silent.turn[1], 0.6, 1e-15);
  std::uint64_t last = 0;
  ASSERT_TRUE(until([&] {
    const DeviceSample sample = device->read();
    DeviceWrench wrench = wrench_for(sample);
    wrench.force[0] = sample.position[0];
    if (sample.number != last) device->write(wrench);
    last = sample.number;
    return sample.number >= 300;
  }));
  ASSERT_TRUE(until([&] { return service.received().size() >= 299; }));
  int matching = 0;
  const auto messages = service.received();
  for (std::size_t i = 0; i < 299; ++i) {
    const auto& command = messages[i].at("inverse3").at(0);
    EXPECT_EQ(command.at("device_id"), "04AF");
    const double x = command.at("commands").at("set_cursor_force").at("vector").at("x"), want = 1e-3 * static_cast<double>(i);
    EXPECT_LT(x, want + 1e-9);  // of this state, or of one before where a slow machine missed the 2 ms
    matching += x > want - 1e-9 ? 1 : 0;
  }
  EXPECT_GT(matching, 20);
  EXPECT_EQ(device->counts().refused, 0U);
}

TEST(HaplyDevice, GoesOnAfterGarbageAndAfterTheServiceHasGone) {
  auto service = std::make_unique<Service>("garbage");
  if (service->missing()) GTEST_SKIP() << "needs Python 3 with websockets (python3-websockets)";
  const auto device = open_or_skip("websocket:ws://127.0.0.1:" + std::to_string(service->port()) + "/?force=plain&device=04B0");
  if (!device) GTEST_SKIP() << "needs libwebsockets";
  wait_sample(*device, 2);  // around every kind of garbage: no JSON, too long, other documents, in pieces
  EXPECT_TRUE(until([&] { return !service->received().empty(); }));
  EXPECT_EQ(service->received().front().at("device_id"), "04B0");
  EXPECT_TRUE(service->received().front().contains("force"));
  const std::uint64_t refused = device->counts().refused;
  EXPECT_GE(refused, 3U);
  service->end();
  EXPECT_EQ(wait_refusal(*device, refused + 1), "no connection to the service");
}

TEST(HaplyDevice, TwoAtOnceTakeADeviceEach) {
  const Service service("stream");
  if (service.missing()) GTEST_SKIP() << "needs Python 3 with websockets (python3-websockets)";
  const std::string at = "websocket:" + std::to_string(service.port());
  const auto left = open_or_skip(at + "?device=04AF"), right = open_or_skip(at + "?device=04B0");
  if (!left || !right) GTEST_SKIP() << "needs libwebsockets";
  EXPECT_LT(wait_sample(*left, 20).position[2], 1);
  EXPECT_EQ(wait_sample(*right, 20).position[2], 3);
}

TEST(HaplyDevice, WaitsForAServiceThatIsNotThereYet) {
  const auto device = open_or_skip("websocket:1");
  if (!device) GTEST_SKIP() << "needs libwebsockets";
  EXPECT_EQ(wait_refusal(*device, 1), "no connection to the service");
  for (int i = 0; i < 100; ++i) device->write(wrench_for(device->read()));
  EXPECT_EQ(device->read().number, 0U);
}

}  // namespace
}  // namespace pliant::device_test::haply
