// A fuzz target on random inputs, without libFuzzer: for any compiler and sanitizer, and the same inputs every time.
//   random_cut FIRST COUNT    inputs FIRST .. FIRST + COUNT - 1; what fails says which one it was
//   (ASAN_OPTIONS=abort_on_error=1)
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

volatile std::int64_t g_input = 0;

void report(int /*signal*/) {
  std::fprintf(stderr, "input %lld failed\n", static_cast<long long>(g_input));
  std::_Exit(1);
}

/// Seven of eight bytes lie near 100, where a target that reads coordinates has its body.
std::vector<std::uint8_t> input(std::int64_t number) {
  std::mt19937_64 random(static_cast<std::uint64_t>(number));
  std::vector<std::uint8_t> bytes(8 + random() % 120);
  for (std::uint8_t& b : bytes) {
    const std::uint64_t r = random();
    b = static_cast<std::uint8_t>((r & 7) != 0 ? 76 + (r >> 8) % 40 : r >> 8);
  }
  return bytes;
}

}  // namespace

int main(int argc, char** argv) {
  char *first_end = nullptr, *count_end = nullptr;
  const std::int64_t first = argc == 3 ? std::strtoll(argv[1], &first_end, 10) : -1;
  const std::int64_t count = argc == 3 ? std::strtoll(argv[2], &count_end, 10) : 0;
  if (argc != 3 || *first_end != '\0' || *count_end != '\0' || first < 0 || count < 1) {
    std::fprintf(stderr, "usage: %s FIRST COUNT (got %d arguments; allowed are a number from 0 and one from 1)\n", argv[0],
                 argc - 1);
    return 2;
  }
  std::signal(SIGABRT, report);
  for (std::int64_t i = first; i < first + count; ++i) {
    g_input = i;
    const std::vector<std::uint8_t> bytes = input(i);
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    if ((i + 1 - first) % 1000 == 0) std::fprintf(stderr, "%lld inputs\n", static_cast<long long>(i + 1 - first));
  }
  std::printf("%lld inputs passed\n", static_cast<long long>(count));
  return 0;
}
