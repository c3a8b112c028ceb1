#include "backends/interface/probe.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "backends/interface/float_environment.h"

namespace pliant {
namespace {

constexpr std::size_t case_count = 4096;
constexpr std::array<const char*, 17> real_names{"a * b + c",
                                                 "a * b - c",
                                                 "fma(a, b, c)",
                                                 "a / b",
                                                 "1 / a",
                                                 "sqrt(fabs(a))",
                                                 "a + b",
                                                 "a - b",
                                                 "a * b",
                                                 "floor(a)",
                                                 "rint(a)",
                                                 "copysign(a, b)",
                                                 "a < b ? a : b",
                                                 "a > b ? a : c",
                                                 "-a",
                                                 "(float)k",
                                                 "as_float(as_int(a) ^ (k & 255))"};
constexpr std::array<const char*, 5> int_names{"comparisons of a and b", "as_int(a)", "guarded (int)rint(a)",
                                               "(k * 3 + 7) ^ (k >> 2)", "(k & 255) << 3 | (k / 7 & 7)"};

struct Case {
  float a = 0, b = 0, c = 0;
  std::int32_t k = 0;
};

/// All pairs of values at which the result of an operation changes its class.
void add_special(std::vector<Case>& cases) {
  using limits = std::numeric_limits<float>;
  const float special[] = {0.0f, limits::denorm_min(), 1e-40f,        0x1.fffffcp-127f,   limits::min(),      0.5f, 1.0f, 1.5f,
                           2.5f, 8388607.5f,           limits::max(), limits::infinity(), limits::quiet_NaN()};
  std::int32_t k = -400;
  for (const float a : special) {
    for (const float b : special) {
      for (int sign = 0; sign < 4; ++sign) cases.push_back({sign & 1 ? -a : a, sign & 2 ? -b : b, sign & 1 ? -b : a, k++});
    }
  }
}

/// Products that cancel to their rounding error, and halfway cases that an fma through double would round twice.
void add_fma(std::vector<Case>& cases, std::mt19937& random) {
  std::uniform_real_distribution<float> mantissa(1.0f, 2.0f);
  for (int i = 0; i < 400; ++i) {
    const float a = mantissa(random), b = mantissa(random);
    cases.push_back({a, b, -(a * b), i - 200});
    cases.push_back({a, b, std::ldexp(a, -20), 7 * i});
  }
  for (int i = 1; i < 12; ++i) {
    const float a = 1 + std::ldexp(1.0f, -i), b = 1 + std::ldexp(1.0f, i - 24);
    for (const float tiny : {0x1p-60f, -0x1p-60f, 0x1p-140f, -0x1p-140f}) cases.push_back({a, b, tiny, i});
  }
}

/// Quotients and roots with random mantissas, and squares next to which the root lies almost halfway between two floats.
void add_divide_and_root(std::vector<Case>& cases, std::mt19937& random) {
  std::uniform_real_distribution<float> mantissa(1.0f, 4.0f);
  for (int i = 0; i < 500; ++i) {
    const float root = mantissa(random);
    const float square = root * root;
    cases.push_back({square, root, -square, -i});
    cases.push_back({std::nextafter(square, 0.0f), root, 1.0f, 3 * i});
  }
  std::uniform_int_distribution<int> exponent(-149, -120);
  for (int i = 0; i < 200; ++i) cases.push_back({std::ldexp(mantissa(random), exponent(random)), mantissa(random), 1e-39f, i});
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all = [] {
    const DefaultFloatEnvironment environment;
    std::vector<Case> list;
    std::mt19937 random(20240917);
    add_special(list);
    add_fma(list, random);
    add_divide_and_root(list, random);
    while (list.size() < case_count) {  // any bits, NaN made quiet on the way through double
      const auto bits = [&] { return static_cast<float>(double{std::bit_cast<float>(static_cast<std::uint32_t>(random()))}); };
      const float a = bits(), b = bits(), c = bits();
      list.push_back({a, b, c, static_cast<std::int32_t>(random() % 20001) - 10000});
    }
    return list;
  }();
  return all;
}

std::int32_t bit(bool condition, int n) { return condition ? 1 << n : 0; }

std::array<float, real_names.size()> expected_reals(const Case& q) {
  const float a = q.a, b = q.b, c = q.c;
  const float flipped = std::bit_cast<float>(std::bit_cast<std::int32_t>(a) ^ (q.k & 0xff));
  return {a * b + c,
          a * b - c,
          std::fma(a, b, c),
          a / b,
          1 / a,
          std::sqrt(std::fabs(a)),
          a + b,
          a - b,
          a * b,
          std::floor(a),
          std::rint(a),
          std::copysign(a, b),
          a < b ? a : b,
          a > b ? a : c,
          -a,
          static_cast<float>(q.k),
          flipped};
}

std::array<std::int32_t, int_names.size()> expected_ints(const Case& q) {
  const float a = q.a, b = q.b;
  const std::int32_t order = bit(a < b, 0) | bit(a <= b, 1) | bit(a == b, 2) | bit(a != b, 3) | bit(a > b, 4) | bit(a >= b, 5) |
                             bit(!(a > 0), 6) | bit(a == a, 7);
  const std::int32_t rounded = static_cast<std::int32_t>(std::fabs(a) < 1048576 ? std::rint(a) : 0.0f);
  return {order, a == a ? std::bit_cast<std::int32_t>(a) : 0, rounded, (q.k * 3 + 7) ^ (q.k >> 2),
          (q.k & 255) << 3 | (q.k / 7 & 7)};
}

Program make_probe_program() {
  Program program;
  Buffer a, b, c, k;
  a.name = "probe_a", b.name = "probe_b", c.name = "probe_c", k.name = "probe_k";
  k.type = BufferType::int32;
  for (Buffer* input : {&a, &b, &c, &k})
    input->count = case_count, input->role = BufferRole::constant, input->producer = "host";
  for (const Case& q : cases()) {
    a.reals.push_back(q.a);
    b.reals.push_back(q.b);
    c.reals.push_back(q.c);
    k.ints.push_back(q.k);
  }
  const BufferId in[] = {program.add(a), program.add(b), program.add(c), program.add(k)};
  for (const Shape shape : {Shape::lanes, Shape::items}) {
    const std::string suffix = shape == Shape::lanes ? "lanes" : "items";
    Buffer reals, ints;
    reals.name = "probe_reals_" + suffix, reals.count = real_names.size() * case_count, reals.producer = "probe";
    ints.name = "probe_ints_" + suffix, ints.count = int_names.size() * case_count, ints.producer = "probe";
    ints.type = BufferType::int32;
    Pass pass;
    pass.kernel = "probe", pass.label = "probe, " + suffix, pass.shape = shape, pass.count = case_count;
    for (const BufferId id : in) pass.args.push_back(buffer_arg(id));
    pass.args.push_back(buffer_arg(program.add(reals)));
    pass.args.push_back(buffer_arg(program.add(ints)));
    pass.args.push_back(int_arg(case_count));
    program.step.push_back(pass);
  }
  return program;
}

std::string input_text(const Case& q) {
  return fmt::format("a = {} (0x{:08x}), b = {} (0x{:08x}), c = {} (0x{:08x}), k = {}", q.a, std::bit_cast<std::uint32_t>(q.a),
                     q.b, std::bit_cast<std::uint32_t>(q.b), q.c, std::bit_cast<std::uint32_t>(q.c), q.k);
}

std::string describe(const std::string& operation, const Case& q, std::uint32_t got, std::uint32_t wanted, const Pass& pass) {
  return fmt::format("{} ({}) with {} gives 0x{:08x} instead of 0x{:08x}", operation, pass.label, input_text(q), got, wanted);
}

/// Returns the first difference of one pass, or an empty text.
std::string compare(const Pass& pass, Backend& backend) {
  const auto bytes = [&](std::size_t arg) { return backend.read_bytes(std::get<0>(pass.args[arg])); };
  const std::vector<std::uint8_t> real_bytes = bytes(4), int_bytes = bytes(5);
  std::vector<float> reals(real_bytes.size() / sizeof(float));
  std::vector<std::int32_t> ints(int_bytes.size() / sizeof(std::int32_t));
  std::memcpy(reals.data(), real_bytes.data(), real_bytes.size());
  std::memcpy(ints.data(), int_bytes.data(), int_bytes.size());
  for (std::size_t i = 0; i < case_count; ++i) {
    const Case& q = cases()[i];
    const auto real_answers = expected_reals(q);
    for (std::size_t n = 0; n < real_answers.size(); ++n) {
      const float got = reals[n * case_count + i], wanted = real_answers[n];
      const auto got_bits = std::bit_cast<std::uint32_t>(got), wanted_bits = std::bit_cast<std::uint32_t>(wanted);
      if (got_bits != wanted_bits && !(std::isnan(got) && std::isnan(wanted))) {
        return describe(real_names[n], q, got_bits, wanted_bits, pass);
      }
    }
    const auto int_answers = expected_ints(q);
    for (std::size_t n = 0; n < int_answers.size(); ++n) {
      const std::int32_t got = ints[n * case_count + i];
      if (got != int_answers[n]) {
        return describe(int_names[n], q, static_cast<std::uint32_t>(got), static_cast<std::uint32_t>(int_answers[n]), pass);
      }
    }
  }
  return {};
}

}  // namespace

const Program& probe_program() {
  static const Program program = make_probe_program();
  return program;
}

std::string run_probe(Backend& backend) {
  const DefaultFloatEnvironment environment;
  const Program& program = probe_program();
  backend.load(program);
  backend.run(program.step, 0, 1);
  backend.finish();
  for (const Pass& pass : program.step) {
    std::string difference = compare(pass, backend);
    if (!difference.empty()) return difference;
  }
  return {};
}

}  // namespace pliant
