// The device udp:PORT over the loopback, and its packets.
#include <cstring>
#include <limits>

#include "device_ends.h"
#include "devices/datagram_device.h"
#include "devices/open_device.h"
#include "devices/packet.h"

namespace pliant::device_test::udp {
namespace {

using devices::open_device;

pliant_haptic_pose packet_of(const DeviceSample& sample) {
  pliant_haptic_pose pose{};
  pose.magic = PLIANT_HAPTIC_POSE_MAGIC;
  pose.version = PLIANT_HAPTIC_VERSION;
  pose.size = sizeof pose;
  pose.buttons = sample.buttons;
  pose.number = sample.number;
  pose.stamp = sample.time;
  for (int a = 0; a < 3; ++a) pose.position[a] = sample.position[a];
  for (int a = 0; a < 4; ++a) pose.turn[a] = sample.turn[a];
  return pose;
}

std::string why_refused(const pliant_haptic_pose& pose, std::size_t size = sizeof(pliant_haptic_pose)) {
  std::vector<std::uint8_t> bytes(size);
  std::memcpy(bytes.data(), &pose, std::min(size, sizeof pose));
  DeviceSample sample;
  const devices::Refusal why = devices::read_pose(bytes, sample);
  return why == nullptr ? "" : why;
}

TEST(UdpPacket, BytesAreAsDocumented) {
  const pliant_haptic_pose pose = packet_of(pose_at(3));
  std::array<std::uint8_t, sizeof pose> bytes;
  std::memcpy(bytes.data(), &pose, sizeof pose);
  const std::array<std::uint8_t, 16> head{'P', 'L', 'H', 'P', 1, 0, 0, 0, 88, 0, 0, 0, 3, 0, 0, 0};
  EXPECT_TRUE(std::equal(head.begin(), head.end(), bytes.begin()));
  DeviceSample sample;
  EXPECT_EQ(devices::read_pose(bytes, sample), nullptr);
  expect_pose(sample, pose_at(3));
  EXPECT_EQ(sample.time, pose_at(3).time);
  EXPECT_EQ(sample.number, 4U);
  EXPECT_EQ(sample.buttons, 3U);
  const pliant_haptic_wrench wrench = devices::wrench_packet(wrench_for(sample));
  EXPECT_EQ(std::memcmp(&wrench, "PLHW\1\0\0\0\x50\0\0\0\0\0\0\0\4\0\0\0\0\0\0\0", 24), 0);
  EXPECT_EQ(wrench.torque[2], -0.04);
}

TEST(UdpPacket, GarbageIsRefused) {
  const pliant_haptic_pose good = packet_of(pose_at(1));
  EXPECT_EQ(why_refused(good), "");
  EXPECT_EQ(why_refused(good, 87), "a packet that is not of 88 bytes");
  EXPECT_EQ(why_refused(good, 89), "a packet that is not of 88 bytes");
  pliant_haptic_pose bad = good;
  bad.magic = PLIANT_HAPTIC_WRENCH_MAGIC;
  EXPECT_EQ(why_refused(bad), "a packet that does not begin with PLHP");
  bad = good;
  bad.version = 2;
  EXPECT_EQ(why_refused(bad), "a packet of another version than 1");
  bad = good;
  bad.size = 80;
  EXPECT_EQ(why_refused(bad), "a packet whose size is not 88");
  bad = good;
  bad.number = 0;
  EXPECT_EQ(why_refused(bad), "a packet with the number 0");
  for (const double x : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e300}) {
    for (int a = 0; a < 8; ++a) {
      bad = good;
      (a == 7 ? bad.stamp : a < 3 ? bad.position[a] : bad.turn[a - 3]) = x;
      if (a == 7 && std::isfinite(x)) continue;
      EXPECT_NE(why_refused(bad), "") << a << " " << x;
    }
  }
}

TEST(UdpPacket, QuaternionsNearUnitLengthAreMadeSo) {
  for (const double length : {1 - 0.9e-3, 1 + 0.9e-3, 1 - 1.1e-3, 1 + 1.1e-3, 0.0}) {
    pliant_haptic_pose pose = packet_of(pose_at(5));
    for (double& q : pose.turn) q *= length;
    std::array<std::uint8_t, sizeof pose> bytes;
    std::memcpy(bytes.data(), &pose, sizeof pose);
    DeviceSample sample;
    const devices::Refusal why = devices::read_pose(bytes, sample);
    if (std::abs(length - 1) < 1e-3) {
      ASSERT_EQ(why, nullptr);
      expect_pose(sample, pose_at(5));
    } else {
      EXPECT_STREQ(why, "a quaternion that is not of unit length");
    }
  }
}

TEST(UdpDevice, PosesComeInAndWrenchesGoBackToTheSender) {
  const auto device = open_device("udp:0");
  EXPECT_GT(device->port(), 0);
  EXPECT_EQ(device->read().number, 0U);
  device->write(wrench_for({}));  // nobody has sent anything: lost
  const Peer driver(device->port(), SOCK_DGRAM);
  for (int i = 0; i < 20; ++i) {
    DeviceSample sent = pose_at(i);
    sent.number += 700;  // the driver's own numbers
    sent.time -= 100;    // and its own clock, from 0
    const pliant_haptic_pose pose = packet_of(sent);
    driver.send(&pose, sizeof pose);
    const DeviceSample sample = wait_sample(*device, static_cast<std::uint64_t>(i + 1));
    expect_pose(sample, sent);
    EXPECT_EQ(sample.time, sent.time);
    EXPECT_EQ(sample.buttons, sent.buttons);
    EXPECT_EQ(sample.number, static_cast<std::uint64_t>(i + 1));
    device->write(wrench_for(sample));
    const std::vector<std::uint8_t> bytes = driver.receive();
    ASSERT_EQ(bytes.size(), sizeof(pliant_haptic_wrench));
    pliant_haptic_wrench wrench;
    std::memcpy(&wrench, bytes.data(), sizeof wrench);
    EXPECT_EQ(wrench.number, sent.number);
    EXPECT_EQ(wrench.stamp, sent.time);
    EXPECT_EQ(wrench.force[1], -2.5);
  }
  EXPECT_EQ(device->counts().received, 20U);
  EXPECT_EQ(device->counts().refused, 0U);
}

TEST(UdpDevice, GoesOnAfterGarbage) {
  const auto device = open_device("udp:127.0.0.1:0");
  const Peer driver(device->port(), SOCK_DGRAM);
  const std::vector<std::uint8_t> garbage(3000, 7);
  driver.send(garbage.data(), garbage.size());
  EXPECT_EQ(wait_refusal(*device, 1), "a datagram of more than 2048 bytes");
  driver.send(garbage.data(), 88);
  EXPECT_EQ(wait_refusal(*device, 2), "a packet that does not begin with PLHP");
  driver.send(garbage.data(), 0);
  EXPECT_EQ(wait_refusal(*device, 3), "a packet that is not of 88 bytes");
  pliant_haptic_pose pose = packet_of(pose_at(9));
  driver.send(&pose, sizeof pose);
  wait_sample(*device, 1);
  pose = packet_of(pose_at(8));  // overtaken on the way
  driver.send(&pose, sizeof pose);
  EXPECT_EQ(wait_refusal(*device, 4), "a datagram that is not newer than the newest");
  pose = packet_of(pose_at(0));  // the driver starts anew
  driver.send(&pose, sizeof pose);
  expect_pose(wait_sample(*device, 2), pose_at(0));
  EXPECT_EQ(device->counts().received, 2U);
}

TEST(UdpDevice, TwoAtOnceKeepApart) {
  const auto left = open_device("udp:0"), right = open_device("udp:0");
  ASSERT_NE(left->port(), right->port());
  const Peer left_driver(left->port(), SOCK_DGRAM), right_driver(right->port(), SOCK_DGRAM);
  const pliant_haptic_pose one = packet_of(pose_at(1)), two = packet_of(pose_at(2));
  left_driver.send(&one, sizeof one);
  right_driver.send(&two, sizeof two);
  expect_pose(wait_sample(*left, 1), pose_at(1));
  expect_pose(wait_sample(*right, 1), pose_at(2));
  right->write(wrench_for(right->read()));
  EXPECT_EQ(right_driver.receive().size(), sizeof(pliant_haptic_wrench));
  EXPECT_EQ(left->counts().received, 1U);
}

TEST(OpenDevice, OtherTextsAreRefusedWithWhatIsAllowed) {
  const auto error_of = [](const std::string& text) -> std::string {
    try {
      open_haptic_device(text);
    } catch (const Error& error) {
      return std::to_string(static_cast<int>(error.code())) + " " + error.what();
    }
    return "";
  };
  EXPECT_EQ(error_of("udp:"), "5 haptic device \"udp:\": expected udp:PORT");
  EXPECT_EQ(error_of("udp"), "5 haptic device \"udp\": expected udp:PORT");
  EXPECT_EQ(error_of("udp:65536").rfind("5 haptic device \"udp:65536\": got \"65536\", expected a port from 0 to 65535", 0),
            0U);
  EXPECT_NE(error_of("udp:-1"), "");
  EXPECT_NE(error_of("udp:localhost:80"), "");
  EXPECT_EQ(error_of("omega:1").rfind("5 haptic device \"omega:1\": there is no kind \"omega\"; allowed are ", 0), 0U);
  EXPECT_NE(error_of("omega:1").find("udp:PORT"), std::string::npos);
  EXPECT_NE(error_of("").find("there is no kind \"\""), std::string::npos);
  const auto device = open_device("udp:0");
  const std::string taken = "udp:" + std::to_string(device->port());
  EXPECT_EQ(error_of(taken).rfind("2 haptic device \"" + taken + "\": cannot listen on 127.0.0.1:", 0), 0U) << error_of(taken);
}

}  // namespace
}  // namespace pliant::device_test::udp
