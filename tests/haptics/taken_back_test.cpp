// Hands and steps that are taken back: a tool is where its drives take it at every time, forces that did not act do not leave,
// and the log gives the same bits from every place.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "backends/choice/backends.h"
#include "devices/stroke_device.h"
#include "geometry/vec.h"
#include "haptics/lockstep.h"
#include "haptics/replay.h"
#include "support/source_dir.h"

namespace pliant::haptics::taken_back_test {
namespace {

constexpr double kRate = 1000, kTop = 0.072;

/// Soft enough that its automatic step is about as long as the time between two samples.
Scene block_and_ball() {
  const std::string text = R"({"format": "pliant-scene/1", "duration": 1, "gravity": [0, 0, 0], "bodies": [{"name": "cube",
    "surface": ")" + test::source_dir() +
                           R"(/scenes/meshes/cube.obj", "lattice": {"spacing": 0.0125}, "element": "hex8",
    "material": {"law": "neo-hookean", "young": 5000, "poisson": 0.45, "density": 1000, "damping": 2},
    "fixed": [{"plane": [[0, -0.049, 0], [0, -1, 0]]}]}],
    "tools": [{"name": "ball", "shape": {"sphere": 0.02}, "path": [[0, 0, 0.072, 0]]}]})";
  return parse_scene(text, "cube.json");
}

/// Down at `speed` [m/s] to `depth` [m], and there until 0.3 s.
std::vector<DeviceSample> stroke(double depth, double speed) {
  std::vector<DeviceSample> out;
  for (int k = 0; k <= 300; ++k) {
    DeviceSample s;
    s.time = k / kRate;
    s.position = {0, -std::min(depth, speed * s.time), 0};
    s.number = static_cast<std::uint64_t>(k) + 1;
    out.push_back(s);
  }
  return out;
}

class Listening final : public HapticDevice {
 public:
  explicit Listening(std::vector<DeviceSample> samples) : stroke_(std::move(samples)) { stroke_.step_by_answers(); }
  DeviceSample read() noexcept override { return stroke_.read(); }
  void write(const DeviceWrench& wrench) noexcept override {
    most = std::max(most, vec::norm(wrench.force));
    stroke_.write(wrench);
  }
  [[nodiscard]] DeviceLimits limits() const noexcept override { return {1e9, 1e9}; }
  double most = 0;

 private:
  devices::StrokeDevice stroke_;
};

/// As the command does it. `look`: before each batch.
template <class Look>
void run(Simulation& s, RunGuide& guide, const Look& look) {
  while (!s.divergence()) {
    const std::int64_t left = guide.steps_left(s);
    if (left > 0) {
      look();
      s.advance(s.next_batch(left));
    } else if (!guide.next(s)) {
      return;
    }
  }
}

struct ByHand {
  double most = 0;  ///< on the hand [N]
  DriveLog log;
  std::uint64_t hash = 0;
  double end = 0;              ///< height of the ball then [m]
  std::int64_t backwards = 0;  ///< how often steps were taken back
  double astray = 0;           ///< largest distance of the ball from where its samples take it [m]
  std::vector<Snapshot> settled;
};

ByHand by_hand(double depth, double speed, double dt = 0) {
  SimulationOptions options;
  options.dt = dt;
  Simulation s(block_and_ball(), open_backend("cpu"), options);
  const auto device = std::make_shared<Listening>(stroke(depth, speed));
  ByHand out;
  Lockstep lockstep(s, {{"ball", device}}, {.patience = 0.01, .stop = {}, .remark = {}}, out.log);
  std::int64_t last = 0;
  run(s, lockstep, [&] {
    const bool back = s.step() < last;
    out.backwards += back ? 1 : 0;
    last = s.step();
    if (dt == 0 && s.settled() && !back) out.settled.push_back(s.snapshot());
    const double y = kTop - std::min(depth, speed * s.time());
    out.astray = std::max(out.astray, std::abs(s.contact().pose(0, s.time()).position[1] - y));
  });
  EXPECT_FALSE(s.divergence());
  out.log.end = LoggedMoment{s.step(), s.time(), 0};
  out.log.again = s.report().made_again;
  out.most = device->most;
  out.hash = s.deep_hash();
  out.end = s.contact().pose(0, s.time()).position[1];
  return out;
}

TEST(TakenBack, TheToolIsWhereItWasAndNoForceLeavesThatDidNotAct) {
  for (const auto& [depth, speed] : {std::pair{0.04, 0.8}, {0.06, 0.6}, {0.05, 1.2}}) {
    const ByHand automatic = by_hand(depth, speed), fine = by_hand(depth, speed, 1e-4);
    EXPECT_GT(automatic.backwards, 0) << "this stroke tests nothing";
    EXPECT_LT(automatic.most, 1.3 * fine.most) << depth << ' ' << speed;
    EXPECT_LT(automatic.astray, 1.01 * speed / kRate) << "more than the way between two samples";
    EXPECT_NEAR(automatic.end, kTop - depth, 1e-12);
  }
}

TEST(TakenBack, TheLogGivesTheSameBitsFromEverySettledState) {
  const ByHand first = by_hand(0.05, 1.2);
  ASSERT_GT(first.backwards, 0);
  ASSERT_GT(first.settled.size(), 3U);
  const DriveLog log = parse_drive_log(drive_log_text(first.log), "drives.log");
  EXPECT_EQ(drive_log_text(log), drive_log_text(first.log));
  for (std::size_t i = 0; i <= first.settled.size(); ++i) {
    Simulation again(block_and_ball(), open_backend("cpu"));
    if (i < first.settled.size()) again.restore(first.settled[i]);
    Replay replay(log, again, true);
    run(again, replay, [] {});
    EXPECT_EQ(again.deep_hash(), first.hash) << i;
  }
}

/// One sample asks for 0.3 m/s more than contact can follow through tissue, and the next ones for no way at all.
TEST(TakenBack, AToolIsNotLeftBehindByASampleThatIsTooFast) {
  std::vector<DeviceSample> jump = stroke(0.03, 1e9);
  Simulation s(block_and_ball(), open_backend("cpu"), {.dt = 2e-4});
  DriveLog log;
  std::string said;
  Lockstep lockstep(s, {{"ball", std::make_shared<Listening>(jump)}},
                    {.patience = 0.01, .stop = {}, .remark = [&](const std::string& text) { said += text; }}, log);
  run(s, lockstep, [] {});
  EXPECT_EQ(lockstep.counts(0).refused, 0);
  EXPECT_GT(lockstep.counts(0).limited, 0);
  EXPECT_NE(said.find("tool 'ball': its device moves it faster"), std::string::npos) << said;
  EXPECT_NEAR(s.contact().pose(0, s.time()).position[1], kTop - 0.03, 1e-12);
}

ToolDrive way(double x, double y, double start, double end) {
  return {{{x, 0, 0}, {0, 0, 0, 1}}, {{y, 0, 0}, {0, 0, 0, 1}}, start, end};
}

Pose before(double /*time*/) { return {{0, 0, 0}, {0, 0, 0, 1}}; }

/// What the host has moved goes the same way again; what it has placed stands there from the beginning, since no way leads
/// there.
TEST(DriveHistory, GoesItsWayAgainButNotToWhereItWasPlaced) {
  DriveHistory<ToolDrive> all;
  add_drive(all, "rod", way(0, 1, 1, 2));
  add_drive(all, "rod", way(0.5, 3, 1.5, 2.5));
  EXPECT_FALSE(stay_after_jumps(all["rod"], 0.5, before));
  EXPECT_EQ(drive_at(all, "rod", 0.9), nullptr);
  EXPECT_EQ(drive_at(all, "rod", 1.25)->at(1.25).position[0], 0.25);
  EXPECT_EQ(drive_at(all, "rod", 2)->at(2).position[0], 1.75);
  EXPECT_EQ(since_jump(all, "rod", 1.4, 1.6, before), 1.4);

  auto placed = all;
  add_drive(placed, "rod", way(7, 7, 1.75, 1.75));
  add_drive(placed, "rod", way(7, 8, 1.75, 2.75));  // at once: the entry of its place is replaced
  EXPECT_EQ(since_jump(placed, "rod", 1.6, 1.8, before), 1.75);
  EXPECT_TRUE(stay_after_jumps(placed["rod"], 0.5, before));
  EXPECT_EQ(drive_at(placed, "rod", 0.5)->at(0.5).position[0], 7);
  EXPECT_EQ(drive_at(placed, "rod", 1.7)->at(1.7).position[0], 7);
  EXPECT_EQ(drive_at(placed, "rod", 2.25)->at(2.25).position[0], 7.5);

  add_drive(all, "rod", way(0.25, 2, 1.25, 2));  // after a rollback: what was requested for later times does not happen
  EXPECT_EQ(all["rod"].size(), 2U);
  forget_drives(all, 1.3);
  EXPECT_EQ(all["rod"].size(), 1U);
  forget_drives(all, 9);
  EXPECT_EQ(all["rod"].size(), 1U) << "the last one stays in effect";
}

}  // namespace
}  // namespace pliant::haptics::taken_back_test
