// What tests of a World that runs freely wait for.
#pragma once
#include <gtest/gtest.h>

#include <chrono>
#include <deque>
#include <functional>
#include <string>
#include <thread>
#include <utility>

#include "pliant/world.h"

namespace pliant::live_test {

/// Waits for a condition, at most 20 s: other programs may keep the worker waiting.
inline void until(const std::function<bool()>& holds) {
  bool held = holds();
  for (int i = 0; i < 4000 && !held; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    held = holds();
  }
  EXPECT_TRUE(held);
}

inline void until_frames(World& world, std::int64_t frames) {
  const std::int64_t before = world.live_state().frames;
  until([&] { return world.live_state().frames >= before + frames; });
}

/// The events of a World, in order.
class Told {
 public:
  explicit Told(World& world) : world_(world) {}
  /// Waits for the next event of this kind and returns it.
  Event wait_for(const std::string& kind) {
    Event found;
    until([&] {
      for (Event& e : world_.events()) waiting_.push_back(std::move(e));
      while (!waiting_.empty() && found.kind.empty()) {
        if (waiting_.front().kind == kind) found = waiting_.front();
        waiting_.pop_front();
      }
      return !found.kind.empty();
    });
    return found;
  }

 private:
  World& world_;
  std::deque<Event> waiting_;
};

}  // namespace pliant::live_test
