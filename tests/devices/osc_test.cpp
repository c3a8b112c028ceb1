// The device osc:PORT, with liblo at the other end.
#include "devices/osc.h"

#include <cstring>

#include "device_ends.h"
#include "devices/open_device.h"
#ifdef PLIANT_TEST_LIBLO
#include <lo/lo.h>
#endif

namespace pliant::device_test::osc {
namespace {

using devices::open_device;

std::string padded(std::string text) {
  text.append(4 - text.size() % 4, '\0');
  return text;
}

/// /pliant/pose at (0, 0, 0) without a turn, by hand.
std::string message(const std::string& address = "/pliant/pose", const std::string& types = ",fffffff") {
  return padded(address) + padded(types) + std::string(24, '\0') + std::string("\x3f\x80\0\0", 4);
}

std::string bundle(const std::vector<std::string>& messages) {
  std::string bytes = std::string("#bundle\0\0\0\0\0\0\0\0\1", 16);
  for (const std::string& m : messages) bytes += std::string(3, '\0') + static_cast<char>(m.size()) + m;
  return bytes;
}

std::string why_refused(const std::string& bytes) {
  DeviceSample sample;
  const devices::Refusal why =
      devices::read_osc_pose({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, sample);
  return why == nullptr ? "" : why;
}

TEST(OscFormat, OtherMessagesAreRefused) {
  EXPECT_EQ(why_refused(message()), "");
  EXPECT_EQ(why_refused(""), "a datagram that is no OSC message");
  EXPECT_EQ(why_refused("/pliant/pose"), "a datagram that is no OSC message");
  EXPECT_EQ(why_refused(message("/pliant/poses")), "an OSC message that is not /pliant/pose");
  for (const char* types : {",ffffff", ",ffffffff", ",ffffffi", "fffffff", ",fffffffii", ",fffsfff"}) {
    EXPECT_EQ(why_refused(message("/pliant/pose", types)), "/pliant/pose without seven numbers and perhaps an integer")
        << types;
  }
  EXPECT_EQ(why_refused(message("/pliant/pose", ",fffffffi")), "/pliant/pose whose length is not that of its types");
  EXPECT_EQ(why_refused(message() + "1234"), "/pliant/pose whose length is not that of its types");
  EXPECT_EQ(why_refused(padded("/pliant/pose") + padded(",fffffff") + std::string(28, '\0')),
            "a quaternion that is not of unit length");
  EXPECT_EQ(why_refused(padded("/pliant/pose") + padded(",fffffff") + "\x7f\xc0" + std::string(26, '\0')),
            "a position that is not finite");
}

TEST(OscFormat, OfABundleTheLastPoseCounts) {
  const std::string other = padded("/other") + padded(",");
  EXPECT_EQ(why_refused(bundle({message()})), "");
  EXPECT_EQ(why_refused(bundle({other, message(), other})), "");
  EXPECT_EQ(why_refused(bundle({})), "an OSC bundle without /pliant/pose");
  EXPECT_EQ(why_refused(bundle({other})), "an OSC message that is not /pliant/pose");
  EXPECT_EQ(why_refused(bundle({bundle({message()})})), "a datagram that is no OSC message");
  const std::string whole = bundle({message()});
  EXPECT_EQ(why_refused(whole.substr(0, whole.size() - 1)), "an OSC bundle that ends within a message");
  EXPECT_EQ(why_refused(whole.substr(0, 12)), "an OSC bundle that ends within its time");
}

#ifdef PLIANT_TEST_LIBLO

/// liblo at the other end: it sends from the port at which it receives.
class Liblo {
 public:
  explicit Liblo(int port) : server_(lo_server_new(nullptr, nullptr)) {
    address_ = lo_address_new("127.0.0.1", std::to_string(port).c_str());
    lo_server_add_method(server_, "/pliant/wrench", "ffffff", keep, this);
  }
  ~Liblo() {
    lo_address_free(address_);
    lo_server_free(server_);
  }
  Liblo(const Liblo&) = delete;
  Liblo& operator=(const Liblo&) = delete;
  void send(const DeviceSample& s, bool doubles) const {
    lo_message m = lo_message_new();
    for (int i = 0; i < 7; ++i) {
      const double x = i < 3 ? s.position[i] : s.turn[i - 3];
      doubles ? lo_message_add_double(m, x) : lo_message_add_float(m, static_cast<float>(x));
    }
    if (s.buttons != 0) lo_message_add_int32(m, static_cast<std::int32_t>(s.buttons));
    lo_send_message_from(address_, server_, "/pliant/pose", m);
    lo_message_free(m);
  }
  std::vector<float> receive() {
    got_.clear();
    lo_server_recv_noblock(server_, 20000);
    return got_;
  }

 private:
  static int keep(const char*, const char*, lo_arg** values, int count, lo_message, void* self) {
    for (int i = 0; i < count; ++i) {
      float value = 0;
      std::memcpy(&value, values[i], sizeof value);  // liblo does not align them
      static_cast<Liblo*>(self)->got_.push_back(value);
    }
    return 0;
  }
  lo_server server_;
  lo_address address_;
  std::vector<float> got_;
};

TEST(OscDevice, LibloSendsPosesAndReceivesWrenches) {
  const auto device = open_device("osc:0"), other = open_device("osc:0");
  Liblo liblo(device->port());
  for (int i = 0; i < 8; ++i) {
    const bool doubles = i >= 4;
    liblo.send(pose_at(i), doubles);
    const DeviceSample sample = wait_sample(*device, static_cast<std::uint64_t>(i + 1));
    expect_pose(sample, pose_at(i), doubles ? 0 : 1e-6);
    EXPECT_EQ(sample.buttons, pose_at(i).buttons);
    EXPECT_GT(sample.time, 0);
    device->write(wrench_for(sample));
    const std::vector<float> want{1.25F, -2.5F, 0.3F, 0.01F, 0.02F, -0.04F};
    EXPECT_EQ(liblo.receive(), want);
  }
  EXPECT_EQ(device->counts().refused, 0U);
  EXPECT_EQ(other->counts().received, 0U);
}

#else
TEST(OscDevice, LibloSendsPosesAndReceivesWrenches) { GTEST_SKIP() << "liblo (liblo-dev) was not found when this was built"; }
#endif

}  // namespace
}  // namespace pliant::device_test::osc
