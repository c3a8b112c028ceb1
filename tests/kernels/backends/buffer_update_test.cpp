// What a backend holds after an update or an extension, and which values an update sends.
#include <random>

#include "backends/interface/buffer_checks.h"
#include "kernels/kernel_case.h"
#include "pliant/error.h"

namespace pliant::kernel_test {
namespace {

Buffer constant_reals(std::vector<double> values, std::size_t count) {
  Buffer b;
  b.name = "values";
  b.role = BufferRole::constant;
  b.count = count;
  b.reals = std::move(values);
  return b;
}

Program program_of(Buffer buffer) {
  Program program;
  program.add(std::move(buffer));
  return program;
}

/// The values of a buffer, padding included.
std::vector<double> all_values(const Buffer& b) {
  std::vector<double> all = b.reals;
  all.resize(b.values(), b.padding);
  return all;
}

TEST(BufferUpdate, ReplacesWhatTheHostWrote) {
  std::vector<double> first(5000);
  for (std::size_t i = 0; i < first.size(); ++i) first[i] = static_cast<double>(i);
  std::vector<double> second = first;
  second[7] = -1;
  const Program before = program_of(constant_reals(first, first.size()));
  const Program next = program_of(constant_reals(second, second.size()));
  for (const auto& [name, backend] : backends_under_test()) {
    backend->load(before);
    backend->write_reals(0, std::vector<double>(first.size(), 77));
    backend->update(before, next);
    EXPECT_EQ(backend->read_reals(0), second) << name;
  }
}

TEST(BufferUpdate, AnExtensionBelongsToAProgramOfItsSize) {
  Program program = program_of(constant_reals({1, 2, 3}, 3));
  for (const auto& [name, backend] : backends_under_test()) {
    backend->load(program);
    for (const std::int32_t first : {0, 2}) {
      Program extension;
      extension.first = first;
      EXPECT_THROW(backend->extend(nullptr, extension), Error) << name << ": from buffer " << first << " on";
    }
    EXPECT_EQ(backend->read_reals(0), (std::vector<double>{1, 2, 3})) << name;
  }
}

/// What is sent makes the values before into those after, and no more is sent than that takes and a gap of 1024.
TEST(ChangedValues, MakeTheBufferBeforeIntoTheNext) {
  std::mt19937 random(3);
  const auto pick = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  for (int trial = 0; trial < 300; ++trial) {
    const std::size_t count = 1 + pick(6000), next_count = pick(3) == 0 ? 1 + pick(6000) : count;
    std::vector<double> values(count);
    for (double& v : values) v = static_cast<double>(pick(1000));
    Buffer before = constant_reals(values, count);
    values.resize(next_count, 5);
    std::vector<std::size_t> places{next_count - 1};  // the last value changes too, now and then alone
    for (std::size_t k = pick(3); k > 0; --k) places.push_back(pick(next_count));
    for (const std::size_t at : places) values[at] += 0.5;
    Buffer next = constant_reals(values, next_count);
    before.padding = next.padding = 5;
    std::vector<double> held = all_values(before);
    held.resize(next.values(), NAN);
    const std::vector<double> wanted = all_values(next);
    std::size_t last = 0, sent = 0;
    for (const ValueRange& range : changed_values(before, next)) {
      ASSERT_LT(range.first, range.last);
      ASSERT_TRUE(last == 0 || range.first > last + 1024) << "ranges are apart, and in order";
      ASSERT_LE(range.last, wanted.size());
      for (std::size_t i = range.first; i < range.last; ++i) held[i] = wanted[i];
      last = range.last;
      sent += range.last - range.first;
    }
    ASSERT_EQ(held, wanted) << "trial " << trial;
    if (next_count == count) {
      EXPECT_LE(sent, places.size() * (32 + 1024));
    }
  }
}

}  // namespace
}  // namespace pliant::kernel_test
