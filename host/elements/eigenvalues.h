// Eigenvalues of symmetric matrices of sizes 4 to 12 by one solver: Eigen's own would be instantiated for each fixed size,
// which takes seconds to compile.
#pragma once
#include <Eigen/Core>

namespace pliant {

/// Returns the largest eigenvalue of a symmetric matrix [n][n]; only the lower triangle is read.
double largest_eigenvalue(const Eigen::Ref<const Eigen::MatrixXd>& a);

/// Returns the largest eigenvalue of S^T A S: A symmetric positive semidefinite [n][n], S [n][m].
double largest_eigenvalue(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::Ref<const Eigen::MatrixXd>& s);

}  // namespace pliant
