// The pace of a freely running World, on a clock of the test: how frames follow the caller, and what a slow machine does.
#include "api/pace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "scenes.h"

namespace pliant::api {
namespace {

/// A machine that needs `cost` seconds per simulated second and `fixed` per frame, and a caller that looks for a frame at
/// `phase` of every period of 1 / `looks` s.
struct Machine {
  Pace pace;
  double now = 100, cost = 0.3, fixed = 0.001, phase = 0.4, looks = 60, simulated = 0;
  std::int64_t fetches = 0, fresh = 0, frames = 0, shown = 0, seen = 0;
  std::deque<double> waiting;  ///< due times of frames

  explicit Machine(const LiveOptions& options = {}) { pace.start(options, now); }

  void fetch_until(double end) {
    const double period = 1.0 / looks;
    while (true) {
      const double at = 100 + (static_cast<double>(fetches) + phase) * period;
      if (at > end) return;
      ++fetches;
      while (!waiting.empty() && waiting.front() <= at) {
        waiting.pop_front();
        ++shown;
      }
      fresh += shown != seen ? 1 : 0;
      shown != seen ? static_cast<void>(pace.fetched(at)) : pace.looked(at);
      seen = shown;
    }
  }
  void frame(double edits = 0) {
    fetch_until(std::max(now, pace.next_start()));
    now = std::max(now, pace.next_start());
    const double covers = pace.begin(now), takes = fixed + cost * covers + edits;
    fetch_until(now + takes);
    now += takes;
    if (seen != frames && pace.due() == kLongAgo) pace.drop();
    ++frames;
    waiting.push_back(pace.due());
    simulated += covers;
    pace.end(now, covers, edits, fixed);
  }
  void run(double seconds) {
    for (const double end = now + seconds; now < end;) frame();
  }
};

TEST(Pace, EveryPictureShowsANewFrameInRealTime) {
  for (const double phase : {0.0, 0.1, 0.4, 0.7, 0.95}) {
    Machine m;
    m.phase = phase;
    m.run(1);
    const std::int64_t fetches = m.fetches, fresh = m.fresh;
    const double simulated = m.simulated, start = m.now;
    m.run(10);
    EXPECT_NEAR((m.simulated - simulated) / (m.now - start), 1, 0.005) << phase;
    EXPECT_GE(static_cast<double>(m.fresh - fresh), 0.99 * static_cast<double>(m.fetches - fetches)) << phase;
    const LiveState state = m.pace.state();
    EXPECT_TRUE(state.running);
    EXPECT_NEAR(state.real_time, 1, 0.01);
    EXPECT_NEAR(state.load, 0.3 + 0.001 * 60, 0.02);
    EXPECT_EQ(state.late, 0);
    EXPECT_LT(state.lost, 0.01);
  }
}

TEST(Pace, ASlowMachineKeepsTheRateAndSlowsTimeDown) {
  Machine m;
  m.cost = 2;  // simulates half of real time, less what a frame costs anyway
  m.run(5);
  const std::int64_t fetches = m.fetches, fresh = m.fresh;
  const double simulated = m.simulated, start = m.now;
  m.run(20);
  const double speed = (m.simulated - simulated) / (m.now - start);
  EXPECT_GT(speed, 0.36);
  EXPECT_LT(speed, 0.48);
  EXPECT_GE(static_cast<double>(m.fresh - fresh), 0.95 * static_cast<double>(m.fetches - fetches));
  EXPECT_NEAR(m.pace.state().lost, m.now - 100 - m.simulated, 0.3);
  EXPECT_GT(m.pace.state().load, 1.9);
}

TEST(Pace, CatchesUpAfterADelayButNotWithAllOfIt) {
  Machine m;
  m.run(2);
  m.frame(0.1);  // a cut
  const double after_cut = m.now - 100 - m.simulated;
  EXPECT_GT(after_cut, 0.08);
  m.run(1);
  EXPECT_LT(m.now - 100 - m.simulated, 0.02);
  EXPECT_GT(m.pace.state().late, 4);
  m.frame(3);
  m.run(2);
  EXPECT_NEAR(m.pace.state().lost, 2.75, 0.1);
  EXPECT_NEAR(m.now - 100 - m.simulated, 2.75, 0.1);
}

TEST(Pace, ASlowFrameNowAndThenDoesNotSlowTimeDown) {
  Machine m;
  m.cost = 0.5;
  m.run(2);
  const double simulated = m.simulated, start = m.now;
  for (int i = 0; i < 600; ++i) {
    m.fixed = i % 24 == 0 ? 0.05 : 0.001;  // a moved region, say, which is no edit of the caller's
    m.frame();
  }
  EXPECT_GT((m.simulated - simulated) / (m.now - start), 0.98);
}

/// A probe has pressed for a while, which takes a shorter step.
TEST(Pace, TimeIsBackSoonAfterItWasSlow) {
  for (const int ahead : {0, 1}) {
    Machine m({60, 1, ahead});
    m.cost = 4;
    m.run(3);
    m.cost = 0.4;
    m.run(0.25);
    const double simulated = m.simulated, start = m.now;
    m.run(1);
    EXPECT_GT((m.simulated - simulated) / (m.now - start), 0.99) << ahead;
  }
}

/// Whoever looks more often sees frames at the rate all the same.
TEST(Pace, LooksThatAreOftenDoNotChangeTheRate) {
  for (const double looks : {60.0, 90.0, 120.0, 144.0, 240.0, 1000.0}) {
    for (const int ahead : {0, 1}) {
      Machine m({60, 1, ahead});
      m.looks = looks;
      m.run(2);
      const std::int64_t frames = m.frames;
      const double start = m.now;
      m.run(10);
      EXPECT_NEAR(static_cast<double>(m.frames - frames) / (m.now - start), 60, 1.5) << looks << ' ' << ahead;
    }
  }
}

TEST(Pace, AHigherRateDoesNotWaitForALowOneBefore) {
  Pace pace;
  pace.start({1, 1, 4}, 50);
  for (int i = 0; i < 4; ++i) {
    static_cast<void>(pace.begin(std::max(50.0, pace.next_start())));
    pace.end(50, 1, 0, 0);
  }
  EXPECT_GT(pace.due(), 53);
  pace.change({60, 1, 1}, 50.1);
  EXPECT_LT(pace.next_start(), 50.15);
}

/// Frames that take 1.5 to 1.7 periods, one in 24.
TEST(Pace, AFrameAheadHidesASlowOne) {
  for (const double phase : {0.0, 0.3, 0.8}) {
    std::array<double, 2> stale{};
    for (const int ahead : {0, 1}) {
      Machine m({60, 1, ahead});
      m.phase = phase;
      m.cost = 0.6;
      m.run(2);
      const double simulated = m.simulated, start = m.now;
      const std::int64_t fetches = m.fetches, fresh = m.fresh;
      for (int i = 0; i < 1200; ++i) {
        m.fixed = i % 24 == 0 ? 0.015 + 0.001 * (i % 5) : 0.001;
        m.frame();
      }
      stale[static_cast<std::size_t>(ahead)] =
          1 - static_cast<double>(m.fresh - fresh) / static_cast<double>(m.fetches - fetches);
      EXPECT_NEAR((m.simulated - simulated) / (m.now - start), 1, 0.01);
    }
    EXPECT_GT(stale[0], 0.03) << phase;
    EXPECT_LT(stale[1], 0.002) << phase;
  }
}

TEST(Pace, AFrameAheadIsDueWhenItWouldHaveBeenWithout) {
  constexpr double kPeriod = 1.0 / 60;
  Pace pace;
  pace.start({60, 1, 2}, 50);
  for (int i = 0; i < 3; ++i) {
    const double start = std::max(50.0, pace.next_start());
    EXPECT_NEAR(start, 50, 1e-9);  // two periods before its time at most
    EXPECT_NEAR(pace.begin(start), kPeriod, 1e-9);
    EXPECT_NEAR(pace.due(), 50 + (i + 0.5) * kPeriod, 1e-9);
    pace.end(start, kPeriod, 0, 0);
  }
  EXPECT_NEAR(pace.next_start(), 50 + kPeriod, 1e-9);
  pace.stop();
  EXPECT_EQ(pace.due(), kLongAgo);
}

/// A machine that is too slow for frames of full length does as much of real time as its load allows.
TEST(Pace, FramesAheadMayTakeMoreOfTheirPeriod) {
  std::array<double, 2> speed{};
  for (const int ahead : {0, 1}) {
    Machine m({60, 1, ahead});
    m.cost = 0.95;
    m.run(4);
    const double simulated = m.simulated, start = m.now;
    const std::int64_t fetches = m.fetches, fresh = m.fresh;
    m.run(20);
    speed[static_cast<std::size_t>(ahead)] = (m.simulated - simulated) / (m.now - start);
    EXPECT_GE(static_cast<double>(m.fresh - fresh), 0.99 * static_cast<double>(m.fetches - fetches));
  }
  EXPECT_LT(speed[0], 0.85);
  EXPECT_GT(speed[1], 0.92);
}

TEST(Pace, SkippedTimeIsNotOwed) {
  Machine m;
  m.run(1);
  const double behind = m.now - m.simulated;
  m.now += 5;  // a load
  m.pace.skip(5);
  m.run(1);
  EXPECT_NEAR(m.now - m.simulated - behind, 5, 0.03);
  EXPECT_LT(m.pace.state().lost, 0.01);
}

/// A save in every period, which takes no time, must not stop the clock.
TEST(Pace, ManyShortInterruptionsDoNotStopTime) {
  Machine m;
  for (int i = 0; i < 600; ++i) {
    m.pace.skip(0.001);
    m.now += 0.001;
    m.frame();
  }
  EXPECT_NEAR(m.simulated, m.now - 100 - 0.6, 0.05);
}

TEST(Pace, SpeedIsSimulatedOverWallTime) {
  Machine m({60, 0.1});
  m.run(5);
  EXPECT_NEAR(m.simulated / (m.now - 100), 0.1, 0.005);
  EXPECT_NEAR(m.pace.state().real_time, 1, 0.01);
  m.pace.change({60, 2}, m.now);
  const double simulated = m.simulated, start = m.now;
  m.run(5);
  EXPECT_NEAR((m.simulated - simulated) / (m.now - start), 2, 0.05);
}

TEST(Pace, FramesWithoutACallerAreDropped) {
  Machine m;
  m.phase = 1e9;
  m.run(1);
  EXPECT_NEAR(static_cast<double>(m.frames), 60, 2);
  EXPECT_EQ(m.pace.state().dropped, m.frames - 1);
}

TEST(Pace, BadOptionsAreRefused) {
  EXPECT_NE(test::message_of([] { check_live({0, 1}); }).find("rate is 0, expected 1 to 1000"), std::string::npos);
  EXPECT_NE(test::message_of([] { check_live({60, -1}); }).find("speed is -1, expected 0.001 to 1000"), std::string::npos);
  EXPECT_NE(test::message_of([] { check_live({60, 1, 5}); }).find("ahead is 5, expected 0 to 4"), std::string::npos);
  EXPECT_NE(test::message_of([] { check_live({60, std::nan("")}); }).find("speed is nan"), std::string::npos);
  EXPECT_EQ(test::message_of([] { check_live({1000, 0.001}); }), "");
}

}  // namespace
}  // namespace pliant::api
