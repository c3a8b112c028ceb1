// Interactive tools: grabs, pushes, and the point that operational regions follow.
#pragma once
#include <compare>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "api/force_trace.h"
#include "pliant/world.h"
#include "simulation/simulation.h"

namespace pliant::api {

/// A node of a body with a weight.
struct NodeShare {
  std::size_t body = 0;
  std::int64_t node = 0;
  double share = 0;
};

/// A vertex by its number within its body, which cuts do not change.
struct SurfaceVertex {
  std::size_t body = 0;
  std::int32_t local = 0;
  auto operator<=>(const SurfaceVertex&) const = default;
};

/// The caller's thread changes the handles; the stepping thread reads them at the start of a batch. Neither blocks the other
/// for longer than it takes to copy a few numbers.
class SurfaceHandles {
 public:
  SurfaceHandles(std::shared_ptr<const Model> model, const Scene& scene);

  /// Call after the simulation's model changed by a cut or a moved operational region. Grabs and pushes continue on the nodes
  /// that now move their part of the surface.
  void follow(std::shared_ptr<const Model> model);

  GrabId grab(const SurfaceVertex& vertex, const GrabOptions& options);
  void move(GrabId id, const Vec3d& target);
  [[nodiscard]] GrabState state(GrabId id);
  [[nodiscard]] std::vector<ForceSample> trace(GrabId id, std::int64_t after);
  void release(GrabId id);
  void push(const SurfaceVertex& vertex, const Vec3d& force);
  void push_node(std::size_t body, std::int64_t node, const Vec3d& force);
  void move_focus(const Vec3d& position);
  /// From now on the focus is for the simulation to come, which go_on() announces.
  void hold_back();
  void go_on();
  void clear();
  /// Call after the simulation was replaced, so that its forces are set again.
  void renew();

  /// Updates the simulation's forces at the start of a batch. Returns the maximum number of steps of the batch.
  std::int32_t apply(Simulation& simulation);
  /// A grab whose force has reached its limit.
  struct Limit {
    GrabId grab = 0;
    Vec3d position{};  ///< of its vertex [m]
    double force = 0;  ///< [N]
  };
  /// Returns what apply() has found since the last call. For the stepping thread.
  std::vector<Limit> limits() { return std::exchange(limits_, {}); }

 private:
  /// A grab as set by the caller.
  struct Grab {
    SurfaceVertex vertex;
    GrabOptions options;
    std::optional<Vec3d> target;   ///< [m]; empty: not set yet, the vertex's current position
    std::vector<NodeShare> point;  ///< weights of the vertex
    std::vector<NodeShare> patch;  ///< distribution of the force
    Vec3d rest{};
    double mass = 0, stiffness = 0, max_force = 0;
    GrabState felt;
  };
  /// State of a grab in the stepping thread.
  struct Pull {
    Vec3d target{}, before{}, held{};
    double time = 0;
  };

  // Require the mutex.
  void set_model(std::shared_ptr<const Model> model);
  [[nodiscard]] bool has(const SurfaceVertex& vertex) const;
  void check_vertex(const SurfaceVertex& vertex) const;
  [[nodiscard]] std::vector<NodeShare> nodes_of(const SurfaceVertex& vertex) const;
  void hold(Grab& grab) const;
  Vec3d pull(const Grab& grab, Pull& state, const Vec3d& position, const Vec3d& mean, double time, double period) const;

  std::vector<Material> materials_;
  std::mutex mutex_;
  std::shared_ptr<const Model> model_;                         ///< the model of the simulation
  std::vector<std::pair<std::size_t, std::int64_t>> node_of_;  ///< [slots] body, node
  GrabId last_id_ = 0;
  std::map<GrabId, Grab> grabs_;
  std::map<SurfaceVertex, Vec3d> pushes_;
  std::map<std::pair<std::size_t, std::int64_t>, Vec3d> node_pushes_;
  std::optional<Vec3d> focus_;
  bool holds_back_ = false;
  bool changed_ = false;
  std::map<GrabId, ForceTrace> traces_;
  // Used only by the stepping thread.
  std::map<GrabId, Pull> pulls_;
  std::vector<Limit> limits_;
};

}  // namespace pliant::api
