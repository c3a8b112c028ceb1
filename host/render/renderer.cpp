#include "render/renderer.h"

#include <fmt/format.h>

#include "geometry/stopwatch.h"
#include "pliant/error.h"
#include "render/ray_scene.h"
#include "render/trace.h"

namespace pliant::render {

struct Renderer::Scene {
  int threads = 0;
  RayScene rays;
  RenderTimes times;
};

Renderer::Renderer(int threads) : scene_(std::make_unique<Scene>()) { scene_->threads = threads; }
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::update(const Surface& surface) {
  const Stopwatch clock;
  scene_->times.rebuilt = scene_->rays.update(surface);
  scene_->times.refit = clock.seconds();
}

Image Renderer::render(const Camera& camera, const RenderOptions& options) {
  if (options.width < 1 || options.height < 1 || options.width > 16384 || options.height > 16384) {
    throw Error(ErrorCode::bad_input,
                fmt::format("a picture of {} x {} pixels: expected 1 to 16384 each", options.width, options.height));
  }
  if (options.samples < 1 || options.samples > 4096) {
    throw Error(ErrorCode::bad_input, fmt::format("{} samples per pixel: expected 1 to 4096", options.samples));
  }
  const Stopwatch clock;
  Image image = trace(scene_->rays, camera, options, scene_->threads);
  scene_->times.trace = clock.seconds();
  return image;
}

const RenderTimes& Renderer::times() const { return scene_->times; }

bool Renderer::available() { return RayScene::available(); }
const char* Renderer::missing() {
  return "pictures need Embree 3, and this build of Pliant was made without it (PLIANT_EMBREE)";
}

}  // namespace pliant::render
