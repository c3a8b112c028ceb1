// The dense arithmetic of one front, in a file of its own because it is compiled for wider vectors.
#pragma once
#include <cstddef>

namespace pliant::statics {

/// factor: [rows][own] by columns, its first `own` rows a lower triangle A11, the others A21. update: [rows - own]^2, lower
/// triangle. Replaces A11 by its Cholesky factor L, A21 by A21 L^-T, and subtracts A21 L^-T L^-1 A21^T from update. False when
/// A11 is not positive definite.
bool eliminate_dense(double* factor, std::ptrdiff_t rows, std::ptrdiff_t own, double* update);

}  // namespace pliant::statics
