// Writes that nothing waits for: all arrive, in order, whatever becomes of the caller's memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "backends/choice/backends.h"
#include "schedule/program_builder.h"
#include "support/opencl.h"

namespace pliant {
namespace {

class WriteOrder : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Backends, WriteOrder, testing::Values("cpu", "cpu:double", "cpu:check", "opencl:0"),
                         [](const auto& row) {
                           std::string name = row.param;
                           for (char& c : name) c = c == ':' ? '_' : c;
                           return name;
                         });

/// More writes than a backend sets aside before it waits, from memory that is used again at once.
TEST_P(WriteOrder, WritesArriveInOrder) {
  if (std::string(GetParam()) == "opencl:0" && !test::has_opencl()) GTEST_SKIP() << "there is no OpenCL device";
  const auto backend = open_backend(GetParam());
  Program program;
  const BufferId x = program.add(make_reals("x", BufferType::real, 64, BufferRole::scratch, "[64]", "1", "test"));
  const BufferId y = program.add(make_reals("y", BufferType::real, 64, BufferRole::scratch, "[64]", "1", "test"));
  backend->load(program);
  std::vector<double> values(64);
  for (int k = 1; k <= 700; ++k) {
    std::fill(values.begin(), values.end(), k);
    backend->write_reals(x, values);
    if (k % 50 == 49) backend->copy(x, y);
    if (k % 350 == 0) {
      EXPECT_EQ(backend->read_reals(x), values);
      EXPECT_EQ(backend->read_reals(y), std::vector<double>(64, k - 1)) << k;
    }
  }
}

}  // namespace
}  // namespace pliant
