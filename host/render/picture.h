// Pictures of a simulation: `pliant run --format png`.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/vec.h"
#include "render/annotations.h"
#include "render/renderer.h"
#include "render/tool_surface.h"
#include "simulation/measure/surface_fields.h"
#include "simulation/simulation.h"

namespace pliant::render {

/// A copy of a simulation's present surface, as it is cut now, in the form that the renderer takes.
struct SurfaceCopy {
  std::vector<float> positions;
  std::vector<std::int32_t> triangles, body;
  std::vector<std::uint8_t> cut;
  std::uint64_t topology = 0;

  void read(Simulation& simulation);
  [[nodiscard]] Surface view() const;
};

struct PictureOptions {
  int width = 1280, height = 720;
  int samples = 16;
  ColorBy color = ColorBy::none;
  std::optional<std::pair<double, double>> range;  ///< of the colours, in m, J/m^3 or Pa; absent: from the values
  bool bar = true;                                 ///< draw the colour bar, or the key of models
  int threads = 0;
};

class Pictures {
 public:
  /// Throws Error in a build without Embree, or for a size out of range.
  explicit Pictures(const PictureOptions& options);

  /// The present state. The camera and the colours' range stay as the first picture needed them; the range grows when values
  /// do. A camera that the scene does not place moves back when the bodies would leave the picture, and follows when all have
  /// left their surroundings; the ground sinks with them by their first size at most. Throws Error when the scene has no
  /// surface.
  Image draw(Simulation& simulation);

  [[nodiscard]] const RenderTimes& times() const { return renderer_.times(); }

 private:
  void aim(Simulation& simulation, const std::vector<float>& positions);
  [[nodiscard]] float aspect() const;
  [[nodiscard]] std::vector<float> surroundings(const std::vector<float>& positions) const;
  [[nodiscard]] bool in_picture(const std::vector<float>& points) const;
  void color(Simulation& simulation, Surface& surface);
  void add_others(Simulation& simulation, Surface& surface);
  void annotate(Image& image) const;

  PictureOptions o_;
  Renderer renderer_;
  std::optional<Camera> camera_;
  std::vector<float> held_;  ///< [3 * n] places that are known beforehand [m]
  vec::Box start_;           ///< of the first picture, with those
  bool has_ground_ = true;
  float ground_ = 0, first_ground_ = 0;
  double largest_ = 0;  ///< value so far
  Ticks ticks_;
  SurfaceCopy surface_;
  ToolSurfaces tools_;
  std::vector<float> values_, kinds_;
  std::string elements_;  ///< what kind 0 is called
};

}  // namespace pliant::render
