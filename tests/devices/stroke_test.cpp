// Recorded strokes: the file, the device that plays it, and the log that writes it.
#include "devices/stroke.h"

#include <random>

#include "device_ends.h"
#include "devices/device_log.h"
#include "devices/open_device.h"
#include "devices/stroke_device.h"
#include "support/error_of.h"
#include "support/temp_folder.h"

namespace pliant::device_test::stroke {
namespace {

using devices::DeviceLog;
using devices::parse_stroke;

constexpr const char* kHead = "time,x,y,z,qx,qy,qz,qw,buttons\n";

void expect_same_bits(const DeviceSample& a, const DeviceSample& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.turn, b.turn);
  EXPECT_EQ(a.buttons, b.buttons);
}

TEST(Stroke, AWrittenLogComesBackWithTheSameBits) {
  const test::TempFolder folder;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> in(-1, 1);
  DeviceLog log(1000);
  double time = 0;
  for (int i = 0; i < 1200; ++i) {
    DeviceSample sample = pose_at(i);
    for (double& x : sample.position) x = in(random)*std::pow(10.0, -static_cast<double>(i % 20));
    double square = 0;
    for (double& q : sample.turn) {
      q = in(random);
      square += q * q;
    }
    for (double& q : sample.turn) q /= std::sqrt(square);
    time += 1e-3 + 1e-4 * in(random);
    sample.time = time;
    log.append(sample);
  }
  EXPECT_EQ(log.samples().size(), 1000U);
  EXPECT_EQ(log.left_out(), 200U);
  const auto file = folder.path() / "stroke.csv";
  log.write_csv(file);
  const std::vector<DeviceSample> back = devices::read_stroke(file);
  ASSERT_EQ(back.size(), 1000U);
  for (std::size_t i = 0; i < back.size(); ++i) expect_same_bits(back[i], log.samples()[i]);
  EXPECT_EQ(back.back().number, 1000U);
}

TEST(Stroke, ADeviceThatIsRecordedPlaysAgain) {
  const test::TempFolder folder;
  const auto file =
      folder.write("a.csv", "time,x,y,z,qx,qy,qz,qw,buttons\n# comment\n10,0.1,0,0,0,0,0,1,0\n\n10.02,0.2,0,0,0,0,0,1,2\r\n");
  const auto log = std::make_shared<DeviceLog>(10);
  devices::RecordedDevice device(devices::open_device("file:" + file.string()), log);
  EXPECT_EQ(device.read().position[0], 0.1);
  device.write({});
  EXPECT_TRUE(until([&] { return device.read().number == 2; }));
  EXPECT_EQ(device.read().buttons, 2U);
  ASSERT_EQ(log->samples().size(), 2U);  // each once
  expect_same_bits(log->samples()[0], devices::read_stroke(file)[0]);
  EXPECT_EQ(device.counts().received, 2U);
}

TEST(Stroke, PlaysInItsOwnTime) {
  std::vector<DeviceSample> samples(3);
  for (int i = 0; i < 3; ++i) samples[i].time = 5 + i, samples[i].number = i + 1;
  const devices::StrokeDevice device(samples);
  EXPECT_EQ(device.after(0).number, 1U);
  EXPECT_EQ(device.after(0.999).number, 1U);
  EXPECT_EQ(device.after(1).number, 2U);
  EXPECT_EQ(device.after(1e9).number, 3U);
}

TEST(Stroke, ClocksThatJumpBackAreLeftOutOfTheFile) {
  const test::TempFolder folder;
  DeviceLog log(10);
  for (const double time : {1.0, 2.0, 1.5, 2.0, 3.0}) {
    DeviceSample sample;
    sample.time = time;
    log.append(sample);
  }
  log.write_csv(folder.path() / "a.csv");
  EXPECT_EQ(devices::read_stroke(folder.path() / "a.csv").size(), 3U);
}

TEST(Stroke, BadFilesAreRefusedByLine) {
  const auto why = [](const std::string& text) { return test::error_of([&] { parse_stroke(text, "a.csv"); }); };
  const std::string head = kHead;
  EXPECT_EQ(why(""), "a.csv:0: there is no sample; expected a line \"time,x,y,z,qx,qy,qz,qw,buttons\" and samples after it");
  EXPECT_EQ(why("time,x\n"), "a.csv:1: expected the first line \"time,x,y,z,qx,qy,qz,qw,buttons\"");
  EXPECT_NE(why(head), "");
  EXPECT_EQ(why(head + "0,0,0,0,0,0,0,1\n"), "a.csv:2: expected nine numbers separated by commas");
  for (const char* line : {"0,0,0,0,0,0,0,1,1.5", "0,0,0,0,0,0,0,1,-1", "0,0,0,0,0,0,0,1,0,0"}) {
    EXPECT_EQ(why(head + line), "a.csv:2: expected nine numbers, the last a whole one from 0 to 4294967295") << line;
  }
  EXPECT_EQ(why(head + "0,nan,0,0,0,0,0,1,0"), "a.csv:2: a position that is not finite");
  EXPECT_EQ(why(head + "inf,0,0,0,0,0,0,1,0"), "a.csv:2: a time that is not finite");
  EXPECT_EQ(why(head + "0,0,0,0,0,0,0,2,0"), "a.csv:2: a quaternion that is not of unit length");
  EXPECT_EQ(why(head + "1,0,0,0,0,0,0,1,0\n1,0,0,0,0,0,0,1,0"), "a.csv:3: the time 1 does not follow 1: times must increase");
  try {
    devices::open_device("file:/no/such/stroke.csv");
    ADD_FAILURE() << "opened a file that is not there";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::io);
    EXPECT_NE(std::string(error.what()).find("/no/such/stroke.csv"), std::string::npos);
  }
}

}  // namespace
}  // namespace pliant::device_test::stroke
