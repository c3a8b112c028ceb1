// The two force models that know nothing but the reports: the force of the last one, and the line through the last two.
#pragma once
#include "haptics/force_model.h"

namespace pliant::haptics {

/// Which wrench of a report counts, and when it was so: the last step's, at the time of the report, or the mean over the frame,
/// which stands for the middle of it.
enum class Sampled { mean, last };

/// The wrench of the newest report until the next one; zero before the first.
class HeldForce : public ForceModel {
 public:
  explicit HeldForce(Sampled sampled = Sampled::mean) : sampled_(sampled) {}
  void receive(const FrameReport& report) noexcept override;
  Wrench tick(const Pose& tool, double dt) noexcept override;

 private:
  Sampled sampled_;
  Wrench wrench_;
};

/// F(t) = F_n + (t - t_n) (F_n - F_(n-1)) / (t_n - t_(n-1)) (Picinbono and Lombardo 1999 extrapolate forces so). `t` is the
/// time of the newest report plus the ticks since then; it is followed up to `horizon` [s] beyond t_n, then held. A
/// ramp is exact; where a force jumps by J between two reports, it overshoots by up to J min(t - t_n, horizon) / (t_n -
/// t_(n-1)).
class ExtrapolatedForce : public ForceModel {
 public:
  explicit ExtrapolatedForce(double horizon = 0.1, Sampled sampled = Sampled::mean) : horizon_(horizon), sampled_(sampled) {}
  void receive(const FrameReport& report) noexcept override;
  Wrench tick(const Pose& tool, double dt) noexcept override;

 private:
  double horizon_;
  Sampled sampled_;
  Wrench newest_, slope_;  ///< [N, N m], [N/s, N m/s]
  double sampled_at_ = 0, time_ = 0;
  bool any_ = false;
};

}  // namespace pliant::haptics
