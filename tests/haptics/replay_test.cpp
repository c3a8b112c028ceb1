// Lockstep with devices and the log of drives: what reaches the simulation, and that the log gives the same bits, also through
// the bare calls of the simulation.
#include "haptics/replay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "backends/choice/backends.h"
#include "devices/stroke_device.h"
#include "geometry/vec.h"
#include "haptics/lockstep.h"
#include "pliant/error.h"
#include "support/source_dir.h"

namespace pliant::haptics::replay_test {
namespace {

constexpr double kRate = 512;

Scene block_and_ball() {
  const std::string text = R"({"format": "pliant-scene/1", "duration": 2, "gravity": [0, 0, 0], "bodies": [{"name": "cube",
    "surface": ")" + test::source_dir() +
                           R"(/scenes/meshes/cube.obj", "lattice": {"spacing": 0.02}, "element": "hex8",
    "material": {"law": "neo-hookean", "young": 5000, "poisson": 0.4, "density": 1000, "damping": 20},
    "fixed": [{"plane": [[0, -0.049, 0], [0, -1, 0]]}]}],
    "tools": [{"name": "ball", "shape": {"sphere": 0.015}, "path": [[0, 0, 0.067, 0]]}]})";
  return parse_scene(text, "cube.json");
}

std::vector<DeviceSample> stroke(int samples) {
  std::vector<DeviceSample> out;
  for (int k = 0; k <= samples; ++k) {
    DeviceSample s;
    s.time = 3 + k / kRate;
    s.position = {0.001 * k / samples, -0.012 * std::sin(3.0 * k / samples), 0};
    s.number = static_cast<std::uint64_t>(k) + 1;
    out.push_back(s);
  }
  return out;
}

/// As the command does it.
void run(Simulation& s, RunGuide& guide) {
  while (!s.divergence()) {
    const std::int64_t left = guide.steps_left(s);
    if (left > 0) {
      s.advance(s.next_batch(left));
    } else if (!guide.next(s)) {
      return;
    }
  }
}

/// Keeps what it is told, and passes it to a stroke.
class Listening final : public HapticDevice {
 public:
  explicit Listening(std::vector<DeviceSample> samples) : stroke_(std::move(samples)) { stroke_.step_by_answers(); }
  DeviceSample read() noexcept override { return stroke_.read(); }
  void write(const DeviceWrench& wrench) noexcept override {
    heard.push_back(wrench);
    stroke_.write(wrench);
  }
  [[nodiscard]] DeviceLimits limits() const noexcept override { return {0.02, 0.001}; }
  std::vector<DeviceWrench> heard;

 private:
  devices::StrokeDevice stroke_;
};

TEST(Lockstep, EverySampleIsAnsweredAtItsTime) {
  Simulation s(block_and_ball(), open_backend("cpu"));
  const std::vector<DeviceSample> samples = stroke(60);
  const auto device = std::make_shared<Listening>(samples);
  DriveLog log;
  Lockstep lockstep(s, {{"ball", device}}, {.patience = 0.05, .stop = {}, .remark = {}}, log);
  run(s, lockstep);
  ASSERT_EQ(device->heard.size(), samples.size());
  double most = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    EXPECT_EQ(device->heard[k].number, samples[k].number);
    EXPECT_EQ(device->heard[k].time, samples[k].time);
    most = std::max(most, vec::norm(device->heard[k].force));
  }
  EXPECT_NEAR(most, 0.02, 1e-12) << "the limit of the device, or nothing was touched";
  EXPECT_EQ(lockstep.counts(0).largest_force, most);
  EXPECT_EQ(lockstep.counts(0).samples, 61);
  EXPECT_LE(s.time(), 60 / kRate + 1e-6 * s.dt());
  EXPECT_GT(s.time(), 60 / kRate - s.dt());
  ASSERT_EQ(log.drives.size(), 60U);
  EXPECT_EQ(log.drives.back().target.position[0], 0.001);
  EXPECT_NEAR(log.drives.back().at.time + log.drives.back().seconds, 60 / kRate, 1e-12);
}

TEST(Lockstep, ALogGivesTheSameBits) {
  Simulation s(block_and_ball(), open_backend("cpu"));
  DriveLog log;
  Lockstep lockstep(s, {{"ball", std::make_shared<devices::StrokeDevice>(stroke(80))}}, {.stop = {}, .remark = {}}, log);
  run(s, lockstep);
  log.end = LoggedMoment{s.step(), s.time(), 0};
  const std::string text = drive_log_text(log);
  const DriveLog read = parse_drive_log(text, "drives.log");
  EXPECT_EQ(drive_log_text(read), text);

  Simulation again(block_and_ball(), open_backend("cpu"));
  Replay replay(read, again, true);
  run(again, replay);
  EXPECT_EQ(again.deep_hash(), s.deep_hash());
  EXPECT_EQ(again.step(), s.step());
  EXPECT_EQ(replay.applied(), 80U);

  // By the calls that the log is made of.
  Simulation bare(block_and_ball(), open_backend("cpu"));
  for (const LoggedDrive& d : read.drives) {
    bare.advance(d.at.step - bare.step());
    bare.tools().drive(d.tool, d.target, d.seconds);
  }
  bare.advance(read.end->step - bare.step());
  EXPECT_EQ(bare.deep_hash(), s.deep_hash());
}

TEST(Replay, TellsWhatDoesNotFit) {
  Simulation s(block_and_ball(), open_backend("cpu"));
  const auto refused = [&](const std::string& rows, const std::string& words) {
    try {
      Replay replay(parse_drive_log("pliant-drives/1\n" + rows, "a.log"), s, true);
      run(s, replay);
      ADD_FAILURE() << "taken: " << rows;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  refused("begin,0,0\ndrive,0,0,0.1,0,0.2,0,0,0,0,1,needle\n", "a.log:3: the tool is \"needle\"; the scene has \"ball\"");
  refused("begin,5,0.1\nend,6,0.2\n", "a.log:2: the log begins at step 5, the run at step 0");
  refused("begin,0,0.5\nend,1,0.6\n", "a.log:2: step 0 is at 0.5 s; here it is at 0 s");
  refused("begin,0,0\ngrip,0,0,2,ball\nend,1,1\n", "a.log:3: the grip is \"2\"; expected 1 to grip or 0 to let go");
  refused("begin,0,0\ngrip,0,0,1,ball\nend,1,1\n", "a.log:3: tool \"ball\" has no \"grip\"");
  refused("begin,0,0\ndrive,0,0,1e-5,0,-0.2,0,0,0,0,1,ball\nend,1,1\n", "a.log:3: ");  // through the block in no time
}

}  // namespace
}  // namespace pliant::haptics::replay_test
