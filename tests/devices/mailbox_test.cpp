#include "devices/mailbox.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

namespace pliant::devices {
namespace {

TEST(Mailbox, HandsOutTheNewestValueOnce) {
  Mailbox<int> box(7);
  EXPECT_FALSE(box.take());
  EXPECT_EQ(box.newest(), 7);
  box.publish(1);
  box.publish(2);
  EXPECT_TRUE(box.take());
  EXPECT_EQ(box.newest(), 2);
  EXPECT_FALSE(box.take());
}

TEST(Mailbox, NeverMixesTwoValues) {
  using Value = std::array<std::uint64_t, 32>;
  Mailbox<Value> box;
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= 200000; ++i) {
      box.draft().fill(i);
      box.publish();
    }
    done.store(true);
  });
  std::uint64_t last = 0;
  while (!done.load() || last != 200000) {
    if (!box.take()) continue;
    const Value& value = box.newest();
    ASSERT_GT(value[0], last);
    last = value[0];
    for (const std::uint64_t v : value) ASSERT_EQ(v, last);
  }
  writer.join();
}

}  // namespace
}  // namespace pliant::devices
