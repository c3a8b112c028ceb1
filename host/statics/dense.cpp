// This file has vector instructions that the others do not (cmake/PliantLibraries.cmake). Eigen's inline functions, which
// align memory by the instructions at hand, must then not be merged with those of other files: here Eigen has another name.
#define Eigen PliantWideEigen
#include "statics/dense.h"

#include <Eigen/Dense>

namespace pliant::statics {

bool eliminate_dense(double* factor, std::ptrdiff_t rows, std::ptrdiff_t own, double* update) {
  using Matrix = Eigen::MatrixXd;
  const std::ptrdiff_t rest = rows - own;
  Eigen::Map<Matrix> all(factor, rows, own);
  auto top = all.topRows(own);
  const Eigen::LLT<Eigen::Ref<Matrix>> llt(top);
  if (llt.info() != Eigen::Success) return false;
  if (rest == 0) return true;
  auto below = all.bottomRows(rest);
  top.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(below);
  Eigen::Map<Matrix>(update, rest, rest).selfadjointView<Eigen::Lower>().rankUpdate(below, -1);
  return true;
}

}  // namespace pliant::statics
