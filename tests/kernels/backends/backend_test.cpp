// The backends themselves, on toy kernels with toy twins: arguments, shapes, transfers, timing and clear errors.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>

#include "backends/choice/backends.h"
#include "backends/interface/pass_table.h"
#include "backends/opencl/opencl_backend.h"
#include "backends/twins/check_backend.h"
#include "backends/twins/ref_backend.h"
#include "cpu_ref/registry.h"
#include "pliant/error.h"
#include "support/opencl.h"
#ifdef PLIANT_HAVE_OPENCL
#include "backends/opencl/kernel_text.h"
#include "backends/opencl/opencl_backend.h"
#endif

namespace pliant {
namespace {

// y = scale * x + y + step + bias + weight, by lanes.
[[maybe_unused]] constexpr const char* toy_axpy_text = R"(#include "arith.cl"
__kernel void toy_axpy(__global const float* x, float scale, int bias, __global float* y, int step, __global const int* weight) {
  const int i = FIRST_INDEX;
#if LANES == 16
  const real w = convert_float16(LOAD(weight, i));
#else
  const real w = (float)weight[i];
#endif
  STORE(fma((real)(scale), LOAD(x, i), LOAD(y, i)) + (float)(SIGN * (step + bias)) + w, y, i);
}
)";
template <class Scalar, int Positive>
void toy_axpy(ref::Range range, const Scalar* x, Scalar scale, std::int32_t bias, Scalar* y, std::int32_t step,
              const std::int32_t* weight) {
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    y[i] =
        std::fma(scale, x[i], y[i]) + static_cast<Scalar>((Positive ? 1 : 0) * (step + bias)) + static_cast<Scalar>(weight[i]);
  }
}

// One item: y[list[i]] = -x[list[i]].
[[maybe_unused]] constexpr const char* toy_list_text = R"(#include "arith.cl"
__kernel void toy_list(__global const float* x, __global const int* list, __global float* y) {
  const int n = list[get_global_id(0)];
  y[n] = -x[n];
}
)";
template <class Scalar>
void toy_list(ref::Range range, const Scalar* x, const std::int32_t* list, Scalar* y) {
  for (std::int64_t i = range.begin; i < range.end; ++i) y[list[i]] = -x[list[i]];
}

// A brick is 16 values; each becomes its own square plus the brick's number.
[[maybe_unused]] constexpr const char* toy_brick_text = R"(#include "arith.cl"
__kernel void toy_brick(__global const float* x, __global float* y) {
#if LANES == 16
  const int brick = get_global_id(0), i = 16 * brick;
#else
  const int i = get_global_id(0), brick = i / 16;
#endif
  const real v = LOAD(x, i);
  STORE(fma(v, v, (real)((float)brick)), y, i);
}
)";
template <class Scalar>
void toy_brick(ref::Range range, const Scalar* x, Scalar* y) {
  for (std::int64_t i = 16 * range.begin; i < 16 * range.end; ++i) y[i] = std::fma(x[i], x[i], static_cast<Scalar>(i / 16));
}

const ref::Registry& toy_twins() {
  static const ref::Registry registry = [] {
    ref::Registry r;
    r.add_specialised<2>("toy_axpy", {"SIGN"}, [](auto scalar, auto sign) { return toy_axpy<decltype(scalar), sign>; });
    r.add("toy_list", toy_list<float>, toy_list<double>);
    r.add("toy_brick", toy_brick<float>, toy_brick<double>);
    return r;
  }();
  return registry;
}

/// Buffers x, y, list, weight, out (bricks) of a size that leaves a remainder for every work-group size, and the three passes.
Program toy_program(std::int64_t count) {
  Program program;
  Buffer x, y, list, weight, out;
  x.name = "x", y.name = "y", list.name = "list", weight.name = "weight", out.name = "out";
  list.type = weight.type = BufferType::int32;
  x.role = list.role = weight.role = BufferRole::constant, y.role = BufferRole::state, y.carry = Carry::drop;
  x.count = y.count = weight.count = out.count = static_cast<std::size_t>(count);
  for (std::int64_t i = 0; i < count; ++i) {
    x.reals.push_back(0.1 * static_cast<double>(i % 1000) - 7);
    y.reals.push_back(1.0 / static_cast<double>(i + 3));
    weight.ints.push_back(static_cast<std::int32_t>(i % 5));
    if (i % 3 == 0) list.ints.push_back(static_cast<std::int32_t>(i));
  }
  list.count = list.ints.size();
  const BufferId x_id = program.add(x), y_id = program.add(y), list_id = program.add(list), weight_id = program.add(weight);
  const BufferId out_id = program.add(out);
  Pass axpy, negate, bricks;
  axpy.kernel = "toy_axpy", axpy.label = "axpy", axpy.defines = {{"SIGN", 1}}, axpy.count = count;
  axpy.args = {buffer_arg(x_id), real_arg(0.1), int_arg(-3), buffer_arg(y_id), step_arg(), buffer_arg(weight_id)};
  negate.kernel = "toy_list", negate.label = "list", negate.shape = Shape::items;
  negate.count = static_cast<std::int64_t>(list.count);
  negate.args = {buffer_arg(y_id), buffer_arg(list_id), buffer_arg(y_id)};
  bricks.kernel = "toy_brick", bricks.label = "bricks", bricks.shape = Shape::bricks, bricks.count = count / 16;
  bricks.args = {buffer_arg(y_id), buffer_arg(out_id)};
  program.step = {axpy, negate, bricks};
  program.status = {bricks};
  return program;
}

constexpr std::int64_t toy_count = 16 * 1237;  // 1237 is prime

std::unique_ptr<Backend> make_toy_ref(int threads = 0, bool double_precision = false) {
  RefOptions options;
  options.threads = threads;
  options.double_precision = double_precision;
  options.probe = false;
  options.registry = &toy_twins();
  return make_ref_backend(options);
}

OpenclOptions toy_options(int lanes = 0, int local_size = 0) {
  OpenclOptions options;
  options.lanes = lanes;
  options.local_size = local_size;
  options.probe = false;
  options.extra_kernels = {{"toy_axpy.cl", toy_axpy_text}, {"toy_list.cl", toy_list_text}, {"toy_brick.cl", toy_brick_text}};
  return options;
}
std::unique_ptr<Backend> make_toy_opencl() { return make_opencl_backend(0, toy_options()); }

/// The bytes of y and out after three steps, the last one pass by pass.
std::vector<std::vector<std::uint8_t>> run_toy(Backend& backend, std::int64_t count = toy_count) {
  const Program program = toy_program(count);
  backend.load(program);
  backend.run(program.step, 0, 2);
  for (const Pass& pass : program.step) backend.run(pass, 2);
  backend.finish();
  return {backend.read_bytes(program.find("y")), backend.read_bytes(program.find("out"))};
}

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "(no error)";
}

#define EXPECT_MENTIONS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

class EachBackend : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const std::string name = GetParam();
    if (name == "cpu") backend = make_toy_ref();
    if (name == "double") backend = make_toy_ref(0, true);
    if (name == "check") backend = make_check_backend({.probe = false, .registry = &toy_twins()});
    if (name == "opencl" && test::has_opencl()) backend = make_toy_opencl();
    if (backend == nullptr) GTEST_SKIP() << "there is no OpenCL device";
  }
  [[nodiscard]] bool is_double() const { return std::string(GetParam()) == "double"; }
  std::unique_ptr<Backend> backend;
};
INSTANTIATE_TEST_SUITE_P(Backends, EachBackend, testing::Values("cpu", "double", "check", "opencl"),
                         [](const auto& row) { return std::string(row.param); });

TEST_P(EachBackend, PassesArgumentsInOrderAndCountsSteps) {
  const Program program = toy_program(toy_count);
  backend->load(program);
  backend->run({program.step[0]}, 5, 2);  // a copy of a pass of the program; steps 5 and 6
  const auto y = backend->read_reals(program.find("y"));
  const auto real = [&](double v) { return is_double() ? v : double{static_cast<float>(v)}; };
  for (const std::size_t i : {std::size_t{0}, std::size_t{17}, std::size_t{toy_count - 1}}) {
    double expected = real(program.buffers[1].reals[i]);
    for (const int step : {5, 6}) {
      expected = real(std::fma(real(0.1), real(program.buffers[0].reals[i]), expected));
      expected = real(real(expected + (step - 3)) + program.buffers[3].ints[i]);
    }
    EXPECT_NEAR(y[i], expected, is_double() ? 1e-14 : 1e-6) << i;
  }
}

TEST_P(EachBackend, DefinesSelectTheVariant) {
  const Program program = toy_program(toy_count);
  backend->load(program);
  Pass pass = program.step[0];
  pass.defines = {{"SIGN", 0}};  // a pass that the program does not have is prepared on demand
  backend->run(pass, 1000);
  EXPECT_LT(backend->read_reals(program.find("y"))[5], 20);
}

TEST_P(EachBackend, TransfersRoundOnceAndWidenExactly) {
  const Program program = toy_program(32);
  backend->load(program);
  const BufferId y = program.find("y"), list = program.find("list");
  std::vector<double> values(32, 0.1);
  values[1] = -0.0, values[2] = 1e-45, values[3] = std::numeric_limits<double>::infinity();
  backend->write_reals(y, values);
  const auto back = backend->read_reals(y);
  EXPECT_EQ(back[0], is_double() ? 0.1 : double{0.1f});
  EXPECT_TRUE(std::signbit(back[1]));
  EXPECT_EQ(back[2], is_double() ? 1e-45 : double{1e-45f});
  EXPECT_TRUE(std::isinf(back[3]));
  EXPECT_EQ(backend->read_bytes(y).size(), 32u * (is_double() ? 8 : 4));
  backend->write_ints(list, std::vector<std::int32_t>(11, -7));
  EXPECT_EQ(backend->read_ints(list), std::vector<std::int32_t>(11, -7));
}

TEST_P(EachBackend, CopiesBuffers) {
  const Program program = toy_program(64);
  backend->load(program);
  backend->copy(program.find("x"), program.find("out"));
  EXPECT_EQ(backend->read_bytes(program.find("x")), backend->read_bytes(program.find("out")));
  EXPECT_MENTIONS(message_of([&] { backend->copy(program.find("x"), program.find("list")); }), "\"list\" differ in size");
}

TEST_P(EachBackend, MissingInitialValuesAreZeroAndBuffersMayBeEmpty) {
  Program program;
  Buffer some, none;
  some.name = "some", some.type = BufferType::real4, some.count = 3, some.reals = {1, 2};
  none.name = "none";
  program.add(some);
  program.add(none);
  backend->load(program);
  EXPECT_EQ(backend->read_reals(0), (std::vector<double>{1, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_TRUE(backend->read_reals(1).empty());
  EXPECT_TRUE(backend->read_bytes(1).empty());
}

TEST_P(EachBackend, ProfileCountsLaunchesPerPassAndOnlyWhenOn) {
  const Program program = toy_program(toy_count);
  backend->load(program);
  backend->run(program.step, 0, 3);
  EXPECT_TRUE(backend->take_profile().empty());
  backend->profile(true);
  const auto start = std::chrono::steady_clock::now();
  backend->run(program.step, 0, 3);
  const auto times = backend->take_profile();
  double left = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  ASSERT_EQ(times.size(), 3u);
  EXPECT_EQ(times[0].kernel, "toy_axpy");
  EXPECT_EQ(times[1].label, "list");
  for (const PassTime& time : times) {
    EXPECT_EQ(time.launches, 3) << time.kernel;
    EXPECT_GT(time.seconds, 0) << time.kernel;
    left -= time.seconds;
  }
  EXPECT_GE(left, 0) << "the passes ran one after the other, within the call";
  backend->profile(false);
  backend->run(program.step, 0, 1);
  EXPECT_TRUE(backend->take_profile().empty());
}

TEST_P(EachBackend, LoadsASecondProgram) {
  const auto alone = run_toy(*backend, 160);
  run_toy(*backend, 320);
  EXPECT_EQ(run_toy(*backend, 160), alone);
  EXPECT_EQ(alone[0].size(), 160u * (is_double() ? 8 : 4));
}

TEST_P(EachBackend, NamesWhatIsWrongInAPass) {
  Program program = toy_program(64);
  program.step[0].kernel = "toy_nothing";
  EXPECT_MENTIONS(message_of([&] { backend->load(program); }), "toy_nothing");
  program = toy_program(64);
  program.step[0].args.pop_back();
  EXPECT_MENTIONS(message_of([&] { backend->load(program); }), "5 arguments for 6 parameters");
  program = toy_program(64);
  program.step[0].args[0] = buffer_arg(99);
  EXPECT_MENTIONS(message_of([&] { backend->load(program); }), "names buffer 99, but the program has 5 buffers");
  program = toy_program(64);
  program.step[0].count = 17;
  EXPECT_MENTIONS(message_of([&] { backend->load(program); }), "count 17 is not a multiple of 16");
}

TEST_P(EachBackend, RefusesTransfersOfTheWrongSizeOrType) {
  const Program program = toy_program(64);
  backend->load(program);
  EXPECT_MENTIONS(message_of([&] { backend->write_reals(program.find("y"), {1, 2}); }), "\"y\" holds 64 values, received 2");
  EXPECT_MENTIONS(message_of([&] { (void)backend->read_ints(program.find("y")); }), "\"y\" holds reals");
  EXPECT_MENTIONS(message_of([&] { (void)backend->read_reals(program.find("list")); }), "\"list\" holds integers");
  EXPECT_MENTIONS(message_of([&] { (void)backend->read_bytes(77); }), "there is no buffer 77");
}

TEST(RefBackend, ThreadsChangeNoBit) {
  const auto one = run_toy(*make_toy_ref(1));
  for (const int threads : {2, 3, 8}) EXPECT_EQ(run_toy(*make_toy_ref(threads)), one) << threads << " threads";
}

TEST(RefBackend, SaysHowMuchMemoryIsNeeded) {
  RefOptions options;
  options.probe = false;
  options.registry = &toy_twins();
  options.memory_bytes = 2048;
  const auto backend = make_ref_backend(options);
  const Program program = toy_program(160);
  const std::string message = message_of([&] { backend->load(program); });
  EXPECT_MENTIONS(message, "it needs 2.71 KiB (2776 bytes), the device has 2.00 KiB (2048 bytes)");
  EXPECT_MENTIONS(message, "the largest buffer is \"x\"");
}

TEST(RefRegistry, NamesUnknownStemsAndDefines) {
  EXPECT_MENTIONS(message_of([] { (void)toy_twins().find("toy_axpi", {}); }), "there are: toy_axpy, toy_brick, toy_list");
  EXPECT_MENTIONS(message_of([] { (void)toy_twins().find("toy_axpy", {{"SIGN", 2}}); }), "has no SIGN=2; allowed are 0 to 1");
  EXPECT_MENTIONS(message_of([] { (void)toy_twins().find("toy_axpy", {}); }), "needs the define SIGN");
  EXPECT_MENTIONS(message_of([] { (void)toy_twins().find("toy_list", {{"LAW", 1}}); }), "knows no define LAW");
}

TEST(Backends, OpensByNameAndSaysWhy) {
  std::string why;
  EXPECT_EQ(open_backend("cpu", &why)->info().name, "cpu");
  EXPECT_MENTIONS(why, "requested");
  for (const char* name : {"cpu:double", "cpu:check"}) EXPECT_EQ(open_backend(name)->info().name, name);
  const auto chosen = open_backend("auto", &why);
  EXPECT_TRUE(chosen->info().bit_exact);
  EXPECT_EQ(why.rfind(chosen->info().name, 0), 0u) << why;
  const auto one_run = open_backend("auto", &why, 100, BackendUse::once);
  EXPECT_TRUE(one_run->info().kind == "gpu" || one_run->info().name == "cpu") << why;
  EXPECT_MENTIONS(message_of([] { open_backend("cuda"); }),
                  "allowed are auto, cpu, cpu:double, cpu:check, opencl and opencl:N");
  EXPECT_MENTIONS(message_of([] { open_backend("opencl:x"); }), "must be a number");
  EXPECT_EQ(list_backends().front().name, "cpu");
}

TEST(Backends, SayWhenTheBuildHasNoOpencl) {
  if (opencl_is_built_in()) GTEST_SKIP() << "this build has OpenCL";
  EXPECT_MENTIONS(message_of([] { open_backend("opencl"); }), "this build of Pliant has no OpenCL");
}

class OnOpencl : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::has_opencl()) GTEST_SKIP() << "there is no OpenCL device";
  }
};

TEST_F(OnOpencl, GivesTheTwinsBitsAtEveryLaneWidthAndLocalSize) {
  const auto twin = run_toy(*make_toy_ref());
  for (const int lanes : {1, 16}) {
    for (const int local_size : {0, 1, 4, 1237}) {
      EXPECT_EQ(run_toy(*make_opencl_backend(0, toy_options(lanes, local_size))), twin)
          << lanes << " lanes, local size " << local_size;
    }
  }
}

TEST_F(OnOpencl, SaysHowMuchMemoryIsNeeded) {
  OpenclOptions options = toy_options();
  options.memory_bytes = 2048;
  const Program program = toy_program(160);
  EXPECT_MENTIONS(message_of([&] { make_opencl_backend(0, options)->load(program); }),
                  "it needs 2.71 KiB (2776 bytes), the device has 2.00 KiB (2048 bytes)");
  options.memory_bytes = 0;
  options.max_buffer_bytes = 600;
  EXPECT_MENTIONS(message_of([&] { make_opencl_backend(0, options)->load(program); }),
                  "needs 640 bytes, the device allows 600 bytes in one allocation");
}

TEST_F(OnOpencl, ShowsTheLogOfAFailedBuild) {
  OpenclOptions options = toy_options();
  options.extra_kernels["toy_axpy.cl"] =
      "#include \"arith.cl\"\n\n__kernel void toy_axpy(__global float* x) { x[0] = undeclared_name; }\n";
  const auto backend = make_opencl_backend(0, options);
  const Program program = toy_program(64);
  const std::string message = message_of([&] { backend->load(program); });
  EXPECT_MENTIONS(message, "cannot build kernel \"toy_axpy\"");
  EXPECT_MENTIONS(message, "-D SIGN=1");
  EXPECT_MENTIONS(message, backend->info().platform == "NVIDIA CUDA" ? "<kernel>:" : "toy_axpy.cl:3");  // drops #line
  EXPECT_MENTIONS(message, "undeclared_name");
}

TEST_F(OnOpencl, NamesAMissingInclude) {
  OpenclOptions options = toy_options();
  options.extra_kernels["toy_axpy.cl"] = "#include \"nowhere.cl\"\n";
  const auto backend = make_opencl_backend(0, options);
  const Program program = toy_program(64);
  EXPECT_MENTIONS(message_of([&] { backend->load(program); }), "\"toy_axpy.cl\" includes \"nowhere.cl\", which does not exist");
}

TEST_F(OnOpencl, NamesTheDevicesThereAre) {
  EXPECT_MENTIONS(message_of([] { open_backend("opencl:4711"); }), "there is no OpenCL device 4711: allowed are opencl:0 to");
}

/// The loader reads its list of drivers once per process, so a process without a driver is another process: this one, started
/// again with OCL_ICD_VENDORS naming a folder that does not exist.
TEST(WithoutOpencl, ListIsEmptyAndAskingForItSaysWhatToInstall) {
  if (!opencl_is_built_in()) GTEST_SKIP() << "this build has no OpenCL";
  if (std::getenv("PLIANT_TEST_NO_DRIVER") == nullptr) {
    const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
    // Without the parent's shard: it need not be the one that this case falls into when it is alone.
    const std::string command =
        "env -u GTEST_TOTAL_SHARDS -u GTEST_SHARD_INDEX PLIANT_TEST_NO_DRIVER=1 OCL_ICD_VENDORS=/nonexistent/ \"" + self +
        "\" --gtest_filter='WithoutOpencl.*' --gtest_output= >/dev/null";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    return;
  }
  EXPECT_TRUE(list_opencl_devices().empty());
  EXPECT_MENTIONS(message_of([] { open_backend("opencl"); }), "the OpenCL loader found no platform");
  std::string why;
  EXPECT_EQ(open_backend("auto", &why)->info().name, "cpu");
  EXPECT_MENTIONS(why, "there is no OpenCL device");
}

}  // namespace
}  // namespace pliant
