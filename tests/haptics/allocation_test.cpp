// No tick allocates: every operator new of the thread counts.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <new>
#include <vector>

#include "allocations.h"
#include "haptics/condensed.h"
#include "haptics/coupling.h"
#include "haptics/hand.h"
#include "haptics/held.h"
#include "haptics/motion.h"
#include "haptics/passivity.h"
#include "haptics/proxy.h"
#include "haptics/safety.h"

namespace {

thread_local long made = 0;  // an edit leaves work to other threads

void* counted(std::size_t size) {
  ++made;
  return std::malloc(size > 0 ? size : 1);
}

void* counted(std::size_t size, std::align_val_t alignment) {
  ++made;
  const auto a = static_cast<std::size_t>(alignment);
  return std::aligned_alloc(a, (size + a - 1) / a * a);
}

}  // namespace

// Not inlined, so that the compiler does not take malloc and delete for a pair that does not match.
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (void* memory = counted(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  if (void* memory = counted(size, alignment)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return counted(size); }
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return counted(size, alignment);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t, const std::nothrow_t&) noexcept { std::free(memory); }

namespace pliant::haptics_test {
long allocations() { return made; }
}  // namespace pliant::haptics_test

namespace pliant::haptics::allocation_test {
namespace {

using haptics_test::allocations;

TEST(Allocation, IsCounted) {
  const long before = allocations();
  std::vector<double>* const some = new std::vector<double>(100);
  EXPECT_EQ(allocations(), before + 2);
  delete some;
}

/// The whole chain of a tick, with each of the force models in turn and a report every 33 ticks.
TEST(Allocation, NoTickAllocates) {
  HandOptions options;
  for (int row = 0; row < 100; ++row) options.path.push_back({row * 0.05, 0.02 * std::cos(row), 0, 0.01 * row, 0, 0, 0, 1});
  SimulatedHand hand(options);
  std::vector<ProxyForce::Triangle> triangles(100, {Vec3d{-1, -1, 0}, Vec3d{1, -1, 0}, Vec3d{0, 1, 0.1}});
  HeldForce held;
  ExtrapolatedForce extrapolated;
  ProxyForce proxy(0.01, 500);
  CondensedForce condensed;
  ForceModel* const models[] = {&held, &extrapolated, &proxy, &condensed};
  MotionEstimate estimate;
  VirtualCoupling coupling({}, 1e-3);
  PassivityGate gate({}, {});
  ForceGuard guard({}, {.force = 3, .torque = 0.1});
  const long before = allocations();
  double felt = 0;
  for (int k = 0; k < 4000; ++k) {
    ForceModel& model = *models[k / 1000];
    if (k % 33 == 0) {
      FrameReport report;
      report.time = k * 1e-3;
      report.mean = {{1, 0, 0.1 * k}, {0, 1, 0}};
      model.receive(report);
      proxy.surface(triangles);
      condensed.linearise({});
    }
    const DeviceSample sample = hand.read();
    const Pose pose{sample.position, sample.turn};
    const Motion motion = estimate.update(sample, 1e-3);
    const Wrench contact = model.tick(coupling.instrument(), 1e-3);
    const Coupled out = coupling.step(pose, motion.velocity, motion.spin, contact, 1e-3);
    const Wrench safe = guard.tick(gate.tick(pose, motion.velocity, motion.spin, out.on_hand, 1e-3), 0, 1e-3);
    gate.exerted(safe);
    hand.write({safe.force, safe.torque, sample.time, sample.number});
    hand.advance(1e-3);
    felt += safe.force[0] * safe.force[0];
  }
  EXPECT_EQ(allocations(), before);
  EXPECT_GT(felt, 0);
}

}  // namespace
}  // namespace pliant::haptics::allocation_test
