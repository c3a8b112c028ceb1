// Every kernel has a twin, a file of its own for it and a test; and no kernel calls what the bit-exactness contract forbids.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "cpu_ref/registry.h"
#include "support/source_dir.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

const fs::path root = test::source_dir();

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Blanks comments and keeps the line breaks.
std::string without_comments(std::string text) {
  enum class State { code, line, block } state = State::code;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool pair = i + 1 < text.size();
    if (state == State::code && pair && text[i] == '/' && text[i + 1] == '/') state = State::line;
    if (state == State::code && pair && text[i] == '/' && text[i + 1] == '*') state = State::block;
    if (state == State::block && pair && text[i] == '*' && text[i + 1] == '/') {
      text[i] = text[i + 1] = ' ';
      state = State::code;
    }
    if (text[i] == '\n') {
      if (state == State::line) state = State::code;
    } else if (state != State::code) {
      text[i] = ' ';
    }
  }
  return text;
}

std::vector<fs::path> kernel_files() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(root / "kernels")) {
    if (entry.path().extension() == ".cl") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Its twin and its test stand on the shelf of the same name.
fs::path twin_of(const fs::path& kernel) {
  return (root / "cpu_ref" / fs::relative(kernel, root / "kernels")).replace_extension(".cpp");
}
fs::path test_of(const fs::path& kernel) {
  const fs::path shelf = fs::relative(kernel, root / "kernels").parent_path();
  return root / "tests/kernels" / shelf / (kernel.stem().string() + "_test.cpp");
}

/// "kernel(parameter names)" of every __kernel in the text: names in order, without types.
struct Signature {
  std::string name;
  std::vector<std::string> parameters;
};

Signature parse_signature(const std::string& name, const std::string& list) {
  static const std::regex last_word(R"((\w+)\s*$)");
  Signature signature{name, {}};
  std::size_t begin = 0;
  while (begin <= list.size()) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string parameter = list.substr(begin, end - begin);
    std::smatch match;
    if (std::regex_search(parameter, match, last_word)) signature.parameters.push_back(match[1]);
    begin = end + 1;
  }
  return signature;
}

std::vector<Signature> kernels_of(const fs::path& path) {
  static const std::regex declaration(R"(__kernel\s+void\s+(\w+)\s*\(([^)]*)\))");
  const std::string text = without_comments(text_of(path));
  std::vector<Signature> kernels;
  for (std::sregex_iterator it(text.begin(), text.end(), declaration), end; it != end; ++it) {
    kernels.push_back(parse_signature((*it)[1], (*it)[2]));
  }
  return kernels;
}

TEST(TwinTable, EveryKernelHasItsStemATwinAndATest) {
  const std::vector<std::string> known = ref::registry().stems();
  std::set<std::string> twins(known.begin(), known.end());
  std::size_t kernels = 0;
  for (const fs::path& path : kernel_files()) {
    const std::string stem = path.stem().string();
    const auto found = kernels_of(path);
    if (without_comments(text_of(path)).find("__kernel") == std::string::npos) continue;  // a fragment
    ++kernels;
    ASSERT_EQ(found.size(), 1U) << path << " must hold exactly one __kernel";
    EXPECT_EQ(found[0].name, stem) << path << ": the kernel must bear the file's name";
    EXPECT_EQ(twins.erase(stem), 1U) << "no twin is registered for " << stem << " (PLIANT_TWINS in cpu_ref/registry.cpp)";
    EXPECT_TRUE(fs::exists(twin_of(path))) << twin_of(path) << " is missing";
    EXPECT_TRUE(fs::exists(test_of(path))) << test_of(path) << " is missing";
  }
  EXPECT_GE(kernels, 13U);
  for (const std::string& stem : twins) ADD_FAILURE() << "the twin " << stem << " has no kernels/" << stem << ".cl";
}

TEST(TwinTable, ArgumentsMatchInNameAndOrder) {
  for (const fs::path& path : kernel_files()) {
    for (const Signature& kernel : kernels_of(path)) {
      const std::string text = without_comments(text_of(twin_of(path)));
      const std::regex declaration("void\\s+" + kernel.name + R"(\s*\(\s*Range\s+range\s*,([^)]*)\))");
      std::smatch match;
      ASSERT_TRUE(std::regex_search(text, match, declaration)) << twin_of(path) << ": no twin taking a Range";
      EXPECT_EQ(parse_signature(kernel.name, match[1]).parameters, kernel.parameters) << kernel.name;
    }
  }
}

/// Calls of `text` that the contract forbids (docs/determinism.md).
std::vector<std::string> forbidden_calls(const std::string& text) {
  static const std::set<std::string> forbidden{"dot",           "cross",
                                               "length",        "normalize",
                                               "distance",      "mix",
                                               "min",           "max",
                                               "fmin",          "fmax",
                                               "clamp",         "rsqrt",
                                               "mad",           "mad24",
                                               "cbrt",          "pow",
                                               "pown",          "powr",
                                               "rootn",         "exp",
                                               "exp2",          "exp10",
                                               "expm1",         "log",
                                               "log2",          "log10",
                                               "log1p",         "logb",
                                               "sin",           "cos",
                                               "tan",           "asin",
                                               "acos",          "atan",
                                               "atan2",         "sinh",
                                               "cosh",          "tanh",
                                               "sincos",        "asinh",
                                               "acosh",         "atanh",
                                               "hypot",         "erf",
                                               "erfc",          "tgamma",
                                               "lgamma",        "smoothstep",
                                               "step",          "sign",
                                               "fdim",          "fmod",
                                               "remainder",     "fract",
                                               "maxmag",        "minmag",
                                               "sinpi",         "cospi",
                                               "tanpi",         "ldexp",
                                               "fast_length",   "fast_normalize",
                                               "fast_distance", "convert_int",
                                               "convert_int16"};
  static const std::regex call(R"(\b([A-Za-z_]\w*)\s*\()");
  static const std::regex prefix("(native|half|atomic|atom)_\\w+");
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), call), end; it != end; ++it) {
    const std::string name = (*it)[1];
    if (forbidden.count(name) != 0 || std::regex_match(name, prefix)) found.push_back(name);
  }
  return found;
}

TEST(KernelSource, CallsNothingThatTheContractForbids) {
  for (const fs::path& path : kernel_files()) {
    for (const std::string& name : forbidden_calls(without_comments(text_of(path)))) {
      ADD_FAILURE() << path.filename() << " calls " << name << "(), whose bits depend on the device (docs/determinism.md)";
    }
  }
}

TEST(KernelSource, TheScanSeesWhatIsForbiddenAndOnlyThat) {
  EXPECT_EQ(forbidden_calls("x = native_recip(y) + dot(a, b); atomic_add(p, 1); v = max (a, b);"),
            (std::vector<std::string>{"native_recip", "dot", "atomic_add", "max"}));
  EXPECT_TRUE(forbidden_calls("real maximum(real a) { return fma(a, sqrt(a), any(a)); } int step = 1; distance = 2;").empty());
  EXPECT_EQ(without_comments("a /* dot( */ b // max(\nc"), "a            b        \nc");
}

/// Every kernel switches contraction off before its first statement: arith.cl does so and comes first.
TEST(KernelSource, TurnsContractionOff) {
  const std::string pragma = "#pragma OPENCL FP_CONTRACT OFF";
  EXPECT_NE(text_of(root / "kernels" / "arith.cl").find(pragma), std::string::npos);
  static const std::regex first_directive(R"(#\s*\w+[^\n]*)");
  for (const fs::path& path : kernel_files()) {
    if (kernels_of(path).empty()) continue;
    const std::string text = without_comments(text_of(path));
    std::smatch match;
    ASSERT_TRUE(std::regex_search(text, match, first_directive)) << path;
    EXPECT_TRUE(match[0] == pragma || match[0] == "#include \"arith.cl\"") << path.filename() << " starts with " << match[0];
  }
}

}  // namespace
}  // namespace pliant
