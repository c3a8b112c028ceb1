// When: a factor over time.
#pragma once
#include <array>
#include <vector>

namespace pliant {

/// Time course of a load, of gravity or of a prescribed motion: a factor over time.
struct Curve {
  enum class Kind { constant, ramp, smooth, table };
  /// What of the factor counts: itself, or of a rotation by `angle` times the factor its cosine less one, or its sine. A scene
  /// has factors only; the Model makes the others.
  enum class Of { factor, cosine_less_one, sine };
  Kind kind = Kind::constant;                ///< constant: 1 from the start
  double start = 0;                          ///< [s]
  double duration = 0;                       ///< [s]; ramp: linear 0 to 1; smooth: 10 s^3 - 15 s^4 + 6 s^5
  std::vector<std::array<double, 2>> table;  ///< (time [s], factor), times ascending, linear in between, held outside
  Of of = Of::factor;
  double angle = 0;  ///< [degrees]
  [[nodiscard]] double value(double time) const;
  /// Of the factor, whatever of it counts.
  [[nodiscard]] double factor(double time) const;
  /// Of the factor's magnitude over all times.
  [[nodiscard]] double largest() const;
  /// The last time at which it may change [s].
  [[nodiscard]] double end() const;
  /// Whether the factor is 1 from the beginning on.
  [[nodiscard]] bool always() const { return kind == Kind::constant && start <= 0; }
  friend bool operator==(const Curve&, const Curve&) = default;
};

}  // namespace pliant
