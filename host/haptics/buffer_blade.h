// The edge of a blade that cuts by force in a buffer: it presses, gives way and rubs there at the haptic rate, by the kernel of
// the simulation (kernels/contact/blade_press.cl). Which edges of the mesh are cut is the simulation's business.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec3.h"
#include "haptics/blade_state.h"
#include "haptics/twin_runner.h"
#include "pliant/wrench.h"
#include "scene/contact_tool.h"

namespace pliant::haptics {

class BufferBlade {
 public:
  /// Of a Program with the samples of one blade of this length [m]; without samples it does nothing.
  BufferBlade(TwinRunner& runner, double length);

  /// Takes what the simulation says of the samples, and its fronts.
  void start(const BladeState& state) noexcept;
  /// The same, but the fronts stay where the hand has brought them. From there they are drawn, for the next `seconds`, until
  /// they are as far before the edge as in the simulation, whose blade is ahead of the hand.
  void follow(const BladeState& state, double seconds) noexcept;
  /// After start(): the fronts are those of the buffer before.
  void carry(const BufferBlade& before) noexcept;
  /// The edge is where the hand is.
  void hold(const Pose& hand) noexcept;
  /// The edge goes between two poses in the next step, of `h` [s].
  void move(const Pose& from, const Pose& to, double h) noexcept;
  /// On the blade in the last step, about the middle of its edge.
  [[nodiscard]] Wrench read() noexcept;
  [[nodiscard]] std::int64_t pressing() const { return pressing_; }  ///< samples, in the last step

 private:
  /// Where the front of a sample is.
  struct Front {
    bool any = false;
    Vec3d point{}, normal{};
    double advance = 0;  ///< beyond `point`, along `normal` [m]
  };
  [[nodiscard]] Front front_of(std::size_t sample) const noexcept;
  bool keep(std::size_t sample, const Front& before) noexcept;
  [[nodiscard]] double front_at_hand(std::size_t sample, const BladeState& state) const noexcept;
  void copy_lists(const BladeState& state) noexcept;
  void advance(double h) noexcept;

  std::span<float> u_, weight_, share_, data_, front_, force_, pose_;
  std::span<std::int32_t> node_, slot_, free_, first_, entry_;
  double length_;
  std::size_t samples_;
  std::vector<float> limit_, depth_;  ///< of the samples, as the simulation has them: F* [N] and BladeSamples::depth [m]
  double edge_ = 0;                   ///< BladeSamples::edge [m]
  std::vector<float> draw_;           ///< speed at which the fronts are drawn [m/s], ...
  double drawn_for_ = 0;              ///< ... for so long [s]
  Vec3d at_{}, span_{};               ///< first end and span of the hand's edge [m]
  std::int64_t pressing_ = 0;
  bool fresh_ = true;  ///< the fronts are those of start()
};

}  // namespace pliant::haptics
