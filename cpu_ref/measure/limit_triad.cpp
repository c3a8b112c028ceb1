// Twin of kernels/measure/limit_triad.cl.
#include <cmath>

#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar>
void limit_triad(Range range, Scalar* a, const Scalar* b, const Scalar* c, Scalar s) {
  for (std::int64_t i = range.begin; i < range.end; ++i) a[i] = std::fma(s, c[i], b[i]);
}

void register_limit_triad(Registry& registry) { registry.add("limit_triad", limit_triad<float>, limit_triad<double>); }

}  // namespace pliant::ref
