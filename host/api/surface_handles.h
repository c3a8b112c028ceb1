// What a user does to the surface between two batches: grabs on springs, pushes, and the focus that operational regions can
// follow.
#pragma once
#include <compare>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "pliant/world.h"
#include "simulation/simulation.h"

namespace pliant::api {

/// A node of a body and its share of something.
struct NodeShare {
  std::size_t body = 0;
  std::int64_t node = 0;
  double share = 0;
};

/// A vertex by its number in its body, which cuts do not change.
struct SurfaceVertex {
  std::size_t body = 0;
  std::int32_t local = 0;
  auto operator<=>(const SurfaceVertex&) const = default;
};

/// The caller's thread changes the handles, the thread that steps reads them at the start of a batch; neither waits for the
/// other longer than it takes to copy a few numbers.
class SurfaceHandles {
 public:
  SurfaceHandles(std::shared_ptr<const Model> model, const Scene& scene);

  /// The simulation has another model now: a cut divided cells, or an operational region moved. What holds on to the surface
  /// goes on with the nodes that move it there.
  void follow(std::shared_ptr<const Model> model);

  GrabId grab(const SurfaceVertex& vertex, const GrabOptions& options);
  void move(GrabId id, const Vec3d& target);
  void release(GrabId id);
  void push(const SurfaceVertex& vertex, const Vec3d& force);
  void push_node(std::size_t body, std::int64_t node, const Vec3d& force);
  void move_focus(const Vec3d& position);
  void clear();
  /// The simulation is another one: its forces are these handles' to set.
  void renew();

  /// Bring the simulation's forces up to date, at the start of a batch; how many steps the batch may have.
  std::int32_t apply(Simulation& simulation);

 private:
  /// A grab, as the caller sees it.
  struct Grab {
    SurfaceVertex vertex;
    GrabOptions options;
    std::optional<Vec3d> target;   ///< [m]; none yet: where the vertex is
    std::vector<NodeShare> point;  ///< weights of the vertex
    std::vector<NodeShare> patch;  ///< shares of the pull
    Vec3d rest{};
    double mass = 0, stiffness = 0, max_force = 0;
  };
  /// What the stepping thread remembers of it.
  struct Pull {
    Vec3d target{}, before{}, held{};
    double time = 0;
  };

  // With the mutex held.
  void set_model(std::shared_ptr<const Model> model);
  [[nodiscard]] bool has(const SurfaceVertex& vertex) const;
  void check_vertex(const SurfaceVertex& vertex) const;
  [[nodiscard]] std::vector<NodeShare> nodes_of(const SurfaceVertex& vertex) const;
  void hold(Grab& grab) const;
  Vec3d pull(const Grab& grab, Pull& state, const Vec3d& position, double time, double period) const;

  std::vector<Material> materials_;
  std::mutex mutex_;
  std::shared_ptr<const Model> model_;                         ///< the one that the simulation runs
  std::vector<std::pair<std::size_t, std::int64_t>> node_of_;  ///< [slots] body, node
  GrabId last_id_ = 0;
  std::map<GrabId, Grab> grabs_;
  std::map<SurfaceVertex, Vec3d> pushes_;
  std::map<std::pair<std::size_t, std::int64_t>, Vec3d> node_pushes_;
  std::optional<Vec3d> focus_;
  bool changed_ = false;
  std::map<GrabId, Pull> pulls_;  ///< of the stepping thread alone
};

}  // namespace pliant::api
