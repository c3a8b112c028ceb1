// Sparse Cholesky factorisation of a symmetric matrix given by its lower triangle: multifrontal over a nested dissection
// (George 1973; Duff and Reid 1983). The unknowns of a node stay together; the graph is halved by coordinates, and the
// separator is the smallest set of nodes that covers the edges cut.
// Why this is not a library, with measurements: docs/decisions/scenes.md.
#pragma once
#include <vector>

#include "statics/system.h"

namespace pliant::statics {

class Cholesky {
 public:
  /// Once per pattern. `node`: the node of each unknown, ascending; `rest`: positions by node.
  void analyze(const SparseMatrix& pattern, const std::vector<int>& node, const std::vector<Vec3d>& rest);
  /// False when the matrix plus shift times the identity is not positive definite. The result does not depend on threads.
  bool factorize(const SparseMatrix& matrix, double shift);
  [[nodiscard]] VectorXd solve(const VectorXd& right) const;
  [[nodiscard]] std::int64_t entries() const;  ///< of the factor, zeros in its dense blocks counted

 private:
  /// The unknowns that are eliminated together, and those above them that this touches.
  struct Front {
    std::vector<int> rows;  ///< places in the elimination order, ascending: `own` of them, then the boundary
    int own = 0;
    std::vector<int> children;  ///< fronts
    int depth = 0;
    Eigen::MatrixXd factor;  ///< [rows][own], lower
    Eigen::MatrixXd update;  ///< [boundary][boundary], lower: the part for the parent
  };
  bool eliminate(Front& front, const SparseMatrix& permuted, double shift);
  std::vector<Front> fronts_;               ///< children before parents
  std::vector<std::vector<int>> by_depth_;  ///< fronts of each depth
  std::vector<int> place_;                  ///< of each unknown in the elimination order
  SparseMatrix permuted_;                   ///< the matrix in elimination order, lower
  std::vector<int> value_place_;            ///< of each stored value of the matrix in permuted_
};

/// Nodes in an order of elimination, in groups: children (subtrees) before the separator that divides them.
struct Dissection {
  struct Group {
    std::vector<int> nodes;
    std::vector<int> children;
    int depth = 0;
  };
  std::vector<Group> groups;  ///< children before parents
};
/// `neighbors`: of each node, without itself.
Dissection dissect(const std::vector<std::vector<int>>& neighbors, const std::vector<Vec3d>& position);

}  // namespace pliant::statics
