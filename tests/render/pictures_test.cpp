// Pictures of a run: what the camera follows, where there is a ground, and that a closed cut is seen.
#include <gtest/gtest.h>

#include <algorithm>

#include "cutting/cut_scenes.h"
#include "render/picture.h"

namespace pliant {
namespace {

using namespace cut_test;

class RunPictures : public testing::Test {
 protected:
  void SetUp() override {
    if (!render::Renderer::available()) GTEST_SKIP() << render::Renderer::missing();
  }
};

render::PictureOptions small() {
  render::PictureOptions options;
  options.width = 96;
  options.height = 72;
  options.samples = 4;
  options.threads = 1;
  return options;
}

Scene held_box() {
  Body body = box_body("box", {0.03, 0.02, 0.02});
  hold(body, {0.001, 0, 0}, {-1, 0, 0});
  return scene_with(body);
}

/// Share of the pixels for which `is` holds.
template <class F>
double share(const Image& image, const F& is) {
  int count = 0;
  for (std::size_t p = 0; p + 2 < image.rgb.size(); p += 3)
    count += is(image.rgb[p], image.rgb[p + 1], image.rgb[p + 2]) ? 1 : 0;
  return static_cast<double>(count) / (image.width * image.height);
}

double tissue(const Image& image) {
  return share(image, [](int r, int, int b) { return r > b + 30; });
}

TEST_F(RunPictures, FollowABodyThatFalls) {
  Scene scene = scene_with(box_body("box", {0.03, 0.02, 0.02}));
  scene.gravity = {0, -9.81, 0};
  Simulation s(scene, open_backend("cpu"));
  render::Pictures pictures(small());
  const double first = tissue(pictures.draw(s));
  EXPECT_GT(first, 0.1);
  Image fallen;
  for (const double time : {0.05, 0.1, 0.2, 0.4}) {
    while (s.time() < time) s.advance(64);
    fallen = pictures.draw(s);
    EXPECT_GT(tissue(fallen), 0.02) << "at " << time << " s";
  }
  EXPECT_NEAR(tissue(fallen), first, 0.3 * first) << "it is all there is, and as large as at first";
}

TEST_F(RunPictures, KeepThePlaceWhenAPieceFallsForEver) {
  Scene scene = held_box();
  scene.gravity = {0, -9.81, 0};
  Simulation s(scene, open_backend("cpu"));
  render::Pictures pictures(small());
  const double first = tissue(pictures.draw(s));
  ASSERT_TRUE(s.cut(wall(0.016)).changed);
  while (s.time() < 0.5) {
    s.advance(256);
    (void)pictures.draw(s);
  }
  EXPECT_GT(tissue(pictures.draw(s)), 0.05 * first) << "the part that is held";
}

TEST_F(RunPictures, ShowACutThatHasNotOpened) {
  Scene scene = held_box();
  Simulation s(scene, open_backend("cpu"));
  render::Pictures pictures(small());
  const Image before = pictures.draw(s);
  ASSERT_TRUE(s.cut(wall(0.016)).changed);
  const Image after = pictures.draw(s);
  int darker = 0;
  for (std::size_t p = 0; p < before.rgb.size(); p += 3) darker += after.rgb[p] + 20 < before.rgb[p] ? 1 : 0;
  EXPECT_GT(darker, 12) << "pixels of a line over the body, which is some 40 pixels high";
  EXPECT_LT(darker, 300);
}

TEST_F(RunPictures, HaveAGroundUnlessTheSceneSaysNo) {
  Scene scene = scene_with(box_body("box", {0.03, 0.02, 0.02}));
  Simulation with(scene, open_backend("cpu"));
  scene.view.ground = false;
  Simulation without(scene, open_backend("cpu"));
  const Image a = render::Pictures(small()).draw(with), b = render::Pictures(small()).draw(without);
  EXPECT_NE(a.rgb, b.rgb);
  EXPECT_NEAR(tissue(a), tissue(b), 0.05);
}

}  // namespace
}  // namespace pliant
