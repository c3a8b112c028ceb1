// fault_reduce: kernel and twin give the same bits, and find the first fault.
#include "kernels/random_data.h"

namespace pliant::kernel_test {
namespace {

class FaultReduce : public TwinTest {};

TEST_F(FaultReduce, TwinGivesTheSameBits) {
  std::uint32_t seed = 1200;
  for (const int elements : {16, 256, 5008}) {
    Random random(seed++);
    KernelCase test("fault_reduce", {}, Shape::items, 256);
    test.ints("fault", random.faults(static_cast<std::size_t>(elements)))
        .ints("fault_summary", Ints(1024, 7))
        .integer(elements);
    expect_same_bits(test, std::to_string(elements) + " elements");
  }
}

TEST(FaultReduceOracle, EarliestStepThenLowestElement) {
  Ints fault(1024, 0);
  fault[5] = 9;
  fault[5 + 256] = 4;
  fault[5 + 512] = 4;
  fault[6 + 512] = 2;
  fault[6 + 256] = -1;  // inverted
  fault[6 + 768] = -8;
  KernelCase test("fault_reduce", {}, Shape::items, 256);
  test.ints("fault", fault).ints("fault_summary", Ints(1024, 7)).integer(1024);
  RefOptions options;
  options.double_precision = true;
  const auto backend = make_ref_backend(options);
  backend->load(test.program());
  backend->run(test.pass(), 0);
  const Ints summary = backend->read_ints(1);
  Ints expected(1024, 0);
  expected[4 * 5] = 4;
  expected[4 * 5 + 1] = 5 + 256;
  expected[4 * 6] = 2;
  expected[4 * 6 + 1] = 6 + 512;
  expected[4 * 6 + 2] = 2;
  expected[4 * 6 + 3] = 6 + 256;
  EXPECT_EQ(summary, expected);
}

}  // namespace
}  // namespace pliant::kernel_test
