// Twin of kernels/measure/limit_fma.cl.
#include <cmath>

#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar>
void limit_fma(Range range, Scalar* a, Scalar s) {
  for (std::int64_t i = range.begin; i < range.end; ++i) {
    const Scalar x = a[i];
    Scalar chain[8];
    for (int j = 0; j < 8; ++j) chain[j] = x + static_cast<Scalar>(j);
    for (int k = 0; k < 64; ++k) {
      for (Scalar& c : chain) c = std::fma(c, s, x);
    }
    a[i] = ((chain[0] + chain[1]) + (chain[2] + chain[3])) + ((chain[4] + chain[5]) + (chain[6] + chain[7]));
  }
}

void register_limit_fma(Registry& registry) { registry.add("limit_fma", limit_fma<float>, limit_fma<double>); }

}  // namespace pliant::ref
