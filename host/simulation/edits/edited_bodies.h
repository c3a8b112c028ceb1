// The bodies of a simulation after cuts and tears. Private to host/edits.
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
#include "tearing/remade_body.h"
#include "tearing/swept_faces.h"
#include "tearing/torn_body.h"

namespace pliant {

/// One body: its elements before the cut, its cut topology and its surface.
class BodyCut {
 public:
  /// Throws Error if the body cannot be cut.
  BodyCut(const Body& body, std::shared_ptr<const BodyMesh> uncut);

  [[nodiscard]] const CutTopology& topology() const { return topology_; }
  /// Removes edges that may not be cut: those of shape-matching cells if the scene excludes them.
  void keep_allowed(const Body& body, CutEdges& edges) const;
  /// Splits the elements and starts the surface on `helper`. Throws what CutTopology::cut throws and then changes nothing.
  CutEdit cut(const CutEdges& edges, HelperThread& helper);
  /// Update the elements of solid(), or its surface, after an edit; only the changed part. Both may run concurrently.
  void update_elements() { update_body_elements(*uncut_, topology_, solid_); }
  void update_surface();
  /// Replays these edits on the uncut body.
  void rebuild(std::span<const CutEdges* const> edits);
  /// Returns the cut body as of the last updates.
  [[nodiscard]] const BodyMesh& solid() const { return solid_; }
  /// Mean edge length of an undeformed cell [m].
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
  std::unique_ptr<CutSurface> surface_;  ///< lattices only
  std::future<void> dividing_;           ///< pending work of the helper on surface_
  std::unique_ptr<RestEdges> rest_edges_;
  MeshEdges mesh_edges_;
  double edge_ = 0;
};

/// Returns true unless the body is a volume mesh of hexahedra.
bool can_be_cut(const BodyMesh& solid);

/// A copy of the current model's surface for the next edit to modify, made in the background while the bodies move.
class SurfaceCopy {
 public:
  void make(const std::shared_ptr<const Model>& model, HelperThread& helper);
  /// Returns the copy, or makes one now.
  [[nodiscard]] ModelSurface take(const Model& model);

 private:
  ModelSurface surface_;
  std::shared_ptr<const Model> model_;  ///< the model that surface_ was copied from
  std::future<void> made_;
};

/// The bodies of a scene before any edit, which never change.
using WholeBodies = std::vector<std::shared_ptr<const BodyMesh>>;

/// All bodies of a scene, with elements generated again independently of the first model. Each is either cut, torn, remade
/// (its elements divided or removed) or unchanged.
class EditedBodies {
 public:
  /// `whole`: of another object for the same scene; empty: they are generated, which takes as long as build_model. Throws what
  /// make_body_meshes throws, and Error (bad_input) for a body that shall be parted along its faces and is a lattice, shall
  /// tear and is not of tetrahedra, or has elements that the blades' method does not know.
  explicit EditedBodies(const Scene& scene, const WholeBodies& whole = {});
  /// Returns true if a material of the scene has a toughness.
  static bool tears(const Scene& scene);

  [[nodiscard]] std::size_t size() const { return uncut_.size(); }
  [[nodiscard]] const BodyMesh& uncut(std::size_t b) const { return *uncut_[b]; }
  [[nodiscard]] const WholeBodies& whole() const { return uncut_; }
  /// Returns the body's cut, created on first use. Throws Error (bad_input) if the body cannot be cut.
  [[nodiscard]] BodyCut& cut(std::size_t b);
  [[nodiscard]] const BodyCut* find_cut(std::size_t b) const { return cuts_[b].get(); }
  /// nullptr if the body neither tears nor is parted along its faces.
  [[nodiscard]] TornBody* torn(std::size_t b) { return torn_[b].get(); }
  /// What blades find in a body that is parted along its faces; nullptr for others.
  [[nodiscard]] SweptFaces* swept(std::size_t b) { return swept_[b].get(); }
  [[nodiscard]] const SweptFaces* find_swept(std::size_t b) const { return swept_[b].get(); }
  /// A body whose elements blades divide or remove; nullptr for others.
  [[nodiscard]] const RemadeBody* remade(std::size_t b) const { return remade_[b].get(); }
  /// Makes such an edit.
  NodeOrigins remake(std::size_t b, const CutEdges& crossed) { return remade_[b]->remake(crossed); }
  /// After it: gives what elements of the body carried the elements that carry it now.
  void follow(std::size_t b, BladeTrace& trace) const;
  void follow(std::size_t b, RunState& state) const;
  /// Returns true if blades cut the body, by whatever method.
  [[nodiscard]] bool meets_blades(std::size_t b) const {
    return remade_[b] != nullptr || swept_[b] != nullptr || can_be_cut(*uncut_[b]);
  }
  /// Breaks faces of torn(b), which a blade has passed or which stress breaks. Returns what TornBody::tear returns; empty if
  /// all of them wait.
  std::vector<std::int32_t> part(std::size_t b, const std::vector<TetFace>& faces, bool by_blade);

  // The same of all kinds of body that blades meet.
  /// Returns the body's elements now; the cut is created on first use.
  [[nodiscard]] const CutTopology& topology(std::size_t b);
  /// Mean edge of an undeformed element [m].
  [[nodiscard]] double edge(std::size_t b);
  /// Returns whether blades are followed in the undeformed body (RemadeBody::follows_at_rest).
  [[nodiscard]] bool follows_at_rest(std::size_t b) const { return remade_[b] == nullptr || remade_[b]->follows_at_rest(); }
  /// Returns the element of the whole body that a cell of topology() is, or is part of.
  [[nodiscard]] std::int32_t whole_element(std::size_t b, std::int32_t cell) const {
    return remade_[b] == nullptr ? cell : remade_[b]->solid().parts.of[static_cast<std::size_t>(cell)];
  }
  /// A sweep over the body with its nodes at `x` [m], which must outlive it; the next one of the body ends it.
  [[nodiscard]] BladeSweep sweep(std::size_t b, const std::vector<Vec3d>& x);
  /// Returns what triangles [m] cross now: edges, pairs of elements, or elements as pairs with themselves.
  [[nodiscard]] CutEdges crossed(std::size_t b, const std::vector<Vec3d>& x, std::span<const SweepTriangle> triangles);
  /// Removes what may not be cut (BodyCut::keep_allowed) or has come apart.
  void keep_allowed(std::size_t b, CutEdges& crossed);
  /// Finds the material at points of a region, as InverseMap does.
  [[nodiscard]] InverseMap inverse_map(std::size_t b, const std::vector<Vec3d>& x, const vec::Box& region, double reach);
  [[nodiscard]] const BodyMesh& solid(std::size_t b) const;
  [[nodiscard]] std::vector<const BodyMesh*> solids() const;

  /// Takes the materials of the scene, which have changed, for what tears.
  void follow_materials();

  /// Replays the edits of a state of unknown origin. Throws Error (bad_input) for edits that do not belong to these bodies;
  /// the bodies are then unusable.
  void replay(const RunState& state);
  /// Rebuilds one body from the state after a failed edit.
  void rebuild(std::size_t b, const RunState& state);

  /// Returns the model as it would be with a few cells cut, with the element kinds, loads and tables that cuts add.
  [[nodiscard]] Model trial_model() const;

  SurfaceCopy surface_copy;
  HelperThread helper;  ///< splits surfaces while the model is built

 private:
  void make_torn(std::size_t b);
  void make_remade(std::size_t b);
  void replay_tears(const RunState& state);

  const Scene& scene_;
  WholeBodies uncut_;
  std::vector<std::unique_ptr<BodyCut>> cuts_;
  std::vector<std::unique_ptr<TornBody>> torn_;
  std::vector<std::unique_ptr<SweptFaces>> swept_;
  std::vector<std::unique_ptr<RemadeBody>> remade_;
};

}  // namespace pliant
