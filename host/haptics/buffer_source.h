// The simulation's side of the buffer model: chooses its elements, builds it, and exports the state of its nodes.
#pragma once
#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptics/buffer_model.h"
#include "haptics/driven_part.h"
#include "simulation/simulation.h"

namespace pliant::haptics {

/// The message of the simulation to the haptic thread after each frame.
struct BufferMessage {
  FrameReport report;
  BufferModel* model = nullptr;  ///< the newest buffer; null: nothing is near the instrument
  std::uint64_t generation = 0;  ///< number of buffers built so far
  std::int64_t elements = 0;     ///< of all bodies
  std::int64_t run = 0;          ///< another one: the simulation was reset or rolled back
  bool covered = true;           ///< false: the instrument touches nodes that no finite element moves
  TissueState state;             ///< of the nodes of `model`
};

class BufferSource {
 public:
  /// `rings`: of elements around the nodes that the instrument touches; negative: all elements of the body it touches.
  /// `tool`: name of a tool, or of a blade that cuts by force.
  BufferSource(std::string tool, std::int32_t rings) : tool_(std::move(tool)), rings_(rings) {}

  /// From the next fill() on; an existing buffer is rebuilt if its rings differ.
  void set_rings(std::int32_t rings) {
    if (rings != rings_) ring_.clear();
    rings_ = rings;
  }
  /// The report alone, without a buffer. Returns the tool; empty: it is parked or gone.
  std::optional<DrivenPart> fill_report(const Simulation& simulation, BufferMessage& message);
  /// Call after a frame, from the thread that steps. `in_use`: generation of the buffer that the haptic thread uses; older ones
  /// are destroyed. A tool that is parked or gone has no buffer.
  void fill(const Simulation& simulation, std::uint64_t in_use, BufferMessage& message);

 private:
  struct Tissue;
  struct Seeds;
  [[nodiscard]] static Seeds find_seeds(const Simulation& simulation, const Tissue& tissue, const DrivenPart& tool);
  [[nodiscard]] bool holds(const Seeds& seeds) const;
  void build(const Simulation& simulation, const Seeds& seeds, const DrivenPart& tool, const Tissue& tissue);
  void report(const Simulation& simulation, const DrivenPart& tool, FrameReport& report);
  [[nodiscard]] TissueState state_of(const Simulation& simulation, const Tissue& tissue, const Submodel& part,
                                     const DrivenPart& tool, double period, bool& covered) const;

  std::string tool_;
  std::int32_t rings_;
  std::shared_ptr<const Model> model_;  ///< that the graph and the newest buffer belong to
  std::shared_ptr<const ElementGraph> graph_;
  std::vector<std::int32_t> ring_;  ///< [elements] of the newest buffer
  struct Kept {
    std::uint64_t generation;
    std::unique_ptr<BufferModel> model;
  };
  std::list<Kept> buffers_;
  std::uint64_t generation_ = 0, number_ = 0;
  std::int64_t last_step_ = -1, run_ = 0;
  const Simulation* simulation_ = nullptr;  ///< of the last call; only compared
  double last_time_ = 0;
  std::vector<Vec3d> last_u_;  ///< displacements by slot at the last report, of `model_` [m]
};

}  // namespace pliant::haptics
