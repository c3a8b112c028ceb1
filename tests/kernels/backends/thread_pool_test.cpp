// The threads of the C++ twins: every piece once, passes one after the other, and nobody waited for who does not come.
#include "backends/twins/thread_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace pliant::ref {
namespace {

using namespace std::chrono_literals;

class EachCount : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Threads, EachCount, testing::Values(1, 2, 3, 16));

TEST_P(EachCount, DoesEveryPieceOnceAndOnePassAfterAnother) {
  ThreadPool pool(GetParam());
  const int n = pool.threads();
  std::vector<std::int64_t> now(static_cast<std::size_t>(n), 1), next(now);
  std::atomic<int> others = 0;
  const auto caller = std::this_thread::get_id();
  constexpr int kPasses = 3000;
  for (int pass = 0; pass < kPasses; ++pass) {
    // Each value becomes one more than its neighbour's: a piece left out, done twice or begun too early leaves a wrong sum.
    pool.run([&](int i) {
      const auto at = static_cast<std::size_t>(i);
      next[at] += now[(at + 1) % now.size()] + 1 - now[at];
      others += std::this_thread::get_id() != caller ? 1 : 0;
      if (pass < 50) std::this_thread::sleep_for(50us);  // so that the others come
    });
    now.swap(next);
    pool.run([&](int i) { next[static_cast<std::size_t>(i)] = now[static_cast<std::size_t>(i)]; });
  }
  for (const std::int64_t value : now) EXPECT_EQ(value, 1 + kPasses);
  EXPECT_TRUE(n == 1 || others > 0);
}

TEST(ThreadPool, EndsWhileItsThreadsAreComing) {
  // A few short passes and the end: threads wake for a pass and meet the end on their way. A thread that took the end for a
  // pass would call a piece that is gone, and then wait for ever.
  for (int pools = 0; pools < 4000; ++pools) {
    ThreadPool pool(2 + pools % 15);
    std::atomic<int> pieces = 0;
    for (int pass = 0; pass <= pools % 3; ++pass) pool.run([&](int) { ++pieces; });
    ASSERT_EQ(pieces, (1 + pools % 3) * pool.threads());
  }
}

TEST(ThreadPool, WorksAloneForAWhileAfterAPieceThatCameLate) {
  ThreadPool pool(2);
  const auto caller = std::this_thread::get_id();
  const auto others_in = [&](auto&& delay) {
    std::atomic<int> others = 0;
    pool.run([&](int) {
      const bool other = std::this_thread::get_id() != caller;
      others += other ? 1 : 0;
      std::this_thread::sleep_for(other ? delay : 1ms);  // the caller leaves the other thread time to come
    });
    return others.load();
  };
  int late = 0, alone = 0;
  for (int i = 0; i < 100 && late < 5; ++i) {
    if (others_in(8ms) == 0) continue;
    ++late;
    int others = 0;
    for (int k = 0; k < 10; ++k) others += others_in(0ms);
    alone += others == 0 ? 1 : 0;
    std::this_thread::sleep_for(100ms);
  }
  EXPECT_GT(late, 0) << "the other thread never came";
  EXPECT_GT(alone, 0);
}

}  // namespace
}  // namespace pliant::ref
