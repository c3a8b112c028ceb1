// What the probes of a scene say of a simulation's present state.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "scene/probe.h"
#include "simulation/simulation.h"

namespace pliant {

/// What a probe says now: what it was asked for.
struct ProbeState {
  std::optional<Vec3d> position, displacement, velocity, reaction, force;  ///< [m], [m], [m/s], [N], [N]
  struct Energy {
    double kinetic = 0, strain = 0;  ///< [J]
  };
  std::optional<Energy> energy;
  std::optional<std::array<double, 6>> stress;  ///< xx, yy, zz, xy, yz, zx [Pa]

  /// Of a quantity that it was asked for, in the order of the members: three, six of a stress, two of an energy.
  [[nodiscard]] std::vector<double> numbers(Quantity quantity) const;
};

/// Probes and where they are.
class PlacedProbes {
 public:
  PlacedProbes() = default;
  /// Finds the element at rest that holds each point, in the order of bodies and elements. `uncut`: the model as the scene
  /// gives it. Throws Error for two of one name, for a point in no element, with the distance to the nearest one, and for a
  /// selection without nodes.
  PlacedProbes(const std::vector<SceneProbe>& probes, const Model& uncut);

  [[nodiscard]] bool empty() const { return places_.empty(); }
  [[nodiscard]] std::size_t size() const { return places_.size(); }
  [[nodiscard]] const SceneProbe& probe(std::size_t i) const { return places_[i].probe; }
  [[nodiscard]] std::size_t body(std::size_t i) const { return places_[i].body; }
  /// Points are interpolated in their element. In a cell that a blade has divided it is the copy that holds the point's
  /// material. Changes nothing in the simulation.
  [[nodiscard]] std::vector<ProbeState> states(Simulation& simulation) const;

 private:
  struct Place {
    SceneProbe probe;
    std::size_t body = 0;
    std::size_t element = 0;          ///< of the uncut body
    std::array<double, 8> weights{};  ///< of its corners, in the order of ModelBody
  };
  [[nodiscard]] static std::size_t element_now(const Simulation& simulation, const Place& place);
  [[nodiscard]] static ProbeState at_point(const Simulation& simulation, const Place& place, const std::vector<Vec3d>& u,
                                           const std::vector<Vec3d>& v);
  [[nodiscard]] static ProbeState of_nodes(Simulation& simulation, const Place& place, const std::vector<Vec3d>& u,
                                           const std::vector<Vec3d>& v);
  static void find(Place& place, const Model& uncut);

  std::vector<Place> places_;
};

}  // namespace pliant
