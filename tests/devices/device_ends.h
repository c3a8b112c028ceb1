// What tests of devices share: waiting, poses that differ in every number, and the other end of a socket.
#pragma once
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "pliant/error.h"
#include "pliant/haptic_device.h"

namespace pliant::device_test {

/// Waits for a condition, at most 20 s: other programs may keep a thread waiting.
inline bool until(const std::function<bool()>& holds) {
  for (int i = 0; i < 20000; ++i) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return holds();
}

/// Waits for sample number `number` or a later one.
inline DeviceSample wait_sample(HapticDevice& device, std::uint64_t number) {
  DeviceSample sample;
  EXPECT_TRUE(until([&] { return (sample = device.read()).number >= number; })) << "no sample " << number;
  return sample;
}

/// Waits until `number` messages were refused and returns why the last one was.
inline std::string wait_refusal(const HapticDevice& device, std::uint64_t number) {
  EXPECT_TRUE(until([&] { return device.counts().refused >= number; })) << "no refusal " << number;
  return device.counts().last_refusal;
}

/// Pose i of a motion: no two numbers are the same, and none has few digits.
inline DeviceSample pose_at(int i) {
  DeviceSample sample;
  const double t = 0.1 * i;
  sample.position = {0.05 * std::sin(t) + 0.01, 0.04 * std::cos(t), 0.03 * std::sin(2 * t + 1)};
  const double half = 0.3 * std::sin(t) + 0.2;
  sample.turn = {std::sin(half) * 0.6, -std::sin(half) * 0.8 * std::cos(t), std::sin(half) * 0.8 * std::sin(t), std::cos(half)};
  sample.time = 100 + t;
  sample.buttons = static_cast<std::uint32_t>(i % 4);
  sample.number = static_cast<std::uint64_t>(i + 1);
  return sample;
}

inline void expect_pose(const DeviceSample& got, const DeviceSample& want, double tolerance = 0) {
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(got.position[a], want.position[a], tolerance);
  for (int a = 0; a < 4; ++a) EXPECT_NEAR(got.turn[a], want.turn[a], tolerance > 1e-15 ? tolerance : 1e-15);
}

/// The answer to a sample.
inline DeviceWrench wrench_for(const DeviceSample& sample) {
  DeviceWrench wrench;
  wrench.force = {1.25, -2.5, 0.3};
  wrench.torque = {0.01, 0.02, -0.04};
  wrench.time = sample.time;
  wrench.number = sample.number;
  return wrench;
}

/// A socket on this machine's loopback, connected to a port.
class Peer {
 public:
  Peer(int port, int kind) : handle_(socket(AF_INET, kind | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(handle_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~Peer() { close(handle_); }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  void send(const void* bytes, std::size_t size) const {
    EXPECT_EQ(::send(handle_, bytes, size, MSG_NOSIGNAL), static_cast<ssize_t>(size));
  }
  /// Waits for bytes, at most 20 s; empty: none came, or the other end has closed.
  [[nodiscard]] std::vector<std::uint8_t> receive() const {
    pollfd waiting{handle_, POLLIN, 0};
    poll(&waiting, 1, 20000);
    std::vector<std::uint8_t> bytes(4096);
    const ssize_t got = recv(handle_, bytes.data(), bytes.size(), MSG_DONTWAIT);
    bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    return bytes;
  }

 private:
  int handle_;
};

}  // namespace pliant::device_test
