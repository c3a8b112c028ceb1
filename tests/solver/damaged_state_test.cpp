// Run states that came from elsewhere: whatever their bytes, a simulation takes them up or refuses them and stays as it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "pliant/error.h"
#include "solver/rich_state.h"
#include "support/error_of.h"

namespace pliant {
namespace {

TEST(DamagedState, WhateverTheBytesItIsTakenUpOrRefused) {
  const Scene scene = rich_scene();
  const auto source = rich_simulation(scene);
  const Snapshot good = source->snapshot();
  ASSERT_FALSE(good.state.cuts.empty());
  ASSERT_FALSE(good.state.blades.traces.empty());
  ASSERT_FALSE(good.state.pending.moves.empty());
  const std::string bytes = write_state(good.state);
  Simulation target(scene, open_backend("cpu"));
  target.advance(10);
  std::uint64_t before = target.deep_hash();
  std::mt19937 random(5);
  int refused = 0, unreadable = 0, taken = 0;
  for (std::uint32_t i = 0; i < 1200; ++i) {
    std::string bad = bytes;
    for (std::uint32_t k = 0; k <= i % 3; ++k) {
      const std::size_t at = random() % bad.size();
      switch (i < 600 ? 1 : random() % 4) {
        case 0:
          bad[at] = static_cast<char>(random());
          break;
        case 1:
          bad[at] = static_cast<char>(bad[at] ^ (1 << static_cast<int>(random() % 8)));
          break;
        case 2:
          bad.erase(at, 1 + random() % 16);
          break;
        default:
          for (std::size_t b = at; b < std::min(bad.size(), at + 8); ++b)
            bad[b] = static_cast<char>(random() % 2 != 0 ? -1 : 0);
      }
    }
    Snapshot snapshot = good;
    try {
      snapshot.state = read_state(bad);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input);
      ++unreadable;
      continue;
    }
    try {
      target.restore(snapshot);
      ++taken;  // a number that any run may have
      before = target.deep_hash();
    } catch (const Error& error) {
      ++refused;
      EXPECT_NE(error.code(), ErrorCode::internal) << error.what();
      ASSERT_EQ(target.deep_hash(), before) << "a refused state must change nothing: " << error.what();
    }
  }
  std::printf("%d unreadable, %d refused, %d taken up\n", unreadable, refused, taken);
  EXPECT_GT(unreadable, 50);
  EXPECT_GT(refused, 20);
  target.restore(good);
  EXPECT_EQ(target.deep_hash(), source->deep_hash());
  target.advance(64);
  source->advance(64);
  EXPECT_EQ(target.deep_hash(), source->deep_hash());
}

TEST(DamagedState, WhatIsRefusedIsNamed) {
  const Scene scene = rich_scene();
  const auto source = rich_simulation(scene);
  Simulation target(scene, open_backend("cpu"));
  const auto refusal = [&](auto&& damage) {
    Snapshot snapshot = source->snapshot();
    damage(snapshot.state);
    const std::uint64_t before = target.deep_hash();
    const std::string message = test::error_of([&] { target.restore(snapshot); });
    EXPECT_EQ(target.deep_hash(), before) << message;
    return message;
  };
  const auto has = [](const std::string& message, const char* part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  has(refusal([](RunState& s) { s.cuts[0].body = 7; }), "cuts");
  has(refusal([](RunState& s) { s.cuts[0].edges[{0, 1000000}] = 0.5; }), "edge");
  has(refusal([](RunState& s) { s.cuts.clear(); }), "");
  has(refusal([](RunState& s) { s.tears.push_back({0, 0, 1}); }), "tears");
  has(refusal([](RunState& s) { s.regions = {{{0, 0, 0}, {}}}; }), "regions");
  has(refusal([](RunState& s) { s.blades.traces.begin()->second.begin()->second.points[0].carried.cell = 1 << 30; }), "traces");
  has(refusal([](RunState& s) {
        TracePoint& point = s.blades.traces.begin()->second.begin()->second.points[0];
        point.carried.cell = -1;
        point.node = 1 << 30;
      }),
      "traces");
  has(refusal([](RunState& s) { s.blades.traces.begin()->second.begin()->second.levels = 60; }), "traces");
  has(refusal([](RunState& s) { s.blades.placed.begin()->second[0][2] = INFINITY; }), "blade");
  has(refusal([](RunState& s) { s.forces[0].body = 3; }), "force");
  has(refusal([](RunState& s) { s.forces[0].force[1] = NAN; }), "force");
  has(refusal([](RunState& s) { s.relaxation.u = {1, 2, 3}; }), "relax");
  has(refusal([](RunState& s) { s.clock.dt = 0; }), "step");
  has(refusal([](RunState& s) { s.kept->clock.step = -1; }), "step");
  has(refusal([](RunState& s) { (*s.focus)[0] = INFINITY; }), "focus");
  has(refusal([](RunState& s) { s.pending.moves[0].to[0][1][2] = NAN; }), "blade");
}

}  // namespace
}  // namespace pliant
