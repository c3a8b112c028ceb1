// The checking backend on toy twins, each of which does one thing that a pass may not do: what it names, to the word.
#include "backends/twins/check_backend.h"

#include <gtest/gtest.h>

#include <functional>
#include <numeric>

#include "backends/twins/ref_backend.h"
#include "cpu_ref/registry.h"
#include "pliant/error.h"

namespace pliant {
namespace {

/// to[i] = from[index[i]]
template <class Scalar>
void toy_gather(ref::Range range, const Scalar* from, const std::int32_t* index, Scalar* to) {
  for (std::int64_t i = range.begin; i < range.end; ++i) to[i] = from[index[i]];
}

/// to[index[i]] = from[i] + 1
template <class Scalar>
void toy_scatter(ref::Range range, const Scalar* from, const std::int32_t* index, Scalar* to) {
  for (std::int64_t i = range.begin; i < range.end; ++i) to[index[i]] = from[i] + 1;
}

/// Each value of `to` gets the sum of all of `from`, none of which counts.
template <class Scalar>
void toy_sum(ref::Range range, const Scalar* from, const std::int32_t* index, Scalar* to) {
  Scalar sum = 0;
  for (std::int64_t i = range.begin; i < range.end; ++i) sum += Scalar(0) * from[index[i]];
  for (std::int64_t i = range.begin; i < range.end; ++i) to[i] = sum;
}

/// Reads all of `from` and uses none.
template <class Scalar>
void toy_idle(ref::Range range, const Scalar* from, const std::int32_t*, Scalar* to) {
  for (std::int64_t i = range.begin; i < range.end; ++i) to[i] = from[i] == from[i] ? Scalar(3) : Scalar(3);
}

/// Writes where another pass once read: into a buffer that is none of its own.
template <class Scalar>
void toy_astray(ref::Range range, const Scalar* from, const std::int32_t*, Scalar* to) {
  static Scalar* seen = nullptr;
  if (range.end == 1) {
    seen = const_cast<Scalar*>(from);
    to[0] = Scalar(1);
  } else {
    seen[5] = Scalar(7);
    for (std::int64_t i = range.begin; i < range.end; ++i) to[i] = Scalar(1);
  }
}

const ref::Registry& toys() {
  static const ref::Registry registry = [] {
    ref::Registry r;
    r.add("toy_gather", toy_gather<float>, toy_gather<double>);
    r.add("toy_scatter", toy_scatter<float>, toy_scatter<double>);
    r.add("toy_sum", toy_sum<float>, toy_sum<double>);
    r.add("toy_idle", toy_idle<float>, toy_idle<double>);
    r.add("toy_astray", toy_astray<float>, toy_astray<double>);
    return r;
  }();
  return registry;
}

constexpr int kCount = 64;

/// Buffers given (constant), middle (scratch) and result (state) of kCount values, and passes between them.
class Toy {
 public:
  Toy() {
    given = add("given", BufferRole::constant);
    middle = add("middle", BufferRole::scratch);
    result = add("result", BufferRole::state);
    for (int i = 0; i < kCount; ++i) at(given).reals.push_back(0.5 * i);
  }
  BufferId add(const std::string& name, BufferRole role) {
    Buffer buffer;
    buffer.name = name, buffer.role = role, buffer.count = kCount;
    buffer.carry = Carry::drop;
    return program.add(std::move(buffer));
  }
  Buffer& at(BufferId id) { return program.at(id); }
  /// A pass over all values; its index list has `there` instead of `here`.
  Pass& pass(const std::string& kernel, BufferId from, BufferId to, int here = 0, int there = 0) {
    Buffer index;
    index.name = "index" + std::to_string(program.buffers.size());
    index.type = BufferType::int32, index.role = BufferRole::constant, index.count = kCount;
    index.ints.resize(kCount);
    std::iota(index.ints.begin(), index.ints.end(), 0);
    index.ints[static_cast<std::size_t>(here)] = there;
    Pass pass;
    pass.kernel = kernel, pass.label = "toy", pass.shape = Shape::items, pass.count = kCount;
    pass.args = {buffer_arg(from), buffer_arg(program.add(index)), buffer_arg(to)};
    return program.step.emplace_back(pass);
  }

  /// What it says about these steps of a run.
  std::string verdict(std::int32_t steps = 1, std::int64_t origin = 0) {
    const auto backend = make_check_backend({.probe = false, .registry = &toys()});
    backend->load(program);
    try {
      backend->run(program.step, 0, steps, origin);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::internal);
      return error.what();
    }
    RefOptions plain;
    plain.probe = false;
    plain.registry = &toys();
    const auto cpu = make_ref_backend(plain);
    cpu->load(program);
    cpu->run(program.step, 0, steps, origin);
    EXPECT_EQ(backend->read_bytes(result), cpu->read_bytes(result));
    return "nothing";
  }

  Program program;
  BufferId given, middle, result;
};

TEST(CheckBackend, HasNothingToSayAboutPassesThatWriteBeforeTheyRead) {
  Toy toy;
  toy.pass("toy_scatter", toy.given, toy.middle);
  toy.pass("toy_gather", toy.middle, toy.result);
  toy.pass("toy_scatter", toy.result, toy.result);
  EXPECT_EQ(toy.verdict(3), "nothing");
}

TEST(CheckBackend, NamesThePassThatReadWhatNoPassWrote) {
  Toy toy;
  toy.pass("toy_scatter", toy.given, toy.middle, 42, 41);  // value 42 is left out
  toy.pass("toy_gather", toy.middle, toy.result, 7, 8);
  EXPECT_EQ(toy.verdict(4, 12),
            "pass 1 (toy_gather, toy) in step 13 read value 42 of middle, which no pass had written: value 42 of result "
            "depends on it");
}

TEST(CheckBackend, NamesTheFirstOfSeveralValuesAlsoWhereTheyCountNothing) {
  Toy toy;
  toy.pass("toy_scatter", toy.given, toy.middle, 42, 41);
  toy.program.step.back().count = 50;  // 42 and 50 to 63 are left out
  toy.pass("toy_sum", toy.middle, toy.result);
  EXPECT_EQ(toy.verdict(),
            "pass 1 (toy_sum, toy) in step 1 read value 42 of middle, which no pass had written: value 0 of result depends on "
            "it");
}

TEST(CheckBackend, LetsAPassReadWhatItDoesNotUse) {
  Toy toy;
  toy.pass("toy_idle", toy.middle, toy.result);
  EXPECT_EQ(toy.verdict(2), "nothing");
}

TEST(CheckBackend, TakesACopyOfAnUnwrittenValueForARead) {
  Toy toy;
  const BufferId other = toy.add("other", BufferRole::scratch);
  toy.pass("toy_gather", toy.middle, other);
  toy.pass("toy_scatter", toy.given, other);
  toy.pass("toy_gather", other, toy.result);
  EXPECT_EQ(toy.verdict(),
            "pass 0 (toy_gather, toy) in step 1 read value 0 of middle, which no pass had written: value 0 of other depends on "
            "it");
}

TEST(CheckBackend, TakesACopyWithinABufferForARead) {
  Toy toy;
  toy.pass("toy_gather", toy.middle, toy.middle, 3, 5);
  toy.pass("toy_scatter", toy.given, toy.middle);
  EXPECT_EQ(
      toy.verdict(),
      "pass 0 (toy_gather, toy) in step 1 read value 5 of middle, which no pass had written: value 3 of middle depends on "
      "it");
}

TEST(CheckBackend, NamesAnUnwrittenIndex) {
  Toy toy;
  toy.pass("toy_gather", toy.given, toy.result);
  toy.program.buffers.back().role = BufferRole::scratch;
  EXPECT_EQ(toy.verdict(),
            "pass 0 (toy_gather, toy) in step 1 read value 0 of index3, which no pass had written: value 0 of result depends "
            "on it");
}

TEST(CheckBackend, NamesWhatTheHostReadsAndNoPassWrote) {
  Toy toy;
  toy.pass("toy_scatter", toy.given, toy.middle, 42, 41);
  const auto backend = make_check_backend({.probe = false, .registry = &toys()});
  backend->load(toy.program);
  EXPECT_EQ(backend->read_reals(toy.middle)[42], 0);  // its initial value
  backend->run(toy.program.step, 0, 1);
  for (const auto& read : {std::function([&] { (void)backend->read_reals(toy.middle); }),
                           std::function([&] { (void)backend->read_bytes(toy.middle); })}) {
    try {
      read();
      ADD_FAILURE() << "nothing thrown";
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()), "the host read value 42 of middle, which no pass had written");
    }
  }
}

TEST(CheckBackend, AsksForWhatAStepBeforeWroteOnlyWhereTheTableSaysSo) {
  const auto verdict = [](Carried carried, int left_out) {
    Toy toy;
    toy.at(toy.middle).carried = carried;
    toy.pass("toy_scatter", toy.given, toy.middle, left_out, 1).every = 2;
    toy.pass("toy_gather", toy.middle, toy.result);
    return toy.verdict(2);
  };
  const std::string stale =
      "pass 1 (toy_gather, toy) in step 2 read value 0 of middle, which no pass had written: value 0 of "
      "result depends on it";
  EXPECT_EQ(verdict(Carried::nothing, 1), stale);
  EXPECT_EQ(verdict(Carried::unwritten, 1), stale);
  EXPECT_EQ(verdict(Carried::all, 1), "nothing");

  Toy toy;
  toy.at(toy.middle).carried = Carried::unwritten;
  toy.pass("toy_scatter", toy.given, toy.middle, 42, 41);  // its initial zero is read
  toy.pass("toy_gather", toy.middle, toy.result);
  EXPECT_EQ(toy.verdict(3), "nothing");
}

TEST(CheckBackend, LetsTheFixedEndOfScratchBeReadAndNotWritten) {
  Toy toy;
  toy.at(toy.middle).padding = -0.0;
  toy.at(toy.middle).fixed = 2;
  toy.pass("toy_scatter", toy.given, toy.middle).count = kCount - 2;
  toy.pass("toy_gather", toy.middle, toy.result);
  EXPECT_EQ(toy.verdict(3), "nothing");
  toy.program.step[0].count = kCount - 1;
  EXPECT_EQ(toy.verdict(3),
            "pass 0 (toy_scatter, toy) in step 1 changed value 62 of middle, which lies in its end that no pass writes");
}

TEST(CheckBackend, NamesThePassThatChangesWhatOnlyTheHostWrites) {
  for (const BufferRole role : {BufferRole::constant, BufferRole::control}) {
    Toy toy;
    toy.at(toy.given).role = role;
    toy.pass("toy_gather", toy.given, toy.middle);
    toy.pass("toy_scatter", toy.middle, toy.given).count = 1;
    EXPECT_EQ(toy.verdict(2), "pass 1 (toy_scatter, toy) in step 1 changed value 0 of given, which only the host writes");
  }
}

TEST(CheckBackend, NamesThePassThatWritesOutsideABuffer) {
  for (const int there : {-1, kCount, -200, kCount + 200}) {
    Toy toy;
    toy.pass("toy_scatter", toy.given, toy.middle, 9, there);
    EXPECT_EQ(toy.verdict(),
              "pass 0 (toy_scatter, toy) in step 1 wrote value " + std::to_string(there) + " of middle, outside its 64 values");
  }
}

TEST(CheckBackend, NamesThePassThatReadsOutsideABuffer) {
  for (const int there : {-1, kCount}) {
    Toy toy;
    toy.pass("toy_gather", toy.given, toy.middle, 9, there);
    EXPECT_EQ(toy.verdict(), "pass 0 (toy_gather, toy) in step 1 read value " + std::to_string(there) +
                                 " of given, outside its 64 values: value 9 of middle depends on it");
  }
}

TEST(CheckBackend, NoticesAWriteIntoABufferThatIsNoArgument) {
  Toy toy;
  const BufferId other = toy.add("other", BufferRole::scratch);
  toy.pass("toy_astray", toy.given, other).count = 1;
  toy.pass("toy_astray", toy.result, other);
  EXPECT_EQ(toy.verdict(),
            "a pass in step 1 that does not name it as an argument changed value 5 of given, which only the host writes");
}

TEST(CheckBackend, TakesWhatTheHostWritesAndCopies) {
  Toy toy;
  toy.pass("toy_gather", toy.given, toy.result);
  const auto backend = make_check_backend({.probe = false, .registry = &toys()});
  backend->load(toy.program);
  backend->write_reals(toy.given, std::vector<double>(kCount, 0.1));
  backend->run(toy.program.step, 0, 2);
  EXPECT_EQ(backend->read_reals(toy.result)[5], double{0.1f});
  backend->write_reals(toy.result, std::vector<double>(kCount, 4));
  backend->copy(toy.result, toy.given);
  backend->run(toy.program.step[0], 0);
  EXPECT_EQ(backend->read_reals(toy.result)[5], 4);
}

}  // namespace
}  // namespace pliant
