// The known-answer probe passes on every backend, whatever the lane width and the work-group size, and it can fail.
#include "backends/interface/probe.h"

#include <gtest/gtest.h>

#include <cstring>

#include "backends/opencl/kernel_text.h"
#include "backends/opencl/opencl_backend.h"
#include "backends/twins/ref_backend.h"
#include "cpu_ref/registry.h"
#include "support/opencl.h"

namespace pliant {
namespace {

TEST(Probe, CpuReferenceIsBitExact) {
  const auto backend = make_ref_backend();
  EXPECT_TRUE(backend->info().bit_exact) << backend->info().tolerance_reason;
  EXPECT_EQ(backend->info().tolerance_reason, "");
}

TEST(Probe, DoubleIsNeverCalledBitExact) {
  RefOptions options;
  options.double_precision = true;
  const auto backend = make_ref_backend(options);
  EXPECT_FALSE(backend->info().bit_exact);
  EXPECT_NE(backend->info().tolerance_reason, "");
}

TEST(Probe, NamesTheFirstDifferenceOfAWrongTwin) {
  ref::Registry wrong;
  wrong.add("probe", [](const ref::Defines& defines) {
    ref::Twin twin = ref::registry().find("probe", defines);
    const auto right = twin.of_float.call;
    twin.of_float.call = [right](ref::Range range, const ref::ArgValue<float>* args) {
      right(range, args);
      float* fma_plane = args[4].reals + 2 * args[6].integer;
      fma_plane[700] += 0x1p-10f;
    };
    return twin;
  });
  RefOptions options;
  options.registry = &wrong;
  const auto backend = make_ref_backend(options);
  EXPECT_FALSE(backend->info().bit_exact);
  EXPECT_EQ(backend->info().tolerance_reason.rfind("fma(a, b, c) (probe, lanes) with a = ", 0), 0u)
      << backend->info().tolerance_reason;
}

class ProbeOnOpencl : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::has_opencl()) GTEST_SKIP() << "there is no OpenCL device";
  }
};

TEST_F(ProbeOnOpencl, PassesAtEveryLaneWidthAndLocalSize) {
  for (const int lanes : {1, 16}) {
    for (const int local_size : {0, 1, 8, 64}) {
      OpenclOptions options;
      options.lanes = lanes;
      options.local_size = local_size;
      const auto backend = make_opencl_backend(0, options);
      EXPECT_TRUE(backend->info().bit_exact)
          << "lanes " << lanes << ", local size " << local_size << ": " << backend->info().tolerance_reason;
    }
  }
}

TEST_F(ProbeOnOpencl, TwinGivesTheSameBits) {
  const Program& program = probe_program();
  const auto device = make_opencl_backend(0);
  const auto twin = make_ref_backend();
  for (Backend* backend : {device.get(), twin.get()}) {
    backend->load(program);
    backend->run(program.step, 0, 1);
    backend->finish();
  }
  for (std::size_t id = 0; id < program.buffers.size(); ++id) {
    const auto a = device->read_bytes(static_cast<BufferId>(id)), b = twin->read_bytes(static_cast<BufferId>(id));
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); i += 4) {
      float x = 0, y = 0;
      std::memcpy(&x, &a[i], 4);
      std::memcpy(&y, &b[i], 4);
      const bool both_nan = !program.buffers[id].is_int() && x != x && y != y;
      ASSERT_TRUE(both_nan || std::memcmp(&a[i], &b[i], 4) == 0) << program.buffers[id].name << " value " << i / 4;
    }
  }
}

/// A device that contracts must be caught; here a kernel that asks for it plays its part.
TEST_F(ProbeOnOpencl, CatchesAFusedMultiplyAdd) {
  OpenclOptions options;
  std::string fused = kernel_files().at("probe.cl");
  const std::string product = "x * y + z";
  fused.replace(fused.find(product), product.size(), "fma(x, y, z)");
  options.extra_kernels["probe.cl"] = fused;
  const auto backend = make_opencl_backend(0, options);
  EXPECT_FALSE(backend->info().bit_exact);
  EXPECT_EQ(backend->info().tolerance_reason.rfind("a * b + c (probe, lanes)", 0), 0u) << backend->info().tolerance_reason;
}

// Building costs a run of Clang's preprocessor even where PoCL has the kernel in its cache on disk.
TEST(SharedContext, ASecondBackendOnAProcessorBuildsNothingAnew) {
  if (!test::has_opencl()) GTEST_SKIP() << "there is no OpenCL device";
  const auto first = make_opencl_backend(0);
  if (first->info().kind != "cpu") GTEST_SKIP() << "only backends on a processor share what they build";
  const std::int64_t built = opencl_programs_built();
  EXPECT_GT(built, 0);
  const auto second = make_opencl_backend(0);
  EXPECT_EQ(opencl_programs_built(), built);
}

}  // namespace
}  // namespace pliant
