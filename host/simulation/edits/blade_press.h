// Blades that cut by force, on the device: uploads the places of their edges and fronts, and reads the forces on them.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "simulation/contact/tool_contact.h"
#include "simulation/edits/blade_samples.h"
#include "simulation/edits/topology_edits.h"
#include "simulation/state/run_context.h"

namespace pliant {

/// Load on the faces of a blade in a step: force and torque about the middle of its edge, part of those on the blade.
struct FaceLoad : Wrench {
  double normal = 0;  ///< sum of the forces that press on its two sides, across it [N]
};

class BladePress {
 public:
  BladePress(RunContext& run, const TopologyEdits& edits, const ToolContact& contact)
      : run_(run), edits_(edits), contact_(contact) {}

  /// Counts the blades and their samples; call before the first Program is built. Throws Error (bad_input) for an edge that is
  /// wider than every body.
  void start(const Model& model);
  /// Before a batch: uploads edges, fronts and limits, if an edge is near tissue.
  void begin_batch(std::int32_t steps);
  /// After a batch of which `steps` were done, or which went back (0).
  void end_batch(std::int32_t steps);

  /// Names of the blades that cut by force.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// Force on each blade [N] and torque about the middle of its edge [N m] in each step of the last batch, shape
  /// [steps][blades]; it ended after step batch_end(). Empty where nothing was near.
  [[nodiscard]] const std::vector<Wrench>& step_forces() const { return felt_.step_forces; }
  [[nodiscard]] std::int64_t batch_end() const { return felt_.batch_end; }
  [[nodiscard]] const Clock& batch_clock() const { return felt_.batch_clock; }  ///< as ToolContact's
  /// In the last step; zero where nothing was near.
  [[nodiscard]] Wrench last_force(std::size_t blade) const;
  /// Of it, that on its faces.
  [[nodiscard]] FaceLoad last_on_faces(std::size_t blade) const;
  /// The work of a blade on the tissue so far, that of its faces included [J].
  [[nodiscard]] double work(std::size_t blade) const;
  /// Its faces among ToolContact::tools(); empty without faces.
  [[nodiscard]] std::vector<std::size_t> faces(std::size_t blade) const;

  /// The samples of all blades, or of one of them, which then is blade 0.
  [[nodiscard]] BladeSamples samples(std::optional<std::size_t> only = {}) const;

  /// Forces on the blades in the last batch, to be put back after the simulation has gone ahead.
  struct Felt {
    std::vector<Wrench> step_forces;
    std::vector<FaceLoad> on_faces;  ///< [steps][blades], if any blade has faces
    std::int64_t batch_end = -1;
    Clock batch_clock;
  };
  [[nodiscard]] const Felt& felt() const { return felt_; }
  void put_back(const Felt& felt) { felt_ = felt; }

 private:
  [[nodiscard]] bool near() const;
  void write_sample(const FrontSample& sample, std::size_t row, BladeSamples& out) const;
  [[nodiscard]] bool has_faces() const;
  void upload_poses(std::int32_t steps);
  void upload_nodes(const BladeSamples& samples);
  void read_fronts();
  void add_edges(std::size_t steps);
  void add_faces(std::size_t steps);
  template <class Visit>
  void for_samples(Visit&& visit) const;

  RunContext& run_;
  const TopologyEdits& edits_;
  const ToolContact& contact_;
  std::vector<std::string> names_;
  std::vector<std::size_t> blades_;          ///< their places in Scene::blades, which a restored state replaces
  std::vector<std::size_t> first_;           ///< sample of each blade, and the number of all
  std::vector<std::array<Vec3d, 2>> poses_;  ///< first end and span, from the step before the batch on, [steps + 2][blades]
  Felt felt_;
  bool pressing_ = false;  ///< the passes run in the present batch
};

}  // namespace pliant
