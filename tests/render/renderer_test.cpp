// Pictures: the same bytes every time, the right silhouette, and what refit, cuts and colours do to them.
#include <gtest/gtest.h>

#include <algorithm>

#include "render/color.h"
#include "render/ray_scene.h"
#include "shapes.h"

namespace pliant::render {
namespace {

RenderOptions small() {
  RenderOptions o;
  o.width = 96;
  o.height = 72;
  o.samples = 8;
  return o;
}

Camera camera_for(const TestSurface& s, float aspect = 96.0F / 72) {
  return fit_camera({}, s.positions, {0, 1, 0}, {aspect, 0.1F, 0});
}

std::array<int, 3> color_at(const Image& image, int x, int y) {
  const std::uint8_t* p = image.rgb.data() + 3 * (y * image.width + x);
  return {p[0], p[1], p[2]};
}

/// Tissue is much redder than blue; sky and ground are not.
bool is_tissue(const std::array<int, 3>& c) { return c[0] > c[2] + 30; }

class Picture : public testing::Test {
 protected:
  void SetUp() override {
    if (!Renderer::available()) GTEST_SKIP() << Renderer::missing();
  }
};

TEST(PictureWithoutEmbree, IsRefusedWithItsReason) {
  if (Renderer::available()) GTEST_SKIP() << "this build has Embree";
  EXPECT_NE(message_of([] { Renderer renderer; }).find("Embree"), std::string::npos);
}

TEST_F(Picture, HasTheSameBytesOnOneAndTwoThreadsAndTwice) {
  const TestSurface s = sphere(0.1F);
  std::vector<Image> images;
  for (const int threads : {1, 2, 2}) {
    Renderer renderer(threads);
    renderer.update(s.view());
    images.push_back(renderer.render(camera_for(s), small()));
  }
  EXPECT_EQ(images[0].rgb, images[1].rgb);
  EXPECT_EQ(images[1].rgb, images[2].rgb);
}

TEST_F(Picture, AfterRefitIsThatOfARebuild) {
  TestSurface s = sphere(0.1F);
  Renderer moved(1), anew(1);
  moved.update(s.view());
  EXPECT_TRUE(moved.times().rebuilt);
  for (std::size_t i = 1; i < s.positions.size(); i += 3) s.positions[i] *= 0.6F;  // flattened
  moved.update(s.view());
  EXPECT_FALSE(moved.times().rebuilt);
  anew.update(s.view());
  const Camera camera = camera_for(s);
  const Image a = moved.render(camera, small()), b = anew.render(camera, small());
  int largest = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) largest = std::max(largest, std::abs(a.rgb[i] - b.rgb[i]));
  EXPECT_LE(largest, 1);
}

TEST_F(Picture, IsRebuiltWhenTheTopologyChanges) {
  TestSurface s = cube(0.1F);
  Renderer renderer(1);
  renderer.update(s.view());
  Surface other = s.view();
  other.topology = 1;
  renderer.update(other);
  EXPECT_TRUE(renderer.times().rebuilt);
  renderer.update(other);
  EXPECT_FALSE(renderer.times().rebuilt);
}

TEST_F(Picture, OfASphereHasItsSilhouette) {
  const float r = 0.1F;
  const TestSurface s = sphere(r);
  Renderer renderer(2);
  renderer.update(s.view());
  RenderOptions o = small();
  o.ground = false;
  Camera camera;
  camera.eye = {0, r, 0.6F};
  camera.axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  camera.half_height = 0.3F;
  const Image image = renderer.render(camera, o);
  // The cone of tangents from the eye has the half-angle asin(r / distance).
  const float radius = std::tan(std::asin(r / 0.6F)) / camera.half_height * 36;  // pixels
  int tissue = 0, wrong = 0;
  for (int y = 0; y < 72; ++y) {
    for (int x = 0; x < 96; ++x) {
      const float away = std::hypot(static_cast<float>(x) + 0.5F - 48, static_cast<float>(y) + 0.5F - 36);
      const bool seen = is_tissue(color_at(image, x, y));
      tissue += seen;
      if (std::fabs(away - radius) > 1.5F && seen != (away < radius)) ++wrong;
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_NEAR(tissue, std::numbers::pi * radius * radius, 0.05 * std::numbers::pi * radius * radius);
}

TEST_F(Picture, OfASphereIsLitFromTheUpperLeft) {
  const TestSurface s = sphere(0.1F);
  Renderer renderer(2);
  renderer.update(s.view());
  const Image image = renderer.render(camera_for(s), small());
  const auto sum = [&](int x, int y) {
    const auto c = color_at(image, x, y);
    return c[0] + c[1] + c[2];
  };
  EXPECT_GT(sum(40, 26), sum(58, 48) + 60);
}

TEST_F(Picture, ShowsTheShadowOnTheGround) {
  const TestSurface s = sphere(0.1F);
  Renderer renderer(2);
  renderer.update(s.view());
  RenderOptions with = small(), without = small();
  without.ground = false;
  const Image a = renderer.render(camera_for(s), with), b = renderer.render(camera_for(s), without);
  int darker = 0;
  for (int y = 0; y < 72; ++y) {
    for (int x = 0; x < 96; ++x) darker += !is_tissue(color_at(b, x, y)) && color_at(a, x, y)[1] + 20 < color_at(b, x, y)[1];
  }
  EXPECT_GT(darker, 50);
}

TEST_F(Picture, ShowsCutFacesInAnotherColour) {
  const TestSurface s = cube(0.1F);
  std::vector<std::uint8_t> cut(12, 0);
  cut[10] = cut[11] = 1;  // +z, towards the viewer
  Surface surface = s.view();
  Renderer renderer(1);
  renderer.update(surface);
  const Image whole = renderer.render(camera_for(s), small());
  surface.cut = cut;
  surface.topology = 1;
  renderer.update(surface);
  const Image opened = renderer.render(camera_for(s), small());
  const auto before = color_at(whole, 42, 42), after = color_at(opened, 42, 42);
  EXPECT_GT(after[1] + after[2], before[1] + before[2] + 60) << "the face in front";
  EXPECT_TRUE(is_tissue(before));
}

TEST_F(Picture, TakesFourFloatsPerVertexToo) {
  const TestSurface s = cube(0.1F);
  std::vector<float> wide;
  for (std::size_t v = 0; v < 8; ++v)
    wide.insert(wide.end(), {s.positions[3 * v], s.positions[3 * v + 1], s.positions[3 * v + 2], 7});
  Surface surface = s.view();
  Renderer a(1), b(1);
  a.update(surface);
  surface.positions = wide;
  surface.stride = 4;
  b.update(surface);
  EXPECT_EQ(a.render(camera_for(s), small()).rgb, b.render(camera_for(s), small()).rgb);
}

TEST_F(Picture, ColoursValuesBetweenTheEndsOfTheRange) {
  const TestSurface s = cube(0.1F);
  const std::vector<float> low(8, 3), high(8, 9);
  RenderOptions o = small();
  o.low = 3;
  o.high = 9;
  Surface surface = s.view();
  Renderer renderer(1);
  surface.values = low;
  renderer.update(surface);
  const auto dark = color_at(renderer.render(camera_for(s), o), 42, 42);
  surface.values = high;
  renderer.update(surface);
  const auto light = color_at(renderer.render(camera_for(s), o), 42, 42);
  EXPECT_GT(dark[2], dark[1] + 20) << "violet";
  EXPECT_GT(light[1], light[2] + 40) << "yellow";
}

TEST_F(Picture, RefusesWhatDoesNotFit) {
  const TestSurface s = cube(0.1F);
  Renderer renderer(1);
  Surface surface = s.view();
  const std::vector<std::int32_t> outside{0, 1, 8};
  surface.triangles = outside;
  EXPECT_NE(message_of([&] { renderer.update(surface); }).find("a vertex that is not there"), std::string::npos);
  renderer.update(s.view());
  RenderOptions o = small();
  o.width = 0;
  EXPECT_NE(message_of([&] { (void)renderer.render(camera_for(s), o); }).find("0 x 72"), std::string::npos);
  o = small();
  o.samples = 0;
  EXPECT_NE(message_of([&] { (void)renderer.render(camera_for(s), o); }).find("0 samples"), std::string::npos);
}

TEST_F(Picture, OfNothingIsBackground) {
  Renderer renderer(1);
  renderer.update({});
  const Image image = renderer.render(Camera{{0, 1, 3}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, small());
  EXPECT_FALSE(is_tissue(color_at(image, 48, 36)));
}

}  // namespace
}  // namespace pliant::render
