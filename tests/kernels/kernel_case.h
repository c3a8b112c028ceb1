// One kernel launch on data of its own, run on every backend and compared as bits.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "backends/interface/backend.h"
#include "backends/opencl/opencl_backend.h"
#include "backends/twins/ref_backend.h"
#include "program/program.h"
#include "support/opencl.h"

namespace pliant::kernel_test {

using Reals = std::vector<double>;
using Ints = std::vector<std::int32_t>;
using Defines = std::vector<std::pair<std::string, int>>;

/// A program of one pass. Arguments are added in the kernel's order; real values are rounded to float first, so that the double
/// twin sees the same numbers.
class KernelCase {
 public:
  KernelCase(std::string stem, Defines defines, Shape shape, std::size_t count) {
    pass_.kernel = std::move(stem);
    pass_.label = pass_.kernel;
    pass_.defines = std::move(defines);
    pass_.shape = shape;
    pass_.count = static_cast<std::int64_t>(count);
  }
  KernelCase& reals(const std::string& name, Reals values) {
    for (double& v : values) {
      const volatile float nearest = static_cast<float>(v);  // g++ 12 -O3 leaves the end of a vectorised round trip unrounded
      v = static_cast<double>(nearest);
    }
    Buffer b;
    b.name = name;
    b.count = values.size();
    b.reals = std::move(values);
    return add(std::move(b));
  }
  KernelCase& ints(const std::string& name, Ints values) {
    Buffer b;
    b.name = name;
    b.type = BufferType::int32;
    b.count = values.size();
    b.ints = std::move(values);
    return add(std::move(b));
  }
  KernelCase& real(double value) { return argument(real_arg(static_cast<double>(static_cast<float>(value)))); }
  KernelCase& integer(std::int32_t value) { return argument(int_arg(value)); }
  KernelCase& step() { return argument(step_arg()); }
  /// A value that an oracle needs at full precision: the double twin's own, not rounded to float.
  KernelCase& exact(double value) { return argument(real_arg(value)); }
  KernelCase& exact(const std::string& name, Reals values) {
    Buffer b;
    b.name = name;
    b.count = values.size();
    b.reals = std::move(values);
    return add(std::move(b));
  }

  [[nodiscard]] const Program& program() const { return program_; }
  [[nodiscard]] const Pass& pass() const { return pass_; }

 private:
  KernelCase& add(Buffer buffer) {
    const BufferId id = program_.add(std::move(buffer));
    return argument(buffer_arg(id));
  }
  KernelCase& argument(Arg arg) {
    pass_.args.push_back(arg);
    return *this;
  }
  Program program_;
  Pass pass_;
};

/// The step of the batch in which every case runs.
constexpr std::int32_t test_step = 2;

struct NamedBackend {
  std::string name;
  std::unique_ptr<Backend> backend;
};

/// Every OpenCL device with 1 and 16 lanes and several work-group sizes, and the float twin on 2 and 3 threads.
inline std::vector<NamedBackend>& backends_under_test() {
  static std::vector<NamedBackend> all = [] {
    std::vector<NamedBackend> list;
    for (const int threads : {2, 3}) {
      RefOptions options;
      options.threads = threads;
      options.probe = false;
      list.push_back({"cpu_ref, " + std::to_string(threads) + " threads", make_ref_backend(options)});
    }
    const auto devices = list_opencl_devices(false);
    for (std::size_t i = 0; i < devices.size(); ++i) {
      for (const auto& [lanes, local] : {std::array{1, 1}, std::array{1, 32}, std::array{16, 1}, std::array{16, 4}}) {
        OpenclOptions options;
        options.lanes = lanes;
        options.local_size = local;
        options.probe = false;
        list.push_back(
            {"opencl:" + std::to_string(i) + ", " + std::to_string(lanes) + " lanes, local size " + std::to_string(local),
             make_opencl_backend(static_cast<int>(i), options)});
      }
    }
    return list;
  }();
  return all;
}

/// Bits of every buffer after the pass.
inline std::vector<std::vector<std::uint32_t>> run_for_bits(Backend& backend, const KernelCase& test) {
  backend.load(test.program());
  backend.run(test.pass(), test_step);
  backend.finish();
  std::vector<std::vector<std::uint32_t>> bits;
  for (std::size_t id = 0; id < test.program().buffers.size(); ++id) {
    const auto bytes = backend.read_bytes(static_cast<BufferId>(id));
    bits.emplace_back(bytes.size() / sizeof(std::uint32_t));
    if (!bytes.empty()) std::memcpy(bits.back().data(), bytes.data(), bytes.size());
  }
  return bits;
}

inline bool is_nan(std::uint32_t bits) { return (bits & 0x7fffffffU) > 0x7f800000U; }

/// Where two results first differ, or "". NaN equals NaN; everything else counts as bits.
inline std::string first_difference(const Program& program, const std::vector<std::vector<std::uint32_t>>& expected,
                                    const std::vector<std::vector<std::uint32_t>>& actual) {
  for (std::size_t b = 0; b < expected.size(); ++b) {
    const Buffer& row = program.buffers[b];
    if (expected[b].size() != actual[b].size()) return row.name + " differs in size";
    for (std::size_t i = 0; i < expected[b].size(); ++i) {
      if (expected[b][i] == actual[b][i]) continue;
      if (!row.is_int() && is_nan(expected[b][i]) && is_nan(actual[b][i])) continue;
      char text[96];
      std::snprintf(text, sizeof text, "%s[%zu]: expected %08x, got %08x", row.name.c_str(), i, expected[b][i], actual[b][i]);
      return text;
    }
  }
  return "";
}

/// Counts what was compared and prints it when the test ends.
class TwinTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::has_opencl()) GTEST_SKIP() << "no OpenCL device: the kernels cannot be compared with their twins";
  }
  void TearDown() override {
    if (values_ > 0) std::cout << "             " << values_ << " values compared in " << cases_ << " cases\n";
  }
  /// Compares every backend with the single-threaded float twin. Returns that twin's bits.
  std::vector<std::vector<std::uint32_t>> expect_same_bits(const KernelCase& test, const std::string& label) {
    static const auto reference = [] {
      RefOptions options;
      options.threads = 1;
      options.probe = false;
      return make_ref_backend(options);
    }();
    const auto expected = run_for_bits(*reference, test);
    std::string defines;
    for (const auto& [name, value] : test.pass().defines) defines += " " + name + "=" + std::to_string(value);
    for (NamedBackend& b : backends_under_test()) {
      const std::string difference = first_difference(test.program(), expected, run_for_bits(*b.backend, test));
      EXPECT_EQ(difference, "") << test.pass().kernel << defines << ", " << label << ", on " << b.name;
      for (const auto& buffer : expected) values_ += buffer.size();
    }
    ++cases_;
    return expected;
  }

 private:
  std::size_t values_ = 0, cases_ = 0;
};

/// The named buffer after the pass in a twin.
inline Reals run_in_twin(const KernelCase& test, const std::string& name, bool double_precision) {
  RefOptions options;
  options.double_precision = double_precision;
  options.threads = 1;
  const auto backend = make_ref_backend(options);
  backend->load(test.program());
  backend->run(test.pass(), test_step);
  backend->finish();
  return backend->read_reals(test.program().find(name));
}

inline Reals run_in_double(const KernelCase& test, const std::string& name) { return run_in_twin(test, name, true); }
inline Reals run_in_float(const KernelCase& test, const std::string& name) { return run_in_twin(test, name, false); }

}  // namespace pliant::kernel_test
