// What pictures are made of: normals, colours, ticks, fields, PNG files and animations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "io/gltf.h"
#include "io/png.h"
#include "read_png.h"
#include "render/annotations.h"
#include "render/color.h"
#include "render/export.h"
#include "render/font.h"
#include "shapes.h"
#include "simulation/measure/surface_fields.h"
#include "support/temp_folder.h"

namespace pliant::render {
namespace {

TEST(SmoothNormals, OfASpherePointOutward) {
  const TestSurface s = sphere(0.1F);
  const SmoothNormals smooth(s.positions, s.triangles);
  const auto normals = smooth.compute(s.positions, s.triangles);
  for (std::size_t n = 0; n < normals.size(); ++n) {
    const std::size_t v = 3 * static_cast<std::size_t>(smooth.vertex()[n]);
    const Vec3f out = unit({s.positions[v], s.positions[v + 1] - 0.1F, s.positions[v + 2]});
    ASSERT_GT(dot(normals[n], out), 0.998F) << n;
  }
}

TEST(SmoothNormals, KeepTheEdgesOfACubeAndTheRimOfACut) {
  const TestSurface s = cube(0.1F);
  EXPECT_EQ(SmoothNormals(s.positions, s.triangles).count(), 24U);
  const TestSurface round = sphere(0.1F);
  std::vector<std::uint8_t> kind(round.triangles.size() / 3, 0);
  const std::size_t whole = SmoothNormals(round.positions, round.triangles, kind).count();
  for (std::size_t t = kind.size() / 2; t < kind.size(); ++t) kind[t] = 1;
  EXPECT_GT(SmoothNormals(round.positions, round.triangles, kind).count(), whole + 50) << "the rim has two normals per vertex";
}

/// Lightness of OKLab, from linear sRGB.
double lightness(Vec3f c) {
  const double l = std::cbrt(0.4122214708 * c.x + 0.5363325363 * c.y + 0.0514459929 * c.z);
  const double m = std::cbrt(0.2119034982 * c.x + 0.6806995451 * c.y + 0.1073969566 * c.z);
  const double s = std::cbrt(0.0883024619 * c.x + 0.2817188376 * c.y + 0.6299787005 * c.z);
  return 0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s;
}

TEST(ColorMap, GrowsLighterInEqualSteps) {
  for (int i = 0; i <= 20; ++i) {
    const float t = static_cast<float>(i) / 20;
    EXPECT_NEAR(lightness(map_color(t)), 0.28 + 0.64 * t, 0.006) << t;
  }
  EXPECT_EQ(map_color(-3).x, map_color(0).x);
  EXPECT_EQ(map_color(7).x, map_color(1).x);
  EXPECT_EQ(map_color(NAN).x, map_color(NAN).y);
}

TEST(Ticks, HoldTheRangeInRoundSteps) {
  const Ticks t = nice_ticks(0, 37);
  EXPECT_EQ(t.low, 0);
  EXPECT_EQ(t.high, 40);
  EXPECT_EQ(t.at.size(), 5U);
  EXPECT_FALSE(std::signbit(t.at[0])) << "would be written as -0";
  for (const double high : {1e-9, 0.0234, 1.0, 7.3, 99.0, 1234567.0}) {
    const Ticks n = nice_ticks(0, high);
    EXPECT_GE(n.high, high * (1 - 1e-9));
    EXPECT_LE(n.high, high * 1.5);
    EXPECT_GE(n.at.size(), 4U) << high;
    EXPECT_LE(n.at.size(), 7U) << high;
  }
}

TEST(ScaledUnit, KeepsNumbersShort) {
  EXPECT_EQ(scaled_unit("m", 0.02).unit, "mm");
  EXPECT_EQ(scaled_unit("m", 0.02).factor, 1e3);
  EXPECT_EQ(scaled_unit("Pa", 12000).unit, "kPa");
  EXPECT_EQ(scaled_unit("J/m^3", 50).unit, "J/m^3");
}

TEST(Font, CapitalsStandOnTheLineAndHaveTheirHeight) {
  const Coverage h = cover('H', 10, 50, 20);
  EXPECT_EQ(h.top, 30);
  EXPECT_EQ(h.height, 20);
  EXPECT_GE(h.left, 10);
  EXPECT_LE(h.left + h.width, 10 + std::ceil(20 * advance('H', 0)));
  EXPECT_EQ(*std::max_element(h.share.begin(), h.share.end()), 255);
  EXPECT_TRUE(cover(' ', 0, 0, 20).share.empty());
  for (char c = '!'; c <= '~'; ++c) {
    const Coverage glyph = cover(c, 3.5F, 7.25F, 12);
    EXPECT_GT(std::count_if(glyph.share.begin(), glyph.share.end(), [](std::uint8_t s) { return s > 100; }), 2) << c;
  }
  EXPECT_TRUE(cover('\xc3', 0, 0, 20).share.empty()) << "not ASCII";
}

TEST(Font, TextIsAsWideAsItIsDrawn) {
  Image image{200, 40, std::vector<std::uint8_t>(3 * 200 * 40, 255)};
  const std::string text = "AV [J/m^3]";
  const float end = Pen(image, {0, 0, 0}).text(5, 30, 14, text);
  EXPECT_FLOAT_EQ(end, 5 + text_width(14, text));
  EXPECT_LT(text_width(14, "AV"), text_width(14, "A") + text_width(14, "V")) << "pairs that fit into each other come closer";
  EXPECT_FLOAT_EQ(text_width(14, "m^3]"), text_width(14, "m]") + 0.65F * text_width(14, "3")) << "only the number is small";
  int last = 0;
  for (int x = 0; x < 200; ++x) {
    for (int y = 0; y < 40; ++y) last = image.rgb[3 * (y * 200 + x)] < 128 ? x : last;
  }
  EXPECT_NEAR(last, end, 5);
}

TEST(ColorBar, DrawsItsRangeAtTheRight) {
  Image image{320, 240, std::vector<std::uint8_t>(3 * 320 * 240, 255)};
  draw_color_bar(image, {"von Mises stress", "kPa", nice_ticks(0, 5)});
  std::size_t left = 0, right = 0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) (x < 260 ? left : right) += image.rgb[3 * (y * 320 + x)] != 255;
  }
  EXPECT_EQ(left, 0U);
  EXPECT_GT(right, 1000U);
  // The bar runs from the map's end above to its start below.
  const auto at = [&](int y) {
    const std::uint8_t* p = image.rgb.data() + 3 * (y * 320 + 282);
    return std::array<int, 3>{p[0], p[1], p[2]};
  };
  const Vec3f top = srgb_of(map_color(1)), bottom = srgb_of(map_color(0));
  EXPECT_NEAR(at(60)[1], 255 * top.y, 12);
  EXPECT_NEAR(at(204)[1], 255 * bottom.y, 12);
}

TEST(Fields, OfUniaxialStrainAreTheClosedForms) {
  const Moduli m = Moduli::from_lame(2000, 1000);
  const double stretch = 1.2;
  const std::array<double, 9> f{stretch, 0, 0, 0, 1, 0, 0, 0, 1};
  // Cauchy stresses along and across; mises is their difference.
  Strain s = strain_of(f, make_material(Law::neo_hookean, m));
  EXPECT_NEAR(s.mises, m.mu * (stretch * stretch - 1) / stretch, 1e-9);
  EXPECT_NEAR(s.energy, m.mu / 2 * (stretch * stretch - 1) - m.mu * std::log(stretch) + m.lambda / 2 * 0.04, 1e-9);
  s = strain_of(f, make_material(Law::saint_venant_kirchhoff, m));
  // A strain along one axis has the equivalent strain 2/3 of it.
  const double e = (stretch * stretch - 1) / 2;
  EXPECT_NEAR(s.green, 2.0 / 3 * e, 1e-12);
  EXPECT_NEAR(s.almansi, 2.0 / 3 * e / (stretch * stretch), 1e-12);
  EXPECT_NEAR(s.mises, std::fabs((m.lambda + 2 * m.mu) * e * stretch - m.lambda * e / stretch), 1e-9);
  EXPECT_NEAR(s.energy, (m.lambda / 2 + m.mu) * e * e, 1e-9);
  s = strain_of(f, make_material(Law::isochoric_neo_hookean, m));
  EXPECT_NEAR(s.mises, m.mu * std::pow(stretch, -5.0 / 3) * (stretch * stretch - 1), 1e-9);
  EXPECT_EQ(strain_of({-1, 0, 0, 0, 1, 0, 0, 0, 1}, make_material(Law::isochoric_neo_hookean, m)).mises, 0);
  EXPECT_EQ(strain_of({-1, 0, 0, 0, 1, 0, 0, 0, 1}, make_material(Law::isochoric_neo_hookean, m)).almansi, 0)
      << "turned inside out";
}

TEST(Png, ComesBackAsItWas) {
  const test::TempFolder folder;
  Image image{7, 5, {}};
  for (int i = 0; i < 105; ++i) image.rgb.push_back(static_cast<std::uint8_t>(37 * i));
  write_png(folder.path() / "a.png", image);
  const Image back = test::read_png(folder.path() / "a.png");
  EXPECT_EQ(back.width, 7);
  EXPECT_EQ(back.height, 5);
  EXPECT_EQ(back.rgb, image.rgb);
  image.rgb.pop_back();
  EXPECT_NE(message_of([&] { write_png(folder.path() / "c.png", image); }).find("104 bytes for 7 x 5"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "c.png"));
}

TEST(Gltf, HoldsFramesAsMorphTargetsAndOneMeshPerTopology) {
  const test::TempFolder folder;
  SurfaceAnimation animation;
  FrameSplitter splitter;
  TestSurface s = cube(0.1F);
  std::vector<std::uint8_t> cut(12, 0);
  cut[3] = 1;
  for (int i = 0; i < 5; ++i) {
    Surface view = s.view();
    view.topology = i < 3 ? 0 : 1;
    if (i >= 3) view.cut = cut;
    animation.add(splitter.split(view, 0.1 * i));
    for (std::size_t v = 0; v < 8; ++v) s.positions[3 * v] += 0.01F;
  }
  write_glb(folder.path() / "a.glb", animation);
  std::ifstream in(folder.path() / "a.glb", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  std::uint32_t length = 0, text = 0;
  std::memcpy(&length, bytes.data() + 8, 4);
  std::memcpy(&text, bytes.data() + 12, 4);
  EXPECT_EQ(length, bytes.size());
  const auto json = nlohmann::json::parse(bytes.substr(20, text));
  ASSERT_EQ(json["meshes"].size(), 2U);
  EXPECT_EQ(json["meshes"][0]["primitives"].size(), 1U);
  EXPECT_EQ(json["meshes"][0]["primitives"][0]["targets"].size(), 2U);
  EXPECT_EQ(json["meshes"][1]["primitives"].size(), 2U) << "cut faces have a material of their own";
  EXPECT_EQ(json["animations"][0]["channels"].size(), 4U);
  // The last target of the first mesh is a shift by two hundredths.
  const auto& target = json["accessors"][json["meshes"][0]["primitives"][0]["targets"][1]["POSITION"].get<std::size_t>()];
  EXPECT_NEAR(target["min"][0].get<double>(), 0.02, 1e-6);
  EXPECT_NEAR(target["max"][0].get<double>(), 0.02, 1e-6);
  EXPECT_NE(message_of([&] { animation.add(splitter.split(s.view(), 0.1)); }).find("times must ascend"), std::string::npos);
}

TEST(Gltf, FieldsAndTexturesFollowSplitVertices) {
  TestSurface s = cube(0.1F);
  const std::vector<VertexArray> fields{{"mises", 1, {0, 1, 2, 3, 4, 5, 6, 7}}};
  std::vector<TextureCorners> texture(12);
  for (std::size_t t = 0; t < 12; ++t) {
    for (std::size_t k = 0; k < 3; ++k) texture[t][k] = {0.1F * static_cast<float>(t), 0.5F * static_cast<float>(k)};
  }
  FrameSplitter splitter;
  const SurfaceFrame frame = splitter.split(s.view(), 0, fields, texture);
  ASSERT_EQ(frame.texture.size() / 2, frame.positions.size() / 3);
  ASSERT_EQ(frame.fields[0].values.size(), frame.positions.size() / 3);
  for (std::size_t c = 0; c < 36; ++c) {
    const auto own = static_cast<std::size_t>(s.triangles[c]), split = static_cast<std::size_t>(frame.triangles[c]);
    EXPECT_EQ(frame.fields[0].values[split], static_cast<float>(own));
    EXPECT_EQ(frame.positions[3 * split], s.positions[3 * own]);
    EXPECT_EQ((std::array{frame.texture[2 * split], frame.texture[2 * split + 1]}), texture[c / 3][c % 3]);
  }
  const ObjCorners corners = obj_corners(s.view(), texture);
  EXPECT_EQ(corners.texture.size(), 36U) << "each once";
  SurfaceAnimation animation;
  animation.add(frame);
  const SurfaceFrame bare = splitter.split(s.view(), 1, {}, texture);
  EXPECT_NE(message_of([&] { animation.add(bare); }).find("the same fields"), std::string::npos);
}

}  // namespace
}  // namespace pliant::render
