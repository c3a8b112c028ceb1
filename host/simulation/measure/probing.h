// Evaluation of the scene's probes at the current state.
#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "scene/probe.h"
#include "simulation/measure/interpenetration.h"
#include "simulation/simulation.h"

namespace pliant {

/// Values of one probe. Only the requested quantities are set.
struct ProbeState {
  std::optional<Vec3d> position, displacement, velocity, reaction, force;  ///< [m], [m], [m/s], [N], [N]
  struct Energy {
    double kinetic = 0, strain = 0;  ///< [J]
  };
  std::optional<Energy> energy;
  std::optional<std::array<double, 6>> stress;                        ///< xx, yy, zz, xy, yz, zx [Pa]
  std::optional<std::array<double, 6>> green_strain, almansi_strain;  ///< xx, yy, zz, xy, yz, zx

  std::optional<Interpenetration> interpenetration;

  /// Returns the components of a requested quantity: three, six for stress and strain, two for energy, ten for
  /// interpenetration.
  [[nodiscard]] std::vector<double> numbers(Quantity quantity) const;
};

/// Probes with their location in the model.
class PlacedProbes {
 public:
  PlacedProbes() = default;
  /// Finds the undeformed element that contains each point, in the order of bodies and elements. `uncut`: the model as in the
  /// scene. Throws Error for duplicate names, for a point outside all elements (with the distance to the nearest one), and
  /// for a selection without nodes.
  PlacedProbes(const std::vector<SceneProbe>& probes, const Model& uncut);

  [[nodiscard]] bool empty() const { return places_.empty(); }
  [[nodiscard]] std::size_t size() const { return places_.size(); }
  [[nodiscard]] const SceneProbe& probe(std::size_t i) const { return places_[i].probe; }
  [[nodiscard]] std::size_t body(std::size_t i) const { return places_[i].body; }  ///< meaningless for one between two
  /// Evaluates all probes; the simulation is not changed. Points are interpolated within their element; in a cell that a
  /// blade has split, within the copy that holds the point's material.
  [[nodiscard]] std::vector<ProbeState> states(Simulation& simulation) const;

 private:
  struct Place {
    SceneProbe probe;
    std::size_t body = 0;
    std::size_t element = 0;          ///< element index in the uncut body
    std::array<double, 8> weights{};  ///< shape functions at the corners, in the order of ModelBody
  };
  [[nodiscard]] static std::size_t element_now(const Simulation& simulation, const Place& place);
  [[nodiscard]] static ProbeState at_point(const Simulation& simulation, const Place& was, const std::vector<Vec3d>& u,
                                           const std::vector<Vec3d>& v);
  [[nodiscard]] static ProbeState of_nodes(Simulation& simulation, const Place& place, const std::vector<Vec3d>& u,
                                           const std::vector<Vec3d>& v);
  static void find(Place& place, const Model& uncut);

  std::vector<Place> places_;
  std::shared_ptr<Interpenetrations> interpenetrations_;  ///< keeps the shapes of tools; null if no probe needs them
};

}  // namespace pliant
