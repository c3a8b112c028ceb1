// The bodies of a simulation as cuts and tears have made them. Private to this shelf.
#pragma once
#include <future>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cutting/blade/blade.h"
#include "cutting/blade/rest_edges.h"
#include "cutting/cut_body.h"
#include "cutting/surface/cut_surface.h"
#include "cutting/topology/cut_topology.h"
#include "cutting/topology/mesh_edges.h"
#include "model/elements/body_mesh.h"
#include "simulation/edits/helper_thread.h"
#include "simulation/state/run_state.h"
#include "tearing/torn_body.h"

namespace pliant {

/// One body: as it was filled, its cut, its surface.
class BodyCut {
 public:
  /// Throws Error for a body that cannot be cut.
  BodyCut(const Body& body, std::shared_ptr<const BodyMesh> uncut);

  [[nodiscard]] const CutTopology& topology() const { return topology_; }
  /// Take out edges that may not be cut: those of cells left to shape matching where the scene says so.
  void keep_allowed(const Body& body, CutEdges& edges) const;
  /// Divide the elements, and let `helper` begin with the surface. Throws, with nothing changed, what CutTopology::cut throws.
  CutEdit cut(const CutEdges& edges, HelperThread& helper);
  /// Bring the elements of solid(), or its surface, up to date after an edit: only what it changed. Both may run at once.
  void update_elements() { update_body_elements(*uncut_, topology_, solid_); }
  void update_surface();
  /// Be what these edits make of the uncut body.
  void rebuild(std::span<const CutEdges* const> edits);
  /// The body as it is cut now, in what was brought up to date.
  [[nodiscard]] const BodyMesh& solid() const { return solid_; }
  /// Mean edge of a cell at rest [m].
  [[nodiscard]] double edge() const { return edge_; }
  [[nodiscard]] const CutSurface* surface() const { return surface_.get(); }
  [[nodiscard]] const BodyMesh& uncut() const { return *uncut_; }
  [[nodiscard]] RestEdges& rest_edges() { return *rest_edges_; }
  [[nodiscard]] const MeshEdges& mesh_edges() const { return mesh_edges_; }

 private:
  void make_surface();
  std::shared_ptr<const BodyMesh> uncut_;
  BodyMesh solid_;
  CutTopology topology_;
  std::unique_ptr<CutSurface> surface_;  ///< of a lattice
  std::future<void> dividing_;           ///< the helper's work on it
  std::unique_ptr<RestEdges> rest_edges_;
  MeshEdges mesh_edges_;
  double edge_ = 0;
};

/// Not a volume mesh of hexahedra.
bool can_be_cut(const BodyMesh& solid);

/// The surface of the model that runs, for the next edit to change: a copy that is made while the bodies move.
class SurfaceCopy {
 public:
  void make(const std::shared_ptr<const Model>& model, HelperThread& helper);
  /// The copy, or one made now.
  [[nodiscard]] ModelSurface take(const Model& model);

 private:
  ModelSurface surface_;
  std::shared_ptr<const Model> model_;  ///< whose surface it is
  std::future<void> made_;
};

/// All bodies of a scene, filled once more than for the first model. One is cut, or torn, or as it was.
class EditedBodies {
 public:
  /// Throws what make_body_meshes throws, and Error (bad_input) for a body that has a toughness and is no volume mesh of
  /// tetrahedra.
  explicit EditedBodies(const Scene& scene);
  /// Whether a material of the scene has a toughness.
  static bool tears(const Scene& scene);

  [[nodiscard]] std::size_t size() const { return uncut_.size(); }
  [[nodiscard]] const BodyMesh& uncut(std::size_t b) const { return *uncut_[b]; }
  /// The body's cut, made when it is asked for. Throws Error (bad_input) for a body that cannot be cut.
  [[nodiscard]] BodyCut& cut(std::size_t b);
  [[nodiscard]] const BodyCut* find_cut(std::size_t b) const { return cuts_[b].get(); }
  /// nullptr for a body that does not tear.
  [[nodiscard]] TornBody* torn(std::size_t b) { return torn_[b].get(); }
  [[nodiscard]] const BodyMesh& solid(std::size_t b) const;
  [[nodiscard]] std::vector<const BodyMesh*> solids() const;

  /// Make the edits of a state, which may come from anywhere. Throws Error (bad_input) for those that do not belong to these
  /// bodies; the bodies are then in no defined state.
  void replay(const RunState& state);
  /// One body as the state has it, after an edit that failed.
  void rebuild(std::size_t b, const RunState& state);

  /// The model as it would be with a few cells cut: it has the kinds of elements, loads and tables that cuts bring.
  [[nodiscard]] Model trial_model() const;

  SurfaceCopy surface_copy;
  HelperThread helper;  ///< divides surfaces while elements become a model

 private:
  void make_torn(std::size_t b);
  void replay_tears(const RunState& state);

  const Scene& scene_;
  std::vector<std::shared_ptr<const BodyMesh>> uncut_;
  std::vector<std::unique_ptr<BodyCut>> cuts_;
  std::vector<std::unique_ptr<TornBody>> torn_;
};

}  // namespace pliant
