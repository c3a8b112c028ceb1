// The buffer model: a small part of the body around the contact, integrated at the haptic rate (Mendoza and Laugier 2003,
// "volumetric buffer model"). Its rim follows the last two states of the simulation; inside, elements, integrator and contact
// are those of the simulation, computed by the twins of its kernels.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "haptics/buffer_blade.h"
#include "haptics/force_model.h"
#include "haptics/submodel.h"
#include "haptics/twin_runner.h"
#include "simulation/contact/contact_units.h"

namespace pliant::haptics {

/// State of the tissue at the end of a frame, at the nodes of one buffer.
struct TissueState {
  std::vector<float> displacement;  ///< [nodes][3] [m]
  std::vector<float> velocity;      ///< [nodes][3] [m/s]
  std::vector<float> drift;         ///< [nodes][3] mean velocity since the state before [m/s]
  std::vector<Pose> tools;          ///< of all tools of the model, at the end of the frame
  std::vector<ToolMoment> moments;  ///< of their shapes
  std::vector<float> grips;         ///< [tools] strength of their grips [Pa]; 0: the tool does not grip
  std::vector<float> anchors;       ///< [points][4] of contact (contact_grip.cl); empty: no tool can grip
  BladeState blade;                 ///< of the instrument, if it is a blade
  double step = 0;                  ///< of the simulation [s]: a stable step for these elements
  Vec3d gravity{};                  ///< [m/s^2]
  std::vector<float> curves;        ///< values of the model's curves
};

/// What the hand moves.
struct BufferInstrument {
  std::optional<std::size_t> tool;  ///< index among the model's tools; empty: a blade
  double length = 0;                ///< of the blade's edge [m]
  double grip = 0;                  ///< strength of the tool's grip while it grips [Pa]; 0: it cannot
  Pose start;                       ///< where it is at first
};

class BufferModel {
 public:
  /// Allocates everything that ticks need. Throws Error for an element or a law that has no twin.
  BufferModel(Submodel part, const BufferInstrument& instrument, const TissueState& state);
  BufferModel(const BufferModel&) = delete;
  BufferModel& operator=(const BufferModel&) = delete;

  /// Sets all nodes to a state of the simulation.
  void start(const TissueState& state) noexcept;
  /// Takes displacements, velocities and friction of common nodes and points from the buffer before.
  void carry(const BufferModel& before) noexcept;
  /// From now on the rim moves so that it is at the state in `seconds`, ahead of it by `lead` times its motion since the state
  /// before; the other tools so that they are there.
  void follow(const TissueState& state, double seconds, double lead) noexcept;
  /// Draws the nodes inside the rim to a state, by a share of the difference.
  void draw(const TissueState& state, double share) noexcept;
  /// The instrument is where the hand is; call before follow().
  void hold(const Pose& hand) noexcept { blade_.hold(hand); }
  /// What the hand wants of the instrument from now on.
  void grip(HandGrip wanted) noexcept { hand_grip_ = wanted; }
  /// Advances by `dt` [s] while the instrument moves from `from` to `to`. Returns the mean wrench on it, about its origin.
  Wrench tick(const Pose& from, const Pose& to, double dt) noexcept;

  [[nodiscard]] const Submodel& part() const { return part_; }
  [[nodiscard]] bool whole() const { return part_.whole; }
  [[nodiscard]] std::int64_t contacts() const { return touching_; }  ///< points, or samples of an edge, that touched at last
  [[nodiscard]] int substeps() const { return substeps_; }           ///< of the last tick
  /// Displacement of a node [m].
  [[nodiscard]] Vec3d displacement(std::size_t node) const;
  /// Returns false if a displacement is not a finite number.
  [[nodiscard]] bool finite() const noexcept;

 private:
  void set_step(double h) noexcept;
  void set_curves(const TissueState& state) noexcept;
  void set_anchors(const TissueState& state) noexcept;
  void write_poses(double from, double to, double dt) noexcept;
  void move_rim(double passed, double h) noexcept;
  void look_again() noexcept;
  [[nodiscard]] Wrench read_wrench(const Pose& whole) noexcept;
  /// Pose of a tool when `share` of this tick has passed, which began `passed_` after follow().
  [[nodiscard]] Pose pose_of(std::size_t tool, double share, double dt) const noexcept;

  Submodel part_;
  BufferInstrument instrument_;
  const Program program_;
  TwinRunner runner_;
  BufferBlade blade_;
  bool has_law_ = false;  ///< a tool has a law of contact
  std::span<float> contact_step_;
  std::span<float> curves_, u_, w_, params_, poses_, contact_params_, anchor_, yield_;
  std::span<std::int32_t> near_, list_, node_list_, tool_sum_;
  std::vector<std::int32_t> tiles_offset_, tiles_;  ///< tiles of points at each tile of nodes
  std::vector<std::int32_t> rim_;                   ///< nodes
  /// Per rim node and axis: a cubic of the share s in [0, 1] of the way to the target, p = a + s (b + s (c + s d)) [m].
  std::vector<std::array<float, 4>> way_;
  std::vector<Pose> other_from_, other_to_;  ///< of all tools at the start of follow() and at its end
  std::vector<ToolMoment> moments_;
  std::vector<float> grips_;
  HandGrip hand_grip_ = HandGrip::unsaid;
  Pose from_, to_;  ///< of the instrument in this tick
  ContactUnits units_;
  double step_ = 0;                 ///< h, 0: not set [s]
  double stable_ = 0;               ///< of the simulation [s]
  double passed_ = 0, period_ = 0;  ///< since follow() [s]
  Vec3d gravity_{};
  int substeps_ = 1, since_look_ = 0;
  double travel_ = 0, margin_ = 0;  ///< of the instrument since the last search, and that of a search [m]
  std::int64_t touching_ = 0;
};

}  // namespace pliant::haptics
