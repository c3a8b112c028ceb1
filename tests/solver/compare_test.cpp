// Lockstep comparison: equal runs are equal, and one wrong bit is found where it was made.
#include "simulation/state/compare.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "pliant/error.h"
#include "solver/scenes.h"
#include "support/forwarding_backend.h"

namespace pliant {
namespace {

using testing::pressed_cube;

/// Once, after the given run of the given pass, one value moves to the next float.
class TamperingBackend final : public test::ForwardingBackend {
 public:
  TamperingBackend(std::unique_ptr<Backend> inner, std::string kernel, int run, std::string buffer, std::size_t index)
      : ForwardingBackend(std::move(inner)), kernel_(std::move(kernel)), run_(run), buffer_(std::move(buffer)), index_(index) {}

  bool armed = false;

  void load(const Program& program) override {
    program_ = &program;
    ForwardingBackend::load(program);
  }
  using ForwardingBackend::run;
  void run(const Pass& pass, std::int32_t step) override {
    ForwardingBackend::run(pass, step);
    if (!armed || pass.kernel != kernel_ || --run_ != 0) return;
    const BufferId id = program_->find(buffer_);
    std::vector<double> values = inner_->read_reals(id);
    values.at(index_) = std::nextafter(static_cast<float>(values[index_]), 1e30F);
    inner_->write_reals(id, values);
  }

 private:
  const Program* program_ = nullptr;
  std::string kernel_;
  int run_;
  std::string buffer_;
  std::size_t index_;
};

class Compare : public ::testing::Test {
 protected:
  explicit Compare(const Scene& scene = pressed_cube(0.01))
      : scene_(scene), model_(std::make_shared<const Model>(build_model(scene_))) {}
  Simulation make(std::unique_ptr<Backend> backend, double dt = 0) {
    SimulationOptions options;
    options.dt = dt;
    return {scene_, model_, std::move(backend), options};
  }
  static ComparisonResult run(Simulation& a, Simulation& b, std::int64_t steps, bool every_pass = true) {
    CompareOptions options;
    options.steps = steps;
    options.every_pass = every_pass;
    return compare(a, b, options);
  }
  Scene scene_;
  std::shared_ptr<const Model> model_;
};

TEST_F(Compare, EqualBackendsAreIdenticalAndEveryNumberIsCounted) {
  Simulation a(scene_, model_, open_backend("cpu")), b(scene_, model_, open_backend("cpu"));
  const ComparisonResult result = run(a, b, 70);
  EXPECT_TRUE(result.identical) << result.first_difference->message();
  EXPECT_EQ(result.steps, 70);
  EXPECT_EQ(result.passes, static_cast<int>(a.program().step.size()));
  std::int64_t all = 0, changing = 0;
  for (const Buffer& buffer : a.program().buffers) {
    all += static_cast<std::int64_t>(buffer.values());
    if (buffer.role != BufferRole::constant) changing += static_cast<std::int64_t>(buffer.values());
  }
  std::int64_t surface = 0, placed = 0;
  for (const Buffer& buffer : a.surface_program().buffers) {
    surface += static_cast<std::int64_t>(buffer.values());
    if (buffer.role != BufferRole::constant) placed += static_cast<std::int64_t>(buffer.values());
  }
  EXPECT_GT(placed, 0);
  // Everything once, then every pass of every step, and before and after each of the two batches (64 and 6 steps); the surface
  // once, and after each batch.
  EXPECT_EQ(result.values_compared, all + changing * (70 * result.passes + 4) + surface + 2 * placed);
}

TEST_F(Compare, LockstepGivesTheBitsOfAnOrdinaryRun) {
  Simulation a(scene_, model_, open_backend("cpu")), b(scene_, model_, open_backend("cpu")),
      alone(scene_, model_, open_backend("cpu"));
  ASSERT_TRUE(run(a, b, 150, false).identical);
  EXPECT_EQ(alone.advance(150), 150);
  EXPECT_EQ(a.hash(), alone.hash());
  EXPECT_EQ(b.hash(), alone.hash());
}

TEST_F(Compare, OpenclGivesTheBitsOfTheTwins) {
  if (!testing::has_opencl()) GTEST_SKIP() << "there is no OpenCL device";
  Simulation a(scene_, model_, open_backend("opencl:0"));
  if (!a.backend().info().bit_exact) GTEST_SKIP() << "opencl:0 is in tolerance mode: " << a.backend().info().tolerance_reason;
  Simulation b(scene_, model_, open_backend("cpu"));
  const ComparisonResult result = run(a, b, 130);
  EXPECT_TRUE(result.identical) << result.first_difference->message();
}

TEST_F(Compare, FindsTheStepPassBufferAndIndexOfOneWrongBit) {
  Simulation a(scene_, model_, open_backend("cpu"));
  // A slot that holds a node, so that its displacement is a number that moves.
  const std::size_t index = 4 * static_cast<std::size_t>(model_->bodies[0].slot[20]) + 1;
  auto tampering = std::make_unique<TamperingBackend>(open_backend("cpu"), "brick_update", 67, "node_w", index);
  TamperingBackend& tamper = *tampering;
  Simulation b(scene_, model_, std::move(tampering));
  tamper.armed = true;
  const ComparisonResult result = run(a, b, 100);
  ASSERT_FALSE(result.identical);
  const FirstDifference& d = *result.first_difference;
  EXPECT_EQ(d.step, 67);
  ASSERT_GE(d.pass, 0);
  EXPECT_EQ(a.program().step[static_cast<std::size_t>(d.pass)].kernel, "brick_update");
  EXPECT_EQ(d.kernel, "brick_update");
  EXPECT_EQ(d.buffer, "node_w");
  EXPECT_EQ(d.index, static_cast<std::int64_t>(index));
  EXPECT_EQ(d.value_a.size(), 10U);
  EXPECT_NE(d.value_a, d.value_b);
  EXPECT_NE(d.message().find("brick_update"), std::string::npos) << d.message();
}

TEST_F(Compare, FindsAWrongInputBeforeTheFirstStep) {
  Simulation a(scene_, model_, open_backend("cpu")), b(scene_, model_, open_backend("cpu"));
  const BufferId fill = b.program().find("brick_fill");  // constant: looked at once
  std::vector<double> values = b.backend().read_reals(fill);
  values[17] = 0.25;
  b.backend().write_reals(fill, values);
  const ComparisonResult result = run(a, b, 3);
  ASSERT_FALSE(result.identical);
  EXPECT_EQ(result.first_difference->buffer, "brick_fill");
  EXPECT_EQ(result.first_difference->index, 17);
  EXPECT_EQ(result.first_difference->value_b, "0x3e800000");
  EXPECT_EQ(result.first_difference->decimal_b, "0.25");
  EXPECT_EQ(result.first_difference->pass, -1);
  EXPECT_EQ(result.steps, 0);
}

/// `va` and `vb` as value 5 of a buffer that the step does not write.
ComparisonResult with_values(const Scene& scene, const std::shared_ptr<const Model>& model, double va, double vb) {
  Simulation a(scene, model, open_backend("cpu")), b(scene, model, open_backend("cpu"));
  const BufferId force = a.program().find("node_force");
  std::vector<double> values = a.backend().read_reals(force);
  values[5] = va;
  a.backend().write_reals(force, values);
  values[5] = vb;
  b.backend().write_reals(force, values);
  CompareOptions options;
  options.steps = 0;
  return compare(a, b, options);
}

TEST_F(Compare, NanEqualsNanAndZeroHasASign) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double other = std::bit_cast<double>(std::bit_cast<std::uint64_t>(nan) ^ (std::uint64_t{0x8000100000000000}));
  ASSERT_NE(std::bit_cast<std::uint32_t>(static_cast<float>(nan)), std::bit_cast<std::uint32_t>(static_cast<float>(other)));
  EXPECT_TRUE(with_values(scene_, model_, nan, other).identical);
  EXPECT_FALSE(with_values(scene_, model_, nan, 1).identical);
  EXPECT_FALSE(with_values(scene_, model_, nan, std::numeric_limits<double>::infinity()).identical);
  EXPECT_FALSE(with_values(scene_, model_, 0.0, -0.0).identical);
  EXPECT_FALSE(with_values(scene_, model_, 1e-45, 0.0).identical);
}

TEST_F(Compare, IntegersThatLookLikeNanAreStillCompared) {
  Simulation a(scene_, model_, open_backend("cpu")), b(scene_, model_, open_backend("cpu"));
  const BufferId id = a.program().find("fault_summary");
  std::vector<std::int32_t> values = a.backend().read_ints(id);
  values[3] = 0x7fc00001;
  a.backend().write_ints(id, values);
  values[3] = 0x7fc00002;
  b.backend().write_ints(id, values);
  const ComparisonResult result = run(a, b, 0);
  ASSERT_FALSE(result.identical);
  EXPECT_EQ(result.first_difference->decimal_a, "2143289345");
}

/// Two runs that diverge are the same run only if they do so in the same step at the same element: on the twins and on the
/// device where there is one, and not where one of them began with another velocity.
TEST_F(Compare, BothMayDivergeAlike) {
  Simulation a = make(open_backend("cpu"));
  const double dt = 3 * a.stable_dt();
  for (const char* other : {"cpu", "opencl:0"}) {
    if (std::string(other) != "cpu" && !testing::has_opencl()) continue;
    Simulation unstable_a = make(open_backend("cpu"), dt), unstable_b = make(open_backend(other), dt);
    if (!unstable_b.backend().info().bit_exact) continue;
    const ComparisonResult result = run(unstable_a, unstable_b, 1000);
    EXPECT_TRUE(result.identical) << (result.first_difference ? result.first_difference->message() : "");
    ASSERT_TRUE(result.diverged.has_value());
    EXPECT_LT(result.steps, 1000);
    EXPECT_GE(result.steps, result.diverged->step);
    EXPECT_EQ(unstable_a.hash(), unstable_b.hash());
    EXPECT_EQ(unstable_a.divergence()->message(), unstable_b.divergence()->message());
  }
  Simulation diverges = make(open_backend("cpu"), dt), tampered = make(open_backend("cpu"), dt);
  std::vector<double> w = tampered.backend().read_reals(tampered.program().find("node_w"));
  w[4 * static_cast<std::size_t>(model_->bodies[0].slot[20])] += 1e-6;
  tampered.backend().write_reals(tampered.program().find("node_w"), w);
  EXPECT_FALSE(run(diverges, tampered, 1000).identical) << "both diverge, and not alike";
}

TEST_F(Compare, RefusesDoubleAndFindsDifferentSteps) {
  Simulation a = make(open_backend("cpu")), oracle = make(open_backend("cpu:double"), a.dt());
  EXPECT_THROW(compare(a, oracle), Error);
  Simulation slower = make(open_backend("cpu"), 0.5 * a.dt());
  EXPECT_FALSE(compare(a, slower).identical);
  slower.advance(1);
  EXPECT_THROW(compare(a, slower), Error);
}

TEST_F(Compare, StopsWhenAsked) {
  Simulation a = make(open_backend("cpu")), b = make(open_backend("cpu"));
  CompareOptions options;
  options.steps = 1000;
  options.progress = [](std::int64_t done) { return done < 128; };
  const ComparisonResult result = compare(a, b, options);
  EXPECT_TRUE(result.stopped);
  EXPECT_EQ(result.steps, 128);
}

}  // namespace
}  // namespace pliant
