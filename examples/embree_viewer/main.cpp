// A renderer that embeds Pliant: simulate, hand the surface over, trace, write a picture, again. Prints what each of these
// costs. Skin is coloured by displacement, faces of cuts as flesh; a cut makes the hierarchy of rays anew, motion only refits
// it.
//   embree_viewer SCENE [FOLDER] [FRAMES] [SAMPLES]
#include <pliant/world.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/png.h"
#include "render/annotations.h"
#include "render/renderer.h"

namespace {

using Clock = std::chrono::steady_clock;
double ms_since(Clock::time_point start) { return std::chrono::duration<double, std::milli>(Clock::now() - start).count(); }

template <class To, class Array>
std::span<const To> flat(const pliant::View<Array>& view) {
  return {reinterpret_cast<const To*>(view.data()), view.size() * sizeof(Array) / sizeof(To)};
}

/// A frame's arrays as the renderer takes them; nothing is copied.
pliant::render::Surface surface_of(const pliant::Frame& frame) {
  pliant::render::Surface s;
  s.positions = flat<float>(frame.positions);
  s.stride = 4;
  s.triangles = flat<std::int32_t>(frame.triangles);
  s.cut = flat<std::uint8_t>(frame.cut_faces);
  s.topology = frame.topology_version;
  return s;
}

pliant::render::Camera camera_of(const pliant::Frame& frame, float aspect) {
  std::vector<float> points;
  for (const pliant::Vec4f& p : frame.positions) points.insert(points.end(), {p[0], p[1], p[2]});
  pliant::render::Framing framing;
  framing.aspect = aspect;
  framing.margin = 0.15F;
  framing.right = pliant::render::kBarShare;
  return pliant::render::fit_camera({}, points, {0, 1, 0}, framing);
}

std::vector<float> displacement_of(const pliant::Frame& frame) {
  std::vector<float> length(frame.positions.size());
  for (std::size_t v = 0; v < length.size(); ++v) {
    const pliant::Vec4f &x = frame.positions[v], &rest = frame.rest[v];
    length[v] = std::hypot(x[0] - rest[0], x[1] - rest[1], x[2] - rest[2]);
  }
  return length;
}

struct Costs {
  double simulate = 0, refit = 0, trace = 0;
};

void print(const char* what, const Costs& c, double frames, bool rebuilt) {
  std::printf("%-8s simulate %8.2f ms   refit %7.2f ms   trace %8.2f ms%s\n", what, c.simulate / frames, c.refit / frames,
              c.trace / frames, rebuilt ? "   (hierarchy built)" : "");
}

int run(const std::string& scene, const std::filesystem::path& folder, int frames, int samples) {
  pliant::World world = pliant::World::open(scene);
  pliant::render::Renderer renderer;
  pliant::render::RenderOptions options;
  options.width = 640;
  options.height = 480;
  options.samples = samples;
  options.color_cuts = false;  // inside is flesh
  const pliant::render::Ticks ticks = pliant::render::nice_ticks(0, 30);
  options.high = static_cast<float>(ticks.high / 1000);
  std::filesystem::create_directories(folder);

  pliant::FramePtr frame = world.frame();
  const pliant::render::Camera camera = camera_of(*frame, 640.0F / 480);
  std::printf("%zu vertices, %zu triangles, %lld nodes on %s\n", frame->positions.size(), frame->triangles.size(),
              static_cast<long long>(world.info().nodes), world.info().device.c_str());
  Costs sum;
  for (int i = 0; i < frames; ++i) {
    Costs now;
    const auto start = Clock::now();
    const pliant::StepReport report = world.advance(1.0 / 60);
    frame = world.frame();
    now.simulate = ms_since(start);
    if (report.diverged) std::fprintf(stderr, "embree_viewer: %s\n", report.message.c_str());

    const std::vector<float> values = displacement_of(*frame);
    pliant::render::Surface surface = surface_of(*frame);
    surface.values = values;
    renderer.update(surface);
    pliant::Image image = renderer.render(camera, options);
    now.refit = 1e3 * renderer.times().refit;
    now.trace = 1e3 * renderer.times().trace;
    pliant::render::draw_color_bar(image, {"displacement", "mm", ticks});
    char name[32];
    std::snprintf(name, sizeof name, "frame_%04d.png", i);
    pliant::write_png(folder / name, image);
    print(name, now, 1, renderer.times().rebuilt);
    if (i > 0) {  // the first frame builds the hierarchy
      sum.simulate += now.simulate;
      sum.refit += now.refit;
      sum.trace += now.trace;
    }
    if (report.diverged) return 4;
  }
  if (frames > 1) print("mean", sum, frames - 1, false);
  return 0;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) {
    std::fprintf(stderr, "usage: embree_viewer SCENE [FOLDER] [FRAMES] [SAMPLES]\n");
    return 2;
  }
  const int frames = argc > 3 ? std::atoi(argv[3]) : 30, samples = argc > 4 ? std::atoi(argv[4]) : 8;
  return run(argv[1], argc > 2 ? argv[2] : "out/embree_viewer", frames, samples);
} catch (const std::exception& error) {
  std::fprintf(stderr, "embree_viewer: %s\n", error.what());
  return 2;
}
