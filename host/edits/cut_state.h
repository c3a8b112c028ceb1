// The bodies of a simulation that are cut, and where its blades are. Private to host/solver.
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
#include "edits/helper_thread.h"
#include "model/solid.h"

namespace pliant {

/// One body: as it was filled, its cut, its surface.
class BodyCut {
 public:
  /// Throws Error for a body that cannot be cut.
  BodyCut(const Body& body, std::shared_ptr<const Solid> uncut);

  [[nodiscard]] const CutTopology& topology() const { return topology_; }
  /// Take out edges that may not be cut: those of cells left to shape matching where the scene says so.
  void keep_allowed(const Body& body, CutEdges& edges) const;
  /// Divide the elements, and let `helper` begin with the surface. Throws, with nothing changed, what CutTopology::cut throws.
  CutEdit cut(const CutEdges& edges, HelperThread& helper);
  /// Bring the elements of solid(), or its surface, up to date after an edit: only what it changed. Both may run at once.
  void update_elements() { update_solid_elements(*uncut_, topology_, solid_); }
  void update_surface();
  /// Take the last edit back.
  void undo();
  /// The body as it is cut now, in what was brought up to date.
  [[nodiscard]] const Solid& solid() const { return solid_; }
  /// Edits so far, in order.
  [[nodiscard]] const std::vector<CutEdges>& history() const { return history_; }
  /// Mean edge of a cell at rest [m].
  [[nodiscard]] double edge() const { return edge_; }
  [[nodiscard]] const CutSurface* surface() const { return surface_.get(); }
  [[nodiscard]] RestEdges& rest_edges() { return *rest_edges_; }

 private:
  void make_surface();
  std::shared_ptr<const Solid> uncut_;
  Solid solid_;
  CutTopology topology_;
  std::unique_ptr<CutSurface> surface_;  ///< of a lattice
  std::future<void> dividing_;           ///< the helper's work on it
  std::unique_ptr<RestEdges> rest_edges_;
  std::vector<CutEdges> history_;
  double edge_ = 0;
};

/// Where a blade goes in one look: first along straight lines to each of these places. `key` names it in the state.
struct BladeMove {
  std::string key;
  BladeSegment from{};
  std::vector<BladeSegment> to;
};

/// Not a volume mesh of hexahedra.
bool can_be_cut(const Solid& solid);

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

/// All bodies of a scene; those that were neither prepared nor touched by a blade have no BodyCut.
struct CutState {
  explicit CutState(const Scene& scene);
  std::vector<std::shared_ptr<const Solid>> uncut;
  std::vector<std::unique_ptr<BodyCut>> bodies;
  [[nodiscard]] BodyCut& body(const Scene& scene, std::size_t b);
  [[nodiscard]] std::vector<const Solid*> solids() const;
  /// The model as it would be with a few cells cut: it has the kinds of elements, loads and tables that cuts bring.
  [[nodiscard]] Model trial_model(const Scene& scene) const;
  std::vector<SweepTriangle> pending_triangles;  ///< wait for a step of shape matching
  std::vector<BladeMove> pending_moves;          ///< likewise
  SurfaceCopy surface_copy;
  HelperThread helper;  ///< divides surfaces while elements become a model
};

}  // namespace pliant
