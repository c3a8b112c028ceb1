// The device spacenav: how a cap moves a pose, and libspnav with a daemon that this test plays.
#include <sys/un.h>

#include <cstdlib>
#include <filesystem>

#include "device_ends.h"
#include "devices/mouse_motion.h"
#include "devices/open_device.h"
#include "support/temp_folder.h"

namespace pliant::device_test::spacenav {
namespace {

using devices::move_pose;
using devices::open_device;
using devices::parse_speeds;

TEST(MouseMotion, FullDeflectionMovesAtTheSpeedsGiven) {
  DeviceSample pose;
  for (int i = 0; i < 100; ++i) move_pose(pose, {350, -175, 350, 0, 0, 0}, 0.01, {0.2, 1});
  EXPECT_NEAR(pose.position[0], 0.2, 1e-12);
  EXPECT_NEAR(pose.position[1], -0.1, 1e-12);
  EXPECT_NEAR(pose.position[2], -0.2, 1e-12);  // away from the hand
  EXPECT_EQ(pose.turn, (std::array<double, 4>{0, 0, 0, 1}));
  move_pose(pose, {100000, 0, 0, 0, 0, 0}, 50, {0.2, 1});  // both have bounds
  EXPECT_NEAR(pose.position[0], 0.22, 1e-12);
}

TEST(MouseMotion, TurnsAreAboutTheAxesOfTheRoom) {
  DeviceSample pose;
  const double quarter = std::acos(-1.0) / 2;
  for (int i = 0; i < 100; ++i) move_pose(pose, {0, 0, 0, 350, 0, 0}, 0.01, {1, quarter});
  for (int i = 0; i < 100; ++i) move_pose(pose, {0, 0, 0, 0, 0, 350}, 0.01, {1, quarter});
  // A quarter about x, then one about -z: (0, 0, -s, c) times (s, 0, 0, c) with s = c = sqrt(1/2).
  const std::array<double, 4> want{0.5, -0.5, -0.5, 0.5};
  for (int a = 0; a < 4; ++a) EXPECT_NEAR(pose.turn[a], want[a], 1e-12) << a;
}

TEST(MouseMotion, ButtonsAndSpeedsHaveBounds) {
  DeviceSample pose;
  for (const int number : {0, 3, 31, 32, -1, 1000}) devices::press_button(pose, number, true);
  EXPECT_EQ(pose.buttons, 0x80000009U);
  devices::press_button(pose, 3, false);
  EXPECT_EQ(pose.buttons, 0x80000001U);
  const devices::MouseSpeeds speeds = parse_speeds("turn=2,linear=0.05", "t");
  EXPECT_EQ(speeds.turn, 2);
  EXPECT_EQ(speeds.linear, 0.05);
  EXPECT_EQ(parse_speeds("", "t").linear, 0.1);
  for (const char* bad :
       {"linear", "linear=", "linear=x", "linear=11", "turn=nan", "fast=1", "turn=1;", "turn=1,,", "turn=-1"}) {
    EXPECT_THROW(parse_speeds(bad, "t"), Error) << bad;
  }
}

/// spacenavd as libspnav sees it: a Unix socket that sends events of eight integers (protocol 0).
class Daemon {
 public:
  Daemon() : listening_(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const std::string path = (folder_.path() / "spnav.sock").string();
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    EXPECT_EQ(bind(listening_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(listen(listening_, 1), 0);
    setenv("SPNAV_SOCKET", path.c_str(), 1);
  }
  ~Daemon() {
    close(listening_);
    if (client_ >= 0) close(client_);
    unsetenv("SPNAV_SOCKET");
  }
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;
  void accept() { client_ = ::accept(listening_, nullptr, nullptr); }
  void send(const std::array<std::int32_t, 8>& event) const {
    EXPECT_EQ(::send(client_, event.data(), sizeof event, MSG_NOSIGNAL), static_cast<ssize_t>(sizeof event));
  }
  void leave() {
    close(client_);
    client_ = -1;
  }

 private:
  test::TempFolder folder_;
  int listening_, client_ = -1;
};

TEST(SpacenavDevice, ADaemonMovesThePose) {
  Daemon daemon;
  std::shared_ptr<HapticDevice> device;
  try {
    device = open_device("spacenav:linear=0.5,turn=1");
  } catch (const Error& error) {
    GTEST_SKIP() << error.what();
  }
  daemon.accept();
  EXPECT_EQ(device->limits().force, 0);
  EXPECT_EQ(wait_sample(*device, 3).position, (Vec3d{0, 0, 0}));
  daemon.send({1, 2, 0, 0, 0, 0, 0, 0});       // button 2 goes down
  daemon.send({0, 350, 0, 0, 0, 350, 0, 16});  // right, and about y
  EXPECT_TRUE(until([&] { return device->read().position[0] > 0.05; }));
  daemon.send({0, 0, 0, 0, 0, 0, 0, 16});
  daemon.send({2, 2, 0, 0, 0, 0, 0, 0});
  EXPECT_TRUE(until([&] { return device->read().buttons == 0; }));
  const DeviceSample still = device->read();
  EXPECT_EQ(still.position[1], 0);
  EXPECT_NEAR(2 * std::atan2(still.turn[1], still.turn[3]), 2 * still.position[0], 1e-9);  // 1 rad/s beside 0.5 m/s
  wait_sample(*device, still.number + 20);
  EXPECT_EQ(device->read().position, still.position);
  EXPECT_THROW(open_device("spacenav"), Error);  // one at a time
  daemon.leave();
  EXPECT_EQ(wait_refusal(*device, 1), "spacenavd has gone");
  wait_sample(*device, device->read().number + 20);
}

TEST(SpacenavDevice, WithoutADaemonThereIsAnErrorOfOneLine) {
  setenv("SPNAV_SOCKET", "/no/such/socket", 1);
  try {
    const auto device = open_device("spacenav");
    GTEST_SKIP() << "a spacenavd runs here";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    EXPECT_EQ(std::string(error.what()).rfind("haptic device \"spacenav\": ", 0), 0U) << error.what();
  }
  unsetenv("SPNAV_SOCKET");
}

}  // namespace
}  // namespace pliant::device_test::spacenav
