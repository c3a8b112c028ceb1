// The law of springs, as a scene gives it.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace pliant {

/// Force F [N] over elongation e = l - l0 [m]. The order is that of LAW in kernels/links/spring_pull.cl.
enum class SpringLaw {
  linear,    ///< F = k e
  cubic,     ///< F = lambda1 (e / l0)^3 + lambda2 e / l0
  measured,  ///< F = e / (a |e| + b): slope 1 / b at first, 0 < a softens, a < 0 stiffens up to |e| = -b / a
  curve,     ///< linear between pairs (e, F), beyond them along the first and last line
};

struct Spring {
  SpringLaw law = SpringLaw::linear;
  double stiffness = 0;                      ///< linear: k [N/m]; 0 in a mass-spring body: from Young's modulus
  double lambda1 = 0, lambda2 = 0;           ///< cubic [N]
  double a = 0, b = 0;                       ///< measured [1/N], [m/N]
  std::vector<std::array<double, 2>> curve;  ///< curve: at least two pairs e [m], F [N], e ascending
  double damping = 0;                        ///< of the rate of the length [N s/m]
  bool slack = false;                        ///< no force unless it is longer than at rest

  /// Of a measured law with a < 0: share of the way to |e| = -b / a beyond which it continues along its tangent.
  static constexpr double kMostOfPole = 0.75;
};

/// An entry of a body's "springs": springs with one law between nodes of the body.
struct SpringList {
  std::vector<std::array<std::int32_t, 2>> nodes;  ///< [springs]
  std::vector<double> factor;                      ///< [springs] on the force of the law; empty: 1
  std::vector<double> length;                      ///< [springs] at rest [m]; empty or 0: that between the nodes
  Spring spring;                                   ///< each of them
  std::string pointer;                             ///< JSON pointer ("/bodies/0/springs/0")
  std::string file;                                ///< that lists them, one per line from the second; empty: the scene does
  [[nodiscard]] double factor_of(std::size_t s) const { return factor.empty() ? 1 : factor[s]; }
  [[nodiscard]] double length_of(std::size_t s, double between) const {
    return length.empty() || length[s] == 0 ? between : length[s];
  }
  /// Of spring s, for messages.
  [[nodiscard]] std::string place(std::size_t s) const;
};

/// An entry of "joins": springs between the nodes of two bodies that are near each other at rest.
struct Join {
  std::array<std::string, 2> bodies;  ///< names
  double distance = 0;                ///< between pairs of nodes that are joined, at most [m]
  Spring spring;                      ///< each of them
  double break_stretch = 0;           ///< a spring breaks when it is longer than this times its length at rest; 0: never
  double break_force = 0;             ///< a spring breaks when its force is larger [N]; 0: never
  std::vector<std::int32_t> broken;   ///< set in code: springs that are broken, ascending
  std::string pointer;                ///< JSON pointer ("/joins/0")
};

}  // namespace pliant
