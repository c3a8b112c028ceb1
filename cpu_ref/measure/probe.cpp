// Twin of kernels/measure/probe.cl.
#include <bit>
#include <cmath>

#include "cpu_ref/registry.h"

namespace pliant::ref {
namespace {

// In double, only the bits of the nearest float are meaningful.
std::int32_t as_int(double x) { return std::bit_cast<std::int32_t>(static_cast<float>(x)); }
float as_real(std::int32_t bits) { return std::bit_cast<float>(bits); }
std::int32_t bit(bool condition, int n) { return condition ? 1 << n : 0; }

}  // namespace

template <class Scalar>
void probe(Range range, const Scalar* a, const Scalar* b, const Scalar* c, const std::int32_t* k, Scalar* reals,
           std::int32_t* ints, std::int32_t count) {
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    const Scalar x = a[i], y = b[i], z = c[i];
    const std::int32_t n = k[i];
    reals[i] = x * y + z;
    reals[count + i] = x * y - z;
    reals[2 * count + i] = std::fma(x, y, z);
    reals[3 * count + i] = x / y;
    reals[4 * count + i] = 1 / x;
    reals[5 * count + i] = std::sqrt(std::fabs(x));
    reals[6 * count + i] = x + y;
    reals[7 * count + i] = x - y;
    reals[8 * count + i] = x * y;
    reals[9 * count + i] = std::floor(x);
    reals[10 * count + i] = std::rint(x);
    reals[11 * count + i] = std::copysign(x, y);
    reals[12 * count + i] = x < y ? x : y;
    reals[13 * count + i] = x > y ? x : z;
    reals[14 * count + i] = -x;
    reals[15 * count + i] = static_cast<Scalar>(n);
    reals[16 * count + i] = as_real(as_int(x) ^ (n & 0xff));

    const std::int32_t order =
        bit(x < y, 0) | bit(x <= y, 1) | bit(x == y, 2) | bit(x != y, 3) | bit(x > y, 4) | bit(x >= y, 5);
    ints[i] = order | bit(!(x > 0), 6) | bit(x == x, 7);
    ints[count + i] = x == x ? as_int(x) : 0;
    ints[2 * count + i] = static_cast<std::int32_t>(std::fabs(x) < 1048576 ? std::rint(x) : 0);
    ints[3 * count + i] = (n * 3 + 7) ^ (n >> 2);
    ints[4 * count + i] = (n & 255) << 3 | (n / 7 & 7);
  }
}

void register_probe(Registry& r) { r.add("probe", probe<float>, probe<double>); }

}  // namespace pliant::ref
