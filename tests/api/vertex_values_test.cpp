// Values per vertex for colouring: fields of elements, contact pressure, and what moves a vertex.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "c_world.h"
#include "geometry/vec.h"
#include "scenes.h"

namespace pliant {
namespace {

using test::code_of;
using test::message_of;
using test::on;

/// A box whose triangles are split into four `times` times.
SurfaceSpec fine_box(const Vec3d& lower, const Vec3d& upper, int times) {
  SurfaceSpec mesh = box_surface(lower, upper);
  for (int n = 0; n < times; ++n) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [at, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(mesh.vertices.size()));
      if (fresh)
        mesh.vertices.push_back(
            vec::mul(vec::add(mesh.vertices[static_cast<std::size_t>(a)], mesh.vertices[static_cast<std::size_t>(b)]), 0.5));
      return at->second;
    };
    std::vector<std::array<std::int32_t, 3>> split;
    for (const auto& t : mesh.triangles) {
      const std::int32_t a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      split.insert(split.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
    }
    mesh.triangles = std::move(split);
  }
  return mesh;
}

/// A block of 40 mm without lateral strain, held at z = 0, in cells of 5 mm.
SceneSpec flat_block() {
  SceneSpec scene;
  BodySpec& body = scene.bodies.emplace_back();
  body.name = "block";
  body.surface = fine_box({0, 0, 0}, {0.04, 0.04, 0.04}, 4);
  body.lattice_spacing = 0.005;
  body.material.young = 1e4;
  body.material.poisson = 0;
  body.material.damping = 200;
  body.fixed = {{RegionSpec::box({-1, -1, -0.001}, {1, 1, 0.001}), "xyz"}};
  return scene;
}

/// Integral over the vertices' deformed areas.
double integral(const Frame& frame, const std::vector<float>& values) {
  double sum = 0;
  for (const auto& t : frame.triangles) {
    const auto at = [&](std::size_t k) {
      const Vec4f& x = frame.positions[static_cast<std::size_t>(t[k])];
      return Vec3d{x[0], x[1], x[2]};
    };
    const double area = 0.5 * vec::norm(vec::cross(vec::sub(at(1), at(0)), vec::sub(at(2), at(0))));
    for (const std::int32_t v : t) sum += area / 3 * values[static_cast<std::size_t>(v)];
  }
  return sum;
}

TEST(VertexValues, PressureUnderAPlateIsUniform) {
  SceneSpec scene = flat_block();
  ToolSpec plate;
  plate.name = "plate";
  plate.shape = "half_space";
  plate.first = {0, 0, 0};
  plate.second = {0, 0, -1};
  plate.path = {{0, 0, 0, 0.0401, 0, 0, 0, 1}, {0.1, 0, 0, 0.039, 0, 0, 0, 1}};
  scene.tools = {plate};
  for (const std::string& backend : test::float_backends()) {
    World world(scene, on(backend));
    for (const float p : world.vertex_values("pressure")) ASSERT_EQ(p, 0);
    world.advance(0.6);
    const FramePtr frame = world.frame();
    const std::vector<float> pressure = world.vertex_values("pressure");
    const double force = world.tool_forces()[0].force[2], mean = force / (0.04 * 0.04);
    ASSERT_GT(mean, 100);
    int top = 0;
    for (std::size_t v = 0; v < pressure.size(); ++v) {
      const Vec4f& x = frame->positions[v];
      if (x[2] > 0.0389F && x[0] > 0.011F && x[0] < 0.029F && x[1] > 0.011F && x[1] < 0.029F) {
        EXPECT_NEAR(pressure[v], mean, 0.03 * mean) << x[0] << ' ' << x[1];
        ++top;
      } else if (x[2] < 0.03F) {
        EXPECT_EQ(pressure[v], 0);
      }
    }
    EXPECT_GT(top, 30);
    EXPECT_NEAR(integral(*frame, pressure), force, 0.15 * force);  // also on the sides, next to the edges
    // At rest the same stress is in the tissue below: sigma = -E (1 - stretch) nearly.
    const std::vector<float> mises = world.vertex_values("mises");
    const auto most = *std::max_element(mises.begin(), mises.end());
    EXPECT_NEAR(most, mean, 0.1 * mean);
  }
}

TEST(VertexValues, PressureBetweenBodiesCarriesTheWeight) {
  SceneSpec scene = flat_block();
  scene.gravity = {0, 0, -9.81};
  BodySpec upper = scene.bodies[0];
  upper.name = "upper";
  upper.fixed.clear();
  upper.surface = fine_box({0, 0, 0.0401}, {0.04, 0.04, 0.0801}, 4);
  scene.bodies.push_back(upper);
  scene.contact = ContactSpec{};
  World world(scene, on("cpu"));
  world.advance(1);
  const FramePtr frame = world.frame();
  const std::vector<float> pressure = world.vertex_values("pressure");
  const double mean = 0.04 * 1000 * 9.81;
  double sum[2] = {0, 0};
  int count[2] = {0, 0};
  for (std::size_t v = 0; v < pressure.size(); ++v) {
    const Vec4f& x = frame->positions[v];
    if (x[0] < 0.006F || x[0] > 0.034F || x[1] < 0.006F || x[1] > 0.034F) continue;
    const std::size_t body = v < pressure.size() / 2 ? 0 : 1;
    if (pressure[v] == 0) continue;
    sum[body] += pressure[v];
    ++count[body];
  }
  for (std::size_t body : {0U, 1U}) {
    ASSERT_GT(count[body], 50);
    EXPECT_NEAR(sum[body] / count[body], mean, 0.05 * mean) << body;
  }
}

TEST(VertexValues, OtherFieldsAndErrors) {
  SceneSpec scene = flat_block();
  scene.bodies[0].forces.push_back({RegionSpec::box({-1, -1, 0.039}, {1, 1, 0.041}), {0, 0, 0.5}, {"smooth", 0, 0.1, {}}});
  World world(scene, on("cpu"));
  const FramePtr before = world.frame();
  world.advance(0.4);
  const FramePtr after = world.frame();
  const std::vector<float> displacement = world.vertex_values("displacement");
  ASSERT_EQ(displacement.size(), after->positions.size());
  for (std::size_t v = 0; v < displacement.size(); v += 17) {
    const Vec4f &a = before->positions[v], &b = after->positions[v];
    EXPECT_NEAR(displacement[v], std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]), 1e-7);
  }
  for (const char* field : {"energy", "mises", "green_strain", "almansi_strain"}) {
    const std::vector<float> values = world.vertex_values(field);
    EXPECT_GT(*std::max_element(values.begin(), values.end()), 0) << field;
  }
  for (const float share : world.vertex_values("finite_elements")) EXPECT_NEAR(share, 1, 1e-6);
  EXPECT_EQ(code_of([&] { (void)world.vertex_values("stress"); }), ErrorCode::usage);
  EXPECT_NE(message_of([&] { (void)world.vertex_values("stress"); }).find("expected \"displacement\""), std::string::npos);
}

TEST(VertexValues, InC) {
  const test::CCube world;
  std::size_t needed = 0;
  ASSERT_EQ(pliant_world_vertex_values(world, "mises", nullptr, 0, &needed), PLIANT_OK);
  EXPECT_EQ(needed, 8U);
  float values[9] = {7, 7, 7, 7, 7, 7, 7, 7, 7};
  ASSERT_EQ(pliant_world_vertex_values(world, "displacement", values, 9, nullptr), PLIANT_OK);
  for (int v = 0; v < 8; ++v) EXPECT_EQ(values[v], 0);
  EXPECT_EQ(values[8], 7);
  EXPECT_EQ(pliant_world_vertex_values(world, "model", values, 8, nullptr), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_vertex_values(world, nullptr, values, 8, nullptr), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_vertex_values(world, "mises", nullptr, 8, nullptr), PLIANT_USAGE);
}

}  // namespace
}  // namespace pliant
