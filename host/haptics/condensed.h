// A body as the instrument feels it while it holds the same nodes and moves little: a force and a stiffness (Norton's
// equivalent of a linear network).
#pragma once
#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <array>
#include <cstdint>
#include <vector>

#include "haptics/force_model.h"

namespace pliant::haptics {

/// Force of the contact nodes on their constraints: r = stiffness u - force, for their displacements u.
struct Norton {
  Eigen::MatrixXd stiffness;  ///< [3 contacts][3 contacts], symmetric [N/m]
  Eigen::VectorXd force;      ///< [3 contacts]: what would hold them at u = 0, with the other sign [N]
};

/// Static condensation (Guyan 1965; Bro-Nielsen and Cotin 1996 for haptics): S = K_cc - K_co K_oo^-1 K_oc and f = f_c - K_co
/// K_oo^-1 f_o, c the components of the contacts and o the others. `stiffness`: [components][components], both triangles;
/// `contacts`: ascending numbers of components. Not for a tick. Throws Error for sizes that do not agree and where K_oo is not
/// positive definite.
Norton condense(const Eigen::SparseMatrix<double>& stiffness, const std::vector<int>& contacts, const Eigen::VectorXd& load);

/// Stiffness against moving the contacts with a rigid instrument, [6][6]: translation [m], then the rotation vector [rad].
/// `arms`: [contacts] from the instrument's origin [m].
std::array<double, 36> rigid_stiffness(const Norton& norton, const std::vector<Vec3d>& arms);

/// A stiffness as the ticks read it: row i, column j at 6 i + j; rows are force and torque, columns translation and rotation.
struct Linearised {
  std::array<double, 36> stiffness{};
  std::int64_t topology = 0;  ///< for which it was condensed
};

/// F = F_0 - K (x - x_0) about the pose and the mean wrench of the newest report. A stiffness that was condensed for another
/// topology is dropped; then, and before any has come, F_0 is held. A contact pushes only: where the line leads to a force
/// against F_0, the wrench is zero, as it is when the report has no force at all.
class CondensedForce : public ForceModel {
 public:
  /// `sticks`: the contact pulls as well.
  explicit CondensedForce(bool sticks = false) : sticks_(sticks) {}
  /// From the haptic thread, as receive().
  void linearise(const Linearised& linearised) noexcept;
  void receive(const FrameReport& report) noexcept override;
  Wrench tick(const Pose& tool, double dt) noexcept override;
  /// Whether the stiffness counts, or the force is held.
  [[nodiscard]] bool linear() const noexcept { return given_ && linearised_.topology == report_.topology; }

 private:
  bool sticks_, given_ = false;
  Linearised linearised_;
  FrameReport report_;
};

}  // namespace pliant::haptics
