// Frames that are made before the display may show them.
#include <chrono>
#include <thread>

#include "api/frame_queue.h"
#include "api/pace.h"
#include "live.h"
#include "scenes.h"

namespace pliant {
namespace {

using namespace live_test;
using test::block;
using test::on;

/// A frame of three vertices.
class Queue : public ::testing::Test {
 protected:
  std::shared_ptr<api::FrameData> add(std::int64_t step, const IndexRange& vertices, double due) {
    auto data = pool_->take();
    data->positions.resize(3);
    data->frame.step = step;
    data->frame.positions = {data->positions.data(), 3};
    queue_.add(data, vertices, {}, due);
    return data;
  }
  api::FrameQueue queue_;

 private:
  std::shared_ptr<api::FramePool> pool_ = std::make_shared<api::FramePool>();
};

TEST_F(Queue, ShowsAFrameOnceItIsDue) {
  const auto first = add(1, {0, 3}, api::kLongAgo), second = add(2, {0, 1}, 5), third = add(3, {2, 1}, 6);
  EXPECT_EQ(queue_.show(4.9), 0);
  EXPECT_EQ(queue_.see(), first);
  EXPECT_TRUE(queue_.has_more_than_given());
  EXPECT_EQ(queue_.give(), first);
  EXPECT_FALSE(queue_.has_more_than_given());
  EXPECT_EQ(queue_.show(5), 0);
  EXPECT_TRUE(queue_.has_more_than_given());
  EXPECT_EQ(queue_.seen(), first);
  EXPECT_EQ(queue_.show(7), 1) << "nobody has seen the second";
  EXPECT_EQ(queue_.give(), third);
  EXPECT_EQ(third->polled.dirty_vertices.first, 0U);
  EXPECT_EQ(third->polled.dirty_vertices.count, 3U) << "of both frames since the first";
  EXPECT_EQ(queue_.show(api::kAtLast), 0);
}

/// A reset, say.
TEST_F(Queue, AFrameThatIsDueTakesThoseBeforeItAlong) {
  add(1, {0, 3}, 5);
  add(2, {0, 3}, 6);
  const auto third = add(3, {0, 3}, api::kLongAgo);
  queue_.show(0);
  EXPECT_EQ(queue_.newest(), third);
  EXPECT_EQ(queue_.show(9), 0);
  EXPECT_EQ(queue_.newest(), third);
}

TEST(FramesAhead, AreShownInTime) {
  World world(block(), on("cpu"));
  world.run_live({60, 1, 2});
  until_frames(world, 5);
  double before = world.frame()->time;
  int behind = 0;
  for (int i = 0; i < 40; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(8));
    if (!world.poll()) continue;
    const double shown = world.frame()->time;
    EXPECT_GT(shown, before);
    before = shown;
    behind += world.time() - shown > 0.5 / 60 ? 1 : 0;  // of the simulation, which has gone on
  }
  EXPECT_GT(behind, 0);
  world.run_live({60, 1, 0});
  until([&] { return world.poll() && world.time() - world.frame()->time < 0.1 / 60; });
}

TEST(FramesAhead, ACallThatWaitsShowsTheLast) {
  World world(block(), on("cpu"));
  world.run_live({60, 1, 4});
  until_frames(world, 5);
  const double last = world.time();
  static_cast<void>(world.vertex_values("mises"));
  EXPECT_GE(world.frame()->time, last);
  until_frames(world, 5);
  const StepReport report = world.stop_live();
  EXPECT_EQ(world.frame()->step, report.step);
}

TEST(FramesAhead, AFreshStartIsShownAtOnce) {
  World world(block(), on("cpu"));
  Told told(world);
  world.run_live({60, 1, 4});
  until_frames(world, 30);
  const double last = world.frame()->time;
  world.reset();
  told.wait_for("reset");
  EXPECT_LT(world.frame()->time, last);
}

}  // namespace
}  // namespace pliant
