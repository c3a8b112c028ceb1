// What a run follows over time: --probe NAME=x,y,z, and the probes of a scene.
#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/probe.h"
#include "simulation/simulation.h"

namespace pliant::cli {

/// From "NAME=x,y,z". Throws Error that says what is allowed.
SceneProbe parse_probe(const std::string& text);

/// What a probe says now: what it was asked for.
struct ProbeState {
  std::optional<Vec3d> position, displacement, velocity, reaction, force;  ///< [m], [m], [m/s], [N], [N]
  struct Energy {
    double kinetic = 0, strain = 0;  ///< [J]
  };
  std::optional<Energy> energy;
  std::optional<std::array<double, 6>> stress;  ///< xx, yy, zz, xy, yz, zx [Pa]
};

class Probes {
 public:
  Probes() = default;
  /// Finds the element at rest that holds each point, in the order of bodies and elements. `uncut`: the model as the scene
  /// gives it. Throws Error for two of one name, for a point in no element, with the distance to the nearest one, and for a
  /// selection without nodes.
  Probes(std::vector<SceneProbe> probes, const Model& uncut);

  [[nodiscard]] bool empty() const { return places_.empty(); }
  [[nodiscard]] std::size_t size() const { return places_.size(); }
  [[nodiscard]] const SceneProbe& probe(std::size_t i) const { return places_[i].probe; }
  [[nodiscard]] std::size_t body(std::size_t i) const { return places_[i].body; }
  /// Points are interpolated in their element. In a cell that a blade has divided it is the copy that holds the point's
  /// material.
  [[nodiscard]] std::vector<ProbeState> states(Simulation& simulation) const;

  /// Add a row per probe to one table, and replace the file; it is always complete.
  void write(Simulation& simulation, const std::filesystem::path& file);
  /// The same to a table per probe, FOLDER/STEM_NAME.csv.
  void write_each(Simulation& simulation, const std::filesystem::path& folder, const std::string& stem);

 private:
  struct Place {
    SceneProbe probe;
    std::size_t body = 0;
    std::size_t element = 0;          ///< of the uncut body
    std::array<double, 8> weights{};  ///< of its corners, in the order of ModelBody
    std::string table{};              ///< of write_each
  };
  [[nodiscard]] static std::size_t element_now(const Simulation& simulation, const Place& place);
  [[nodiscard]] static ProbeState at_point(const Simulation& simulation, const Place& place, const std::vector<Vec3d>& u,
                                           const std::vector<Vec3d>& v);
  [[nodiscard]] static ProbeState of_nodes(Simulation& simulation, const Place& place, const std::vector<Vec3d>& u,
                                           const std::vector<Vec3d>& v);
  static void find(Place& place, const Model& uncut);

  std::vector<Place> places_;
  std::string table_;
  std::int64_t last_step_ = -1;
};

}  // namespace pliant::cli
