// The virtual coupling between the device and the instrument that meets the tissue (Colgate, Stanley and Brown 1995).
#pragma once
#include "haptics/force_model.h"

namespace pliant::haptics {

/// A spring and damper in each of the three translations and rotations, and the mass that the instrument has in between.
///
/// The stiffness at the hand is at most that of the coupling, whatever the instrument meets, so that the coupling alone decides
/// whether the device is stable (Adams and Hannaford 1999: its parameters depend on the device, not on the environment). A
/// device with a damper b stays passive with a spring K and damper B at sampled positions where b > K T / 2 + B (Colgate and
/// Schenkel 1997).
struct CouplingOptions {
  bool rigid = false;          ///< no coupling: the instrument is where the device is, its wrench goes to the hand as it is
  double stiffness = 500;      ///< K [N/m]
  double damping = 1;          ///< B [N s/m]
  double turn_stiffness = 1;   ///< [N m/rad]
  double turn_damping = 2e-3;  ///< [N m s/rad]
  double mass = 0;             ///< m [kg]; 0: K T^2
  double inertia = 0;          ///< [kg m^2]; 0: turn_stiffness T^2
};

/// Returns the options with the stiffest coupling that lets a device of these dampers [N s/m, N m s/rad] stay passive at a tick
/// T [s]: half of b goes to each side of b = K T / 2 + B, so that K = b / T and B = b / 2, less a tenth.
CouplingOptions passive_coupling(double damping, double turn_damping, double tick);

/// Pose of the instrument, and the wrench of the coupling on the hand.
struct Coupled {
  Pose instrument;
  Wrench on_hand;  ///< torque about the device's tip
};

/// Integrated by Euler's implicit rule for the coupling and explicitly for the contact: m (v' - v) / T = F + K (x_d - x') +
/// B (v_d - v') and x' = x + T v'. That is stable at any K and B. With a contact F = -k x it is stable for
/// k < 4 m / T^2 + 2 B / T + K (Jury's conditions of the two roots, for a device that is held). Without a given mass the
/// instrument gets m = K T^2, with which k may be 5 K and more: a contact that is stiffer than the coupling is not felt as
/// such.
class VirtualCoupling {
 public:
  /// `tick`: T for which masses that are not given are chosen [s]. Throws Error for negative or non-finite numbers.
  VirtualCoupling(const CouplingOptions& options, double tick);
  /// Puts the instrument there, at rest.
  void place(const Pose& instrument) noexcept;
  /// Advances by `dt` [s], at the end of which the device is at `device` with `velocity` [m/s] and `spin` [rad/s]. `contact`
  /// acts on the instrument at its pose of the last call, with the torque about its origin. Where one of them is no number, the
  /// wrench may be none in this tick, too, and the instrument begins again at the device.
  Coupled step(const Pose& device, const Vec3d& velocity, const Vec3d& spin, const Wrench& contact, double dt) noexcept;
  [[nodiscard]] const Pose& instrument() const noexcept { return pose_; }
  /// The stiffness below which a contact is stable at this tick [N/m].
  [[nodiscard]] double stable_contact(double dt) const noexcept;
  [[nodiscard]] const CouplingOptions& options() const noexcept { return options_; }

 private:
  CouplingOptions options_;
  Pose pose_;
  Vec3d velocity_{}, spin_{};
  Wrench on_hand_;
};

/// The rotation by a vector axis times angle [rad], as a unit quaternion.
std::array<double, 4> turn_by(const Vec3d& rotation) noexcept;
/// `pose` turned about its origin by `rotation` [rad].
Pose turned(const Pose& pose, const Vec3d& rotation) noexcept;

}  // namespace pliant::haptics
