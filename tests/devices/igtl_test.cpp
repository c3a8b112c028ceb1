// The device igtl:PORT, with the OpenIGTLink library at the other end.
#include "devices/igtl.h"

#include <cstring>

#include "device_ends.h"
#include "devices/open_device.h"
#ifdef PLIANT_TEST_IGTL
#include <igtlClientSocket.h>
#include <igtlMessageHeader.h>
#include <igtlPositionMessage.h>
#include <igtlSensorMessage.h>
#include <igtlStatusMessage.h>
#include <igtlTransformMessage.h>
#include <igtl_util.h>
#endif

namespace pliant::device_test::openigtlink {
namespace {

using devices::open_device;

void put(std::string& bytes, std::uint64_t value, int size) {
  for (int i = size; i-- > 0;) bytes += static_cast<char>(value >> (8 * i));
}

/// A message of any type and body, with the right length and CRC.
std::string message(const std::string& type, const std::string& body, unsigned version = 1) {
  std::string bytes;
  put(bytes, version, 2);
  bytes += type + std::string(12 - type.size(), '\0') + "tip" + std::string(17, '\0');
  put(bytes, 0, 8);
  put(bytes, body.size(), 8);
  put(bytes, devices::igtl_crc({reinterpret_cast<const std::uint8_t*>(body.data()), body.size()}), 8);
  return bytes + body;
}

std::string floats(const std::vector<float>& values) {
  std::string bytes;
  for (const float x : values) put(bytes, std::bit_cast<std::uint32_t>(x), 4);
  return bytes;
}

std::string why_refused(const std::string& bytes, DeviceSample* out = nullptr) {
  DeviceSample sample;
  const devices::Refusal why =
      devices::read_igtl_pose({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, sample);
  if (out != nullptr) *out = sample;
  return why == nullptr ? "" : why;
}

TEST(IgtlFormat, ChecksumIsThatOfEcma182) {
  const char* digits = "123456789";  // the check value of the catalogue of parametrised CRC algorithms, CRC-64/ECMA-182
  EXPECT_EQ(devices::igtl_crc({reinterpret_cast<const std::uint8_t*>(digits), 9}), 0x6C40DF5F0B497347U);
}

TEST(IgtlFormat, MatricesBecomeMetresAndQuaternions) {
  DeviceSample sample;
  // A quarter turn about z: x becomes y, y becomes -x. Columns come one after another.
  EXPECT_EQ(why_refused(message("TRANSFORM", floats({0, 1, 0, -1, 0, 0, 0, 0, 1, 100, -200, 50})), &sample), "");
  DeviceSample want;
  want.position = {0.1, -0.2, 0.05};
  want.turn = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};
  expect_pose(sample, want, 1e-9);
  for (int axis = 0; axis < 3; ++axis) {  // half a turn about each axis
    std::vector<float> half(12, 0.0F);
    for (int a = 0; a < 3; ++a) half[4 * a] = a == axis ? 1.0F : -1.0F;
    EXPECT_EQ(why_refused(message("TRANSFORM", floats(half)), &sample), "");
    EXPECT_EQ(sample.turn[axis], 1);
  }
}

TEST(IgtlFormat, GarbageIsRefused) {
  const std::string good = message("TRANSFORM", floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 2, 3}));
  EXPECT_EQ(why_refused(good), "");
  EXPECT_EQ(why_refused(good.substr(0, 57)), "a message of less than 58 bytes");
  EXPECT_EQ(why_refused(good.substr(0, 100)), "a body that is not as long as its header says");
  EXPECT_EQ(why_refused(message("STATUS", "")), "a message that is no TRANSFORM, POSITION or QTRANS");
  EXPECT_EQ(why_refused(message("TRANSFORM", "", 3)), "an OpenIGTLink header of another version than 1 and 2");
  std::string bad = good;
  bad[70] ^= 1;
  EXPECT_EQ(why_refused(bad), "a body whose CRC is wrong");
  EXPECT_EQ(why_refused(message("TRANSFORM", floats({1, 0, 0}))), "a TRANSFORM that is not of 48 bytes");
  const auto transform = [](std::vector<float> values) { return why_refused(message("TRANSFORM", floats(values))); };
  EXPECT_EQ(transform({1.01F, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), "a rotation whose axes are not orthonormal");
  EXPECT_EQ(transform({1, 0, 0, 0.01F, 1, 0, 0, 0, 1, 0, 0, 0}), "a rotation whose axes are not orthonormal");
  EXPECT_EQ(transform({NAN, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), "a rotation whose axes are not orthonormal");
  EXPECT_EQ(transform({-1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), "a rotation that mirrors");
  EXPECT_EQ(transform({1, 0, 0, 0, 1, 0, 0, 0, 1, INFINITY, 0, 0}), "a position that is not finite");
  EXPECT_EQ(transform({1, 0, 0, 0, 1, 0, 0, 0, 1, 2e6F, 0, 0}), "a position beyond 1000 m");
  EXPECT_EQ(why_refused(message("POSITION", floats({1, 2, 3, 4}))), "a POSITION that is not of 12, 24 or 28 bytes");
  EXPECT_EQ(why_refused(message("POSITION", floats({1, 2, 3, 0, 0, 0, 0.9F}))), "a quaternion that is not of unit length");
  EXPECT_EQ(why_refused(message("QTRANS", floats({1, 2, 3, 0, 0, 0, 1}))), "");
  for (const std::uint64_t head : {0x000CFFFF00000000U, 0x0008000000000000U, 0x000C0000FFFFFFFFU}) {
    std::string body;
    put(body, head, 8);
    EXPECT_EQ(why_refused(message("TRANSFORM", body + std::string(52, '\0'), 2)),
              "an extended header that does not fit its body");
  }
}

TEST(IgtlFormat, ExtendedHeadersAndMetaDataAreLeftOut) {
  const std::string content = floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 100, 0, 0});
  std::string body;
  put(body, 0x000E000600000004U, 8);  // 14 bytes of extended header, 6 and 4 of meta data
  body += "idno" + std::string("\0\7", 2) + content + "header" + "data";
  DeviceSample sample;
  EXPECT_EQ(why_refused(message("TRANSFORM", body, 2), &sample), "");
  EXPECT_NEAR(sample.position[0], 0.1, 1e-9);
}

TEST(IgtlFormat, AStreamIsCutWhereverItsPiecesEnd) {
  const std::string first = message("TRANSFORM", floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 2, 3}));
  const std::string bytes = first + message("IMAGE", std::string(10000, 'x')) + message("STATUS", "") + first;
  for (const std::size_t piece : {1U, 7U, 58U, 1000U, 100000U}) {
    devices::IgtlStream stream;
    int messages = 0, poses = 0, refused = 0;
    for (std::size_t from = 0; from < bytes.size(); from += piece) {
      devices::Bytes rest(reinterpret_cast<const std::uint8_t*>(bytes.data()) + from, std::min(piece, bytes.size() - from));
      while (!rest.empty()) {
        devices::Bytes whole;
        devices::Refusal why = nullptr;
        const std::size_t taken = stream.take(rest, whole, why);
        ASSERT_TRUE(taken > 0 && taken <= rest.size());
        rest = rest.subspan(taken);
        DeviceSample sample;
        messages += whole.empty() ? 0 : 1;
        poses += !whole.empty() && devices::read_igtl_pose(whole, sample) == nullptr ? 1 : 0;
        refused += why != nullptr ? 1 : 0;
      }
    }
    EXPECT_EQ(messages, 3) << piece;
    EXPECT_EQ(poses, 2) << piece;
    EXPECT_EQ(refused, 1) << piece;
  }
}

TEST(IgtlDevice, WhatIsNotOpenIgtlinkLosesItsConnection) {
  const auto device = open_device("igtl:0");
  const Peer stranger(device->port(), SOCK_STREAM);
  const std::string text = "GET / HTTP/1.1\r\nHost: localhost\r\nUser-Agent: somebody's browser, or another\r\n\r\n";
  stranger.send(text.data(), text.size());
  EXPECT_TRUE(stranger.receive().empty());
  EXPECT_EQ(wait_refusal(*device, 1), "a body of more than 4096 bytes");
  const Peer client(device->port(), SOCK_STREAM);
  const std::string pose = message("POSITION", floats({10, 20, 30}));
  client.send(pose.data(), 30);
  client.send(pose.data() + 30, pose.size() - 30);
  EXPECT_NEAR(wait_sample(*device, 1).position[2], 0.03, 1e-9);
}

TEST(IgtlDevice, ANewClientTakesThePlaceOfTheOneBefore) {
  const auto device = open_device("igtl:0");
  const std::string pose = message("POSITION", floats({10, 20, 30}));
  const Peer first(device->port(), SOCK_STREAM);
  first.send(pose.data(), pose.size());
  wait_sample(*device, 1);
  const Peer second(device->port(), SOCK_STREAM);
  second.send(pose.data(), pose.size());
  const DeviceSample sample = wait_sample(*device, 2);
  EXPECT_TRUE(first.receive().empty());
  device->write(wrench_for(sample));
  EXPECT_EQ(second.receive().size(), devices::kIgtlWrenchSize);
}

#ifdef PLIANT_TEST_IGTL

/// Row-major 4 x 4 with the translation in mm.
void matrix_of(const DeviceSample& s, igtl::Matrix4x4& m) {
  const auto [x, y, z, w] = s.turn;
  const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                          {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                          {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) m[i][j] = i < 3 && j < 3 ? static_cast<float>(r[i][j]) : i == j ? 1.0F : 0.0F;
  }
  for (int i = 0; i < 3; ++i) m[i][3] = static_cast<float>(1000 * s.position[i]);
}

void expect_wrench(igtl::ClientSocket& socket, const DeviceWrench& want) {
  const auto header = igtl::MessageHeader::New();
  header->InitPack();
  ASSERT_EQ(socket.Receive(header->GetPackPointer(), static_cast<int>(header->GetPackSize())),
            static_cast<int>(header->GetPackSize()));
  header->Unpack();
  EXPECT_STREQ(header->GetDeviceType(), "SENSOR");
  EXPECT_STREQ(header->GetDeviceName(), "PliantWrench");
  auto stamp = igtl::TimeStamp::New();
  header->GetTimeStamp(stamp);
  EXPECT_NEAR(stamp->GetTimeStamp(), want.time, 1e-6);
  const auto sensor = igtl::SensorMessage::New();
  sensor->SetMessageHeader(header);
  sensor->AllocatePack();
  socket.Receive(sensor->GetPackBodyPointer(), static_cast<int>(sensor->GetPackBodySize()));
  ASSERT_NE(sensor->Unpack(1) & igtl::MessageHeader::UNPACK_BODY, 0);  // 1: the CRC is checked
  ASSERT_EQ(sensor->GetLength(), 6U);
  for (unsigned a = 0; a < 3; ++a) {
    EXPECT_EQ(sensor->GetValue(a), want.force[a]);
    EXPECT_EQ(sensor->GetValue(a + 3), want.torque[a]);
  }
}

TEST(IgtlDevice, TheLibrarySendsPosesAndReceivesWrenches) {
  const auto device = open_device("igtl:0"), other = open_device("igtl:0");
  const auto socket = igtl::ClientSocket::New();
  ASSERT_EQ(socket->ConnectToServer("127.0.0.1", device->port()), 0);
  std::uint64_t number = 0;
  for (int i = 0; i < 12; ++i) {
    DeviceSample want = pose_at(i);
    auto stamp = igtl::TimeStamp::New();
    stamp->SetTime(want.time);
    if (i % 2 == 0) {
      const auto transform = igtl::TransformMessage::New();
      igtl::Matrix4x4 matrix;
      matrix_of(want, matrix);
      transform->SetDeviceName("tip");
      transform->SetMatrix(matrix);
      transform->SetTimeStamp(stamp);
      transform->Pack();
      socket->Send(transform->GetPackPointer(), static_cast<int>(transform->GetPackSize()));
    } else {
      const auto position = igtl::PositionMessage::New();
      position->SetPackType(igtl::PositionMessage::ALL);  // the library of Debian 12 writes out of bounds with the others
      const auto mm = [&](int a) { return static_cast<float>(1000 * want.position[a]); };
      const auto q = [&](int a) { return static_cast<float>(want.turn[a]); };
      position->SetPosition(mm(0), mm(1), mm(2));
      position->SetQuaternion(q(0), q(1), q(2), q(3));
      position->SetTimeStamp(stamp);
      position->Pack();
      socket->Send(position->GetPackPointer(), static_cast<int>(position->GetPackSize()));
    }
    const DeviceSample sample = wait_sample(*device, ++number);
    const double sign = sample.turn[3] * want.turn[3] < 0 ? -1 : 1;
    for (double& q : want.turn) q *= sign;
    expect_pose(sample, want, 1e-6);
    EXPECT_NEAR(sample.time, want.time, 1e-6);
    device->write(wrench_for(sample));
    expect_wrench(*socket, wrench_for(sample));
  }
  const auto status = igtl::StatusMessage::New();
  status->Pack();
  socket->Send(status->GetPackPointer(), static_cast<int>(status->GetPackSize()));
  EXPECT_EQ(wait_refusal(*device, 1), "a message that is no TRANSFORM, POSITION or QTRANS");
  EXPECT_EQ(other->counts().received, 0U);
  socket->CloseSocket();
}

#else
TEST(IgtlDevice, TheLibrarySendsPosesAndReceivesWrenches) {
  GTEST_SKIP() << "OpenIGTLink (libopenigtlink-dev) was not found when this was built";
}
#endif

}  // namespace
}  // namespace pliant::device_test::openigtlink
