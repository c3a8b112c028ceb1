// Material points that a run follows: --probe NAME=x,y,z.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "simulation/simulation.h"

namespace pliant::cli {

/// What was asked for.
struct ProbePoint {
  std::string name;
  Vec3d rest{};  ///< [m]
};

/// From "NAME=x,y,z". Throws Error that says what is allowed.
ProbePoint parse_probe(const std::string& text);

/// Where a probe is now.
struct ProbeState {
  Vec3d position{}, displacement{}, velocity{};  ///< [m], [m], [m/s]
};

class Probes {
 public:
  Probes() = default;
  /// Finds the element at rest that holds each point, in the order of bodies and elements. `uncut`: the model as the scene
  /// gives it. Throws Error for two of one name, and for a point in no element, with the distance to the nearest one.
  Probes(std::vector<ProbePoint> points, const Model& uncut);

  [[nodiscard]] bool empty() const { return places_.empty(); }
  [[nodiscard]] std::size_t size() const { return places_.size(); }
  [[nodiscard]] const ProbePoint& point(std::size_t i) const { return places_[i].point; }
  [[nodiscard]] std::size_t body(std::size_t i) const { return places_[i].body; }
  /// Interpolated in the element. In a cell that a blade has divided it is the copy that holds the point's material.
  [[nodiscard]] std::vector<ProbeState> states(const Simulation& simulation) const;

  /// Add a row per probe, and replace the file; it is always complete.
  void write(const Simulation& simulation, const std::filesystem::path& file);

 private:
  struct Place {
    ProbePoint point;
    std::size_t body = 0;
    std::size_t element = 0;          ///< of the uncut body
    std::array<double, 8> weights{};  ///< of its corners, in the order of ModelBody
  };
  [[nodiscard]] static std::size_t element_now(const Simulation& simulation, const Place& place);

  std::vector<Place> places_;
  std::string table_;
  std::int64_t last_step_ = -1;
};

}  // namespace pliant::cli
