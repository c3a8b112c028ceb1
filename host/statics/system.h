// The discrete equations of a problem: internal and external forces, the tangent over the free components, and its pattern.
#pragma once
#include <Eigen/Sparse>
#include <vector>

#include "material/response.h"
#include "statics/pressure.h"
#include "statics/shape.h"

namespace pliant::statics {

using Eigen::VectorXd;
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

/// Everything at one displacement, over all components 3 node + axis.
struct Forces {
  VectorXd internal, external;  ///< [N]
  double energy = 0;            ///< strain energy [J]
  double sum_of_sizes = 0;      ///< norm of the sums of |element force|: rounding errors are eps times this [N]
};

class System {
 public:
  /// Checks the problem, precomputes gradients at the points of quadrature and the pattern of the tangent. Throws Error.
  System(const Problem& problem, bool linear);

  [[nodiscard]] int components() const { return static_cast<int>(3 * problem_.mesh.nodes.size()); }
  [[nodiscard]] int unknowns() const { return unknowns_; }
  [[nodiscard]] const std::vector<int>& free_of() const { return free_; }   ///< number among the free ones, or -1
  [[nodiscard]] const VectorXd& prescribed() const { return prescribed_; }  ///< at full load, 0 where free

  /// False, with `out` unusable, when an element's J is not a positive, finite number.
  bool forces(const VectorXd& u, double load, Forces& out) const { return evaluate(u, load, out, nullptr, nullptr); }

  /// The same with the lower triangle of the tangent over the free components, and the forces on the free components that a
  /// change `moved` of the prescribed ones gives (not touched where `moved` is null).
  bool tangent(const VectorXd& u, double load, Forces& out, SparseMatrix& stiffness, VectorXd* moved_force = nullptr,
               const VectorXd* moved = nullptr) const;

  /// The product of the unsymmetric part of the pressures' stiffness, which the tangent lacks, on the free components with a
  /// change d of all.
  [[nodiscard]] VectorXd skew_product(const VectorXd& u, double load, const VectorXd& d) const;
  [[nodiscard]] bool has_skew_part() const { return !linear_ && !patches_.empty(); }

  /// Largest Frobenius norm of the displacement gradient of d at a point of quadrature.
  [[nodiscard]] double largest_gradient(const VectorXd& d) const;
  [[nodiscard]] VectorXd free_part(const VectorXd& all) const;
  [[nodiscard]] VectorXd spread(const VectorXd& free_values) const;  ///< 0 at prescribed components
  [[nodiscard]] SparseMatrix pattern() const { return pattern_; }

 private:
  struct Point {
    Gradients gradient;  ///< at rest [1/m]
    double weight = 0;   ///< [m^3], fill counted
  };
  struct Contribution {
    Eigen::VectorXd force;      ///< [3 corners]
    Eigen::VectorXd size;       ///< [3 corners] sums of absolute values
    Eigen::MatrixXd stiffness;  ///< [3 corners][3 corners], symmetric
    double energy = 0;
    bool good = true;
  };
  struct Sink;
  void check() const;
  void number();
  void precompute();
  void add_dead_loads();
  void make_pattern();
  [[nodiscard]] std::vector<int> components_of(const std::int32_t* nodes, int count) const;
  void compute(std::int64_t e, const VectorXd& u, bool with_stiffness, Contribution& out) const;
  bool evaluate(const VectorXd& u, double load, Forces& out, SparseMatrix* stiffness, Sink* sink) const;
  void add_pressures(const VectorXd& u, double load, Forces& out, SparseMatrix* stiffness, Sink* sink) const;
  void scatter(const std::vector<int>& components, const Eigen::MatrixXd& block, SparseMatrix& stiffness, Sink* sink) const;

  const Problem& problem_;
  bool linear_ = false;
  int unknowns_ = 0;
  std::vector<int> free_;
  VectorXd prescribed_, dead_;
  std::vector<Point> points_;  ///< [elements][points]
  std::vector<PressurePatch> patches_;
  SparseMatrix pattern_;
};

/// Throws Error unless the prescribed components hold every connected part of the mesh against rigid motion.
void check_held(const Problem& problem);

}  // namespace pliant::statics
