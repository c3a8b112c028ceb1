// What a user does to the surface between two batches: grabs on springs, pushes, and the place of the scene's tool.
#pragma once
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "pliant/world.h"
#include "solver/simulation.h"

namespace pliant::api {

/// A node of a body and its share of something.
struct NodeShare {
  std::size_t body = 0;
  std::int64_t node = 0;
  double share = 0;
};

/// The caller's thread changes the tools, the thread that steps reads them at the start of a batch; neither waits for the other
/// longer than it takes to copy a few numbers.
class Tools {
 public:
  /// `model` is that of the start: bodies and their nodes keep their numbers when an operational region moves.
  Tools(std::shared_ptr<const Model> model, const Scene& scene);

  GrabId grab(std::int32_t vertex, const GrabOptions& options);
  void move(GrabId id, const Vec3d& target);
  void release(GrabId id);
  void push(std::int32_t vertex, const Vec3d& force);
  void push_node(std::size_t body, std::int64_t node, const Vec3d& force);
  void move_tool(const Vec3d& position);
  void clear();

  /// Bring the simulation's forces up to date, at the start of a batch; how many steps the batch may have.
  std::int32_t apply(Simulation& simulation);

 private:
  /// A grab, as the caller sees it.
  struct Grab {
    std::int32_t vertex = 0;
    std::optional<Vec3d> target;  ///< [m]; none yet: where the vertex is
    std::size_t body = 0;
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

  [[nodiscard]] std::vector<NodeShare> nodes_of(std::int32_t vertex) const;
  void check_vertex(std::int32_t vertex) const;
  Vec3d pull(const Grab& grab, Pull& state, const Vec3d& position, double time, double period) const;

  std::shared_ptr<const Model> model_;
  std::vector<Material> materials_;
  std::vector<std::pair<std::size_t, std::int64_t>> node_of_;  ///< [slots] body, node
  std::mutex mutex_;
  GrabId last_id_ = 0;
  std::map<GrabId, Grab> grabs_;
  std::map<std::int32_t, Vec3d> pushes_;
  std::map<std::pair<std::size_t, std::int64_t>, Vec3d> node_pushes_;
  std::optional<Vec3d> tool_;
  bool changed_ = false;
  std::map<GrabId, Pull> pulls_;  ///< of the stepping thread alone
};

}  // namespace pliant::api
