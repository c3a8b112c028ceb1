#include "elements/eigenvalues.h"

#include <Eigen/Eigenvalues>

namespace pliant {
namespace {

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

}  // namespace

double largest_eigenvalue(const Eigen::Ref<const Eigen::MatrixXd>& a) {
  return Solver(a, Eigen::EigenvaluesOnly).eigenvalues()[a.rows() - 1];
}

double largest_eigenvalue(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::Ref<const Eigen::MatrixXd>& s) {
  // A = V D V^T: with B = D^1/2 V^T S the matrix is B^T B, which has the eigenvalues of the smaller B B^T.
  const Solver solver(a);
  const Eigen::MatrixXd b = solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * solver.eigenvectors().transpose() * s;
  return largest_eigenvalue(b * b.transpose());
}

}  // namespace pliant
