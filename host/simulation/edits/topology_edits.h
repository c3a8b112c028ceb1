// Cuts, tears and moves of operational regions: edits that change the model of a running simulation. Each edit changes the
// bodies, transfers the motion with a ModelSwap and is recorded in the RunState. If a step fails, the previous state is
// restored.
#pragma once
#include <array>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "simulation/edits/blade_fronts.h"
#include "simulation/edits/cut_report.h"
#include "simulation/edits/edit_under_way.h"
#include "simulation/edits/edited_bodies.h"
#include "simulation/step/host_loads.h"
#include "simulation/step/step_control.h"

namespace pliant {

class TopologyEdits {
 public:
  TopologyEdits(RunContext& run, StepControl& step, HostLoads& loads, RunReport& report)
      : run_(run), step_(step), loads_(loads), strokes_(run, report), fronts_(run, strokes_) {}

  /// Call at the start of a simulation: generates the elements of bodies that the scene's blades will cut or that may tear,
  /// and determines how often both are updated. Throws Error (bad_input) for scenes that cannot be edited.
  void start();
  /// Call before a batch that begins on the grid: moves the scene's blades, splits overstretched edges, breaks faces, and
  /// moves regions that follow the tool.
  void update();
  /// Reduces all hybrids to at most kSafeSubsteps substeps. Returns false if none has more, if the step is given by the user,
  /// or if a mesh file is missing or changed. Call in a kept state. Throws what Backend::load throws and then changes
  /// nothing.
  [[nodiscard]] bool fewer_substeps();

  /// Whether the models of cuts and of moved regions are built on another thread while the steps go on with the old one. Where
  /// the steps change is then not determined. Other edits, and scenes whose blades cut by force or that tear, wait as ever.
  void build_beside(bool beside);
  /// Returns true while an edit is being built, or waits for take_built(). Meanwhile update() makes no other.
  [[nodiscard]] bool building() const { return under_way_ != nullptr; }
  /// Ends it where the bodies or the parameters of the scene are needed now: loads its model, if all subcycles start in this
  /// step, or only waits for the builder. take_built() returns its report or throws its error.
  void settle();
  /// Ends it before the run continues from another state: settle(), or takes the edit back. There is no report.
  void end_building();
  /// Call between two batches: loads the model that was built, if all subcycles start in this step, and returns the report of
  /// the edit. `wait`: for the builder, and checks the step, which otherwise update() does in a frame to come. Throws what the
  /// edit would have thrown and then has changed nothing.
  std::optional<CutReport> take_built(bool wait);

  /// See the functions of the same names in Simulation.
  CutReport cut(std::span<const SweepTriangle> triangles);
  CutReport move_blades(std::span<const BladePose> poses);
  void lift_blade(const std::string& blade);
  /// Moves a blade of the scene that cuts by force from where it is to a place within `seconds`; one that is nowhere is there
  /// at once. Its path ends. Throws Error (bad_input): no such blade, numbers, an edge longer than on its path, too fast.
  void drive_blade(const std::string& name, const BladeSegment& to, double seconds);
  /// The greatest speed of an end in drive_blade(): a quarter of an element between two updates of blades [m/s].
  [[nodiscard]] double drive_speed() const;
  /// Takes it away, until it is driven again. Throws Error (bad_input) if there is no such blade.
  void lift_blade_by_force(const std::string& name);
  void prepare_cuts();
  [[nodiscard]] const CutTopology* cut_topology(std::size_t body) const;
  /// Elements of a body that are cut in part and still hold together (CutTopology::cut_in_part, RemadeBody::cut_in_part).
  [[nodiscard]] std::int64_t cut_in_part(std::size_t body) const;
  /// Of a body whose elements blades divide or remove (RemadeBody::element_at): the element that one of the whole body has
  /// become at a place at rest [m], -1: it is gone. Empty for others.
  [[nodiscard]] std::optional<std::int32_t> element_at(std::size_t body, std::int32_t element, const Vec3d& rest) const;
  /// Returns the mean current position of the nodes whose elements the last cut or tear changed [m].
  [[nodiscard]] std::optional<Vec3d> edited_at() const;

  /// Loads the model of the scene after a change of its parameters; the motion stays. `remodelled`: bodies whose operational
  /// region has another size or seed. Throws Error and then changes nothing.
  void load_scene(const std::vector<std::size_t>& remodelled);

  /// Returns the scene with the operational regions, substeps and unparked tools of a state.
  [[nodiscard]] Scene scene_at(const RunState& state) const;
  /// Returns the bodies with a state's edits; nullptr if neither it nor the current state has any. Throws Error (bad_input)
  /// for a state that does not belong to this scene. Does not change this object.
  [[nodiscard]] std::unique_ptr<EditedBodies> bodies_at(const RunState& state) const;
  /// Replaces the bodies by these.
  void take_up(std::unique_ptr<EditedBodies> bodies);

  /// What another simulation of the same scene need not make again.
  struct Shared {
    WholeBodies whole;      ///< empty: not known
    bool compiled = false;  ///< what a cut launches
  };
  [[nodiscard]] Shared shared() const { return {whole(), compiled_}; }
  void share(const Shared& other) {
    whole_ = other.whole;
    compiled_ = other.compiled;
  }

 private:
  [[nodiscard]] const WholeBodies& whole() const { return bodies_ == nullptr ? whole_ : bodies_->whole(); }
  EditedBodies& bodies();
  EditedBodies& cut_bodies();

  // blade_updates.cpp
  void move_scene_blades();
  void move_fronts();
  [[nodiscard]] const Blade& blade_by_force(const std::string& name) const;
  void forget_fronts(const std::string& name);
  CutReport run_blades(const std::vector<BladeMove>& moves, std::span<const SweepTriangle> triangles, bool asked);
  void divide(std::vector<CutEdges> crossed, std::vector<double> u, CutReport& report);
  [[nodiscard]] bool reached(std::size_t body, const std::vector<Vec3d>& x, const std::vector<BladeMove>& moves,
                             std::span<const SweepTriangle> triangles) const;
  [[nodiscard]] const BladeTrace* front(const BladeMove& move, std::size_t body) const;
  /// The outcome of an edit.
  struct Settled {
    CutReport report;
    std::exception_ptr error;
  };
  [[nodiscard]] std::optional<CutReport> load_built(bool wait);
  /// Checks the step for a region that has moved, if it was not.
  void check_step();
  /// Makes an edit now, or begins it if it is to be built beside the steps. u: RunContext::u().
  void perform(ModelEdit edit, std::vector<double> u, CutReport& report);
  // cut_edit.cpp, remake_edit.cpp, overstretch_edit.cpp, tear_edit.cpp, join_edit.cpp, partition_edit.cpp
  void make_cut(std::vector<CutEdges> edges, std::vector<double> u, CutReport& report);
  void make_tears();
  /// Edits the bodies one after the other (`edit` returns empty origins for one that stays) and loads their model. Returns
  /// ModelSwap::changed_nodes(); empty, and report.changed false, if none was edited. If it throws, nothing has changed.
  std::vector<char> swap_bodies(const std::function<NodeOrigins(std::size_t)>& edit, std::vector<double> u, CutReport& report);
  /// Call after an edit that changed elements: the step follows.
  void end_edit(std::vector<char> changed, CutReport& report);
  /// Divides or removes elements.
  void remake(std::vector<CutEdges> crossed, std::vector<double> u, CutReport& report);
  /// Breaks these faces of each body, or has them wait until a gap can open (TornBody::part).
  void part(const std::vector<std::vector<TetFace>>& faces, std::vector<double> u, bool by_blade, CutReport& report);
  void break_joins();
  void open_overstretched();
  void move_regions();
  /// Returns the region of a body that grows from `seed`, without cells that are deformed too far to change their model. u:
  /// shape [nodes of the body].
  [[nodiscard]] MovedRegion region_at(std::size_t body, const Vec3d& seed, const std::vector<Vec3d>& u);
  /// Returns true if the bodies' files, which a first edit reads where it knows no whole bodies, exist and are unchanged.
  [[nodiscard]] bool bodies_as_loaded();
  /// Loads the model of scene_at(state) with the current bodies.
  void swap_partition(std::vector<double> u, bool keeps_state = false);

  RunContext& run_;
  StepControl& step_;
  HostLoads& loads_;
  CutStrokes strokes_;
  BladeFronts fronts_;
  std::vector<double> known_u_;      ///< RunContext::u() within an update that has changed nothing so far; empty: not known
  std::vector<char> changed_nodes_;  ///< [slots] by the last cut or tear; empty: none
  WholeBodies whole_;                ///< for bodies_; empty: not known
  bool compiled_ = false;            ///< what a cut launches
  std::unique_ptr<EditedBodies> bodies_;  ///< the scene's bodies with the edits of RunState; created on first use
  bool beside_ = false;                   ///< build_beside()
  std::unique_ptr<HelperThread> builder_;
  std::unique_ptr<EditUnderWay> under_way_;
  std::vector<Settled> settled_;       ///< for take_built(), the oldest first
  std::optional<double> check_after_;  ///< time at which the step is to be checked for a region that has moved [s]
};

}  // namespace pliant
