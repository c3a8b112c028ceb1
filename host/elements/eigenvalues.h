// Eigenvalues of symmetric matrices of sizes 4 to 12, all by one solver: Eigen's own is compiled anew, for seconds, for each of
// the sizes that the compiler knows.
#pragma once
#include <Eigen/Core>

namespace pliant {

/// The largest eigenvalue of a symmetric matrix [n][n], whose lower triangle is read.
double largest_eigenvalue(const Eigen::Ref<const Eigen::MatrixXd>& a);

/// The largest eigenvalue of S^T A S: A symmetric [n][n] and without negative eigenvalues, S [n][m].
double largest_eigenvalue(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::Ref<const Eigen::MatrixXd>& s);

}  // namespace pliant
