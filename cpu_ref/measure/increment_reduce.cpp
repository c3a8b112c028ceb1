// Twin of kernels/measure/increment_reduce.cl.
#include <cmath>
#include <limits>

#include "cpu_ref/registry.h"

namespace pliant::ref {

template <class Scalar>
void increment_reduce(Range range, const Scalar* node_w, Scalar* increment_summary, std::int32_t texels) {
  for (std::int64_t lane = range.begin; lane < range.end; ++lane) {
    Scalar most = 0;
    bool finite = true;
    for (std::int64_t i = lane; i < texels; i += 256) {
      for (int c = 0; c < 3; ++c) {
        const Scalar size = std::fabs(node_w[4 * i + c]);
        finite = finite && size < std::numeric_limits<Scalar>::infinity();
        most = size > most ? size : most;
      }
    }
    increment_summary[lane] = finite ? most : std::numeric_limits<Scalar>::infinity();
  }
}

void register_increment_reduce(Registry& registry) {
  registry.add("increment_reduce", increment_reduce<float>, increment_reduce<double>);
}

}  // namespace pliant::ref
