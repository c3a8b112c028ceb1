// Time dependence: a factor over time.
#pragma once
#include <array>
#include <vector>

namespace pliant {

/// Time course of a load, of gravity or of a prescribed motion: a factor over time.
struct Curve {
  enum class Kind { constant, ramp, smooth, table };
  /// The function of the factor that is used: the factor f itself, or cos(angle f) - 1 or sin(angle f) for rotations. A scene
  /// has only factors; the Model creates the others.
  enum class Of { factor, cosine_less_one, sine };
  Kind kind = Kind::constant;                ///< constant: 1 from the start
  double start = 0;                          ///< [s]
  double duration = 0;                       ///< [s]; ramp: linear 0 to 1; smooth: 10 s^3 - 15 s^4 + 6 s^5
  std::vector<std::array<double, 2>> table;  ///< (time [s], factor), times ascending, linear in between, held outside
  Of of = Of::factor;
  double angle = 0;  ///< [degrees]
  [[nodiscard]] double value(double time) const;
  /// The value of the factor, regardless of `of`.
  [[nodiscard]] double factor(double time) const;
  /// The largest magnitude of the factor over all times.
  [[nodiscard]] double largest() const;
  /// The last time at which it may change [s].
  [[nodiscard]] double end() const;
  /// Returns whether the factor is 1 from the start.
  [[nodiscard]] bool always() const { return kind == Kind::constant && start <= 0; }
  friend bool operator==(const Curve&, const Curve&) = default;
};

}  // namespace pliant
