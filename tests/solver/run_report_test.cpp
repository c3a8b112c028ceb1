// What a run tells afterwards is the same if it was interrupted and went on from a checkpoint.
#include "simulation/state/run_report.h"

#include <gtest/gtest.h>

#include "io/save.h"
#include "simulation/measure/run_remarks.h"
#include "solver/scenes.h"
#include "support/error_of.h"
#include "support/temp_folder.h"

namespace pliant {
namespace {

/// Beside the table a ball that the cube never touches.
Scene thrown_block() {
  return testing::thrown_cube(R"(, {"name": "ball", "shape": {"sphere": 0.01}, "path": [[0, 0, -0.2, 0]]})");
}

void go_to(Simulation& s, std::int64_t step) {
  while (s.step() < step && !s.divergence()) {
    s.advance(std::min<std::int64_t>(16, step - s.step()));
    s.watch_energy();
  }
}

/// Both the figures and their sentences; they depend on where batches end, so both runs end theirs alike.
void expect_the_same(Simulation& resumed, Simulation& whole) {
  EXPECT_EQ(write_report(resumed.snapshot().reports), write_report(whole.snapshot().reports));
  EXPECT_EQ(run_remarks(resumed), run_remarks(whole));
}

TEST(RunReport, AResumedRunTellsWhatTheUninterruptedOneTells) {
  const test::TempFolder folder;
  const auto file = folder.path() / "state.pckpt";
  const Scene pressed = testing::pressed_cube(0.12), table = thrown_block();
  for (const Scene& scene : {pressed, table}) {
    Simulation used(scene, open_backend("cpu"));
    for (const std::int64_t at : {0, 17, 64, 100, 199, 333}) {
      SCOPED_TRACE(at);
      Simulation whole(scene, open_backend("cpu")), fresh(scene, open_backend("cpu"));
      go_to(whole, at);
      write_checkpoint(file, take_checkpoint(whole));
      Simulation now(scene, open_backend("cpu"));
      restore_checkpoint(now, read_checkpoint(file), file);
      expect_the_same(now, whole);
      go_to(whole, 400);
      for (Simulation* resumed : {&fresh, &used}) {
        restore_checkpoint(*resumed, read_checkpoint(file), file);
        go_to(*resumed, 400);
        expect_the_same(*resumed, whole);
      }
      const RunReport& report = whole.report();
      EXPECT_GT(report.made_again, 0);
      if (scene.tools.empty()) {
        EXPECT_GT(report.inversions.batches, 0);
        EXPECT_GT(report.inversions.calmed, 0);
      } else {
        EXPECT_GT(report.tools[0].touched, 0);
        EXPECT_EQ(report.tools[1].touched, 0);
        EXPECT_TRUE(report.energy.share());
      }
    }
  }
}

/// A burst that was taken back is no part of the run, nor is its energy.
TEST(RunReport, ABatchThatIsMadeAgainLeavesNothing) {
  RunReport kept;
  kept.inversions.most = 2;
  kept.tissue.points = 3;
  kept.energy = {1.0, 0.1, 4.0};
  RunReport now = kept;
  now.inversions.most = 20;
  now.tissue.points = 30;
  now.energy = {0.5, 3.0, 9.0};
  now.strokes["scalpel"].attempts = 2;
  now.take_back(kept);
  EXPECT_EQ(now.made_again, 1);
  now.made_again = 0;
  EXPECT_EQ(write_report({now, {}}), write_report({kept, {}}));
}

TEST(RunReport, DecidesNothing) {
  Simulation source(thrown_block(), open_backend("cpu")), other(thrown_block(), open_backend("cpu"));
  go_to(source, 100);
  Snapshot snapshot = source.snapshot();
  const std::uint64_t deep = deep_hash(snapshot);
  snapshot.reports.now = snapshot.reports.kept = {};
  EXPECT_EQ(deep_hash(snapshot), deep);
  EXPECT_NE(test::error_of([&] { other.restore(snapshot); }).find("report"), std::string::npos) << "of no tools";
  snapshot.reports.now.tools.resize(2);
  snapshot.reports.kept.tools.resize(2);
  other.restore(snapshot);
  go_to(source, 200);
  go_to(other, 200);
  EXPECT_EQ(other.deep_hash(), source.deep_hash());
  EXPECT_GT(source.report().inversions.calmed + source.report().made_again, 0);
}

}  // namespace
}  // namespace pliant
