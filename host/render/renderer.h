// Pictures of a moving surface by ray tracing: soft key light and sky with shadows and contact shadow on a ground plane. The
// same input gives the same bytes whatever the number of threads. Needs Embree 3.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "io/image.h"
#include "render/camera.h"

namespace pliant::render {

/// A surface as its owner holds it; nothing is copied but positions, and triangles when `topology` changes.
struct Surface {
  std::span<const float> positions;         ///< [stride * vertices] x, y, z and numbers that the renderer skips [m]
  std::size_t stride = 3;                   ///< floats from one vertex to the next
  std::span<const std::int32_t> triangles;  ///< [3 * triangles] vertices, outward by the right-hand rule
  std::span<const std::uint8_t> cut;        ///< [triangles] not 0: made by a cut; empty: no cuts
  std::span<const std::int32_t>
      body;  ///< [triangles] numbers that choose a tint, negative: a tool, a spring or a vessel; empty: all the same
  std::span<const float> values;  ///< [vertices] coloured by the map when not empty
  std::span<const float> kinds;   ///< [3 * vertices] shares of three kinds, coloured by the largest when not empty
  std::uint64_t topology = 0;     ///< changes whenever triangles, cut or the number of vertices do
};

struct RenderOptions {
  int width = 1280, height = 720;
  int samples = 16;         ///< per pixel
  float low = 0, high = 1;  ///< values at the ends of the colour map
  bool color_cuts = true;   ///< apply values and kinds to faces of cuts too; otherwise those have the colour of flesh
  bool ground = true;
  std::optional<float> ground_height;  ///< along the camera's up [m]; absent: the lowest vertex
};

/// Seconds of the last update and the last picture.
struct RenderTimes {
  double refit = 0, trace = 0;
  bool rebuilt = false;  ///< true if the last update rebuilt the hierarchy
};

class Renderer {
 public:
  /// threads: 0 for all of the machine. Throws Error in a build without Embree.
  explicit Renderer(int threads = 0);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Take over the present surface: refit the hierarchy, or rebuild it when `topology` or a count has changed. The spans must
  /// stay valid until the next update. Throws Error (internal) when counts do not fit or a triangle names a vertex that is not
  /// there.
  void update(const Surface& surface);
  /// Throws Error for a size or number of samples out of range (1 to 16384 pixels, 1 to 4096 samples).
  [[nodiscard]] Image render(const Camera& camera, const RenderOptions& options);

  [[nodiscard]] const RenderTimes& times() const;

  /// Whether this build can draw, and the message when it cannot.
  static bool available();
  static const char* missing();

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace pliant::render
