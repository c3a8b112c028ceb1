// Passivity in the time domain: an account of the energy that a device has taken from the rendered force, and a damper that
// keeps the account from going below zero (Hannaford and Ryu 2002). The rendering is a one-port in impedance causality: the
// motion comes from the device, the wrench goes to it.
#pragma once
#include "haptics/force_model.h"

namespace pliant::haptics {

/// Of the translation or of the rotation of a device, each with an account of its own. Units of the rotation stand behind the
/// semicolon.
struct EnergyOptions {
  double allowance = 1e-3;  ///< E(0) of Hannaford and Ryu (2002): the energy that may be taken at the start [J]
  double damping = 0;       ///< of the device itself, at least [N s/m; N m s/rad]
  /// Greatest that the hand gives the device, twice that where its velocity is a difference of samples [m/s^2; rad/s^2]; 0: its
  /// velocity is trusted.
  double acceleration = 0;
  double limit = 1;  ///< of the force that the controller adds to pay a debt back [N; N m]
};

/// Accounts for the energy at the port, of three components of motion.
///
/// A wrench is held from one tick to the next, so that its work over the motion between both is known exactly at the next tick
/// (Ryu, Kim and Hannaford 2004): E(n) = E(n-1) - F(n-1) (x(n) - x(n-1)). It includes the energy that the device's own damper
/// has taken, which is at least b |x(n) - x(n-1)|^2 / T whatever the motion within the tick (Cauchy and Schwarz). For a spring
/// K at sampled positions this balances for K = 2 b / T, which is the condition of Colgate and Schenkel (1997, b > K T / 2).
class PassivityObserver {
 public:
  explicit PassivityObserver(const EnergyOptions& options) : options_(options), energy_(options.allowance) {}
  /// The device has moved by `step` [m; rad] in `dt` [s], under the force of the last call of exert().
  void moved(const Vec3d& step, double dt) noexcept;
  void exert(const Vec3d& force) noexcept { held_ = force; }
  /// E(n) with the allowance [J]: below zero the device has received more than it may.
  [[nodiscard]] double energy() const noexcept { return energy_; }
  /// The least energy so far [J].
  [[nodiscard]] double least() const noexcept { return least_; }

 private:
  EnergyOptions options_;
  double energy_, least_ = energy_;
  Vec3d held_{};
};

/// Corrects the force of a tick so that the account stays above zero through the coming tick.
///
/// With v from the device, the coming tick takes F v T. Where E < F v T, the force loses alpha v with alpha = (F v T - E) / (T
/// v^2) (Hannaford and Ryu 2002, series controller in impedance
/// causality, with the coming tick in E). That is at most the part of F along v, so that it needs no
/// limit.
///
/// The hand may also accelerate: within a tick the motion differs from v T by up to r = a T^2 / 2 (Taylor), so that F v T + |F|
/// r may be taken, less b (|v| T - r)^2 / T in the device's damper; over all motions it is |F|^2 T / (4 b) at most. The lesser
/// of both is held back; where damping does not make room for it, the force is scaled. An account that is below zero because
/// the hand was quicker than that is paid back by damping up to the limit of the options, and meanwhile nothing is taken from
/// it.
class PassivityController {
 public:
  explicit PassivityController(const EnergyOptions& options) : options_(options), observer_(options) {}
  /// Since the last tick, `dt` [s] ago, the device has moved by `step` [m; rad]; now it has `velocity` [m/s; rad/s]. Returns
  /// what to exert instead of `force` [N; N m]; the coming tick is taken to be as long.
  Vec3d tick(const Vec3d& step, const Vec3d& velocity, const Vec3d& force, double dt) noexcept;
  /// The force exerted in the end, if a stage behind the controller changed it. A share in [0, 1] of the controller's output
  /// keeps the account non-negative.
  void exerted(const Vec3d& force) noexcept { observer_.exert(force); }
  [[nodiscard]] const PassivityObserver& observer() const noexcept { return observer_; }
  /// Ticks in which the force was changed.
  [[nodiscard]] std::uint64_t corrections() const noexcept { return corrections_; }

 private:
  [[nodiscard]] double most_taken(const Vec3d& velocity, const Vec3d& force, double dt) const noexcept;
  EnergyOptions options_;
  PassivityObserver observer_;
  std::uint64_t corrections_ = 0;
};

/// Both controllers, with the pose of the device between them. The torque is about the device's tip; its work over a tick is
/// torque times the rotation vector of the tick.
class PassivityGate {
 public:
  PassivityGate(const EnergyOptions& translation, const EnergyOptions& rotation)
      : translation_(translation), rotation_(rotation) {}
  /// `velocity` [m/s], `spin` [rad/s]: of the device at `device`; `dt` since the last tick [s]. Where one of them is no number,
  /// nothing is exerted.
  Wrench tick(const Pose& device, const Vec3d& velocity, const Vec3d& spin, const Wrench& wrench, double dt) noexcept;
  /// The wrench exerted in the end, if a stage behind the gate changed it.
  void exerted(const Wrench& wrench) noexcept;
  [[nodiscard]] const PassivityController& translation() const noexcept { return translation_; }
  [[nodiscard]] const PassivityController& rotation() const noexcept { return rotation_; }

 private:
  PassivityController translation_, rotation_;
  Pose before_;
  bool started_ = false;
};

}  // namespace pliant::haptics
