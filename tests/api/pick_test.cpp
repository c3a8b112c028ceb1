// Picking the surface by rays: against a search in long double, along edges and through vertices, and what a pick is used for.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <random>

#include "api/c_world.h"
#include "api/scenes.h"
#include "geometry/vec.h"
#include "support/source_dir.h"

namespace pliant::pick_test {
namespace {

using namespace test;
using Wide = std::array<long double, 3>;

Vec3d xyz(const Vec4f& p) { return {p[0], p[1], p[2]}; }
Vec3d between(const Vec3d& a, const Vec3d& b, double t) { return vec::add(vec::mul(a, 1 - t), vec::mul(b, t)); }
double distance(const Vec3d& a, const Vec3d& b) { return vec::norm(vec::sub(a, b)); }

/// What a ray meets by solving for the weights with determinants, triangle by triangle.
struct Reference {
  long double distance = std::numeric_limits<long double>::infinity();
  std::size_t triangle = 0;
  Wide weights{};
};

Wide wide_cross(const Wide& a, const Wide& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
long double wide_dot(const Wide& a, const Wide& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Reference reference(const Frame& frame, const Vec3d& origin, const Vec3d& direction) {
  const Wide d{direction[0], direction[1], direction[2]};
  const long double length = std::sqrt(wide_dot(d, d));
  Reference best;
  for (std::size_t i = 0; i < frame.triangles.size(); ++i) {
    std::array<Wide, 3> x;  // from the origin
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        x[k][c] = static_cast<long double>(frame.positions[frame.triangles[i][k]][c]) - static_cast<long double>(origin[c]);
      }
    }
    // Volumes of the tetrahedra that the origin and the direction make with the edges.
    Wide w{wide_dot(d, wide_cross(x[1], x[2])), wide_dot(d, wide_cross(x[2], x[0])), wide_dot(d, wide_cross(x[0], x[1]))};
    const long double sum = w[0] + w[1] + w[2];
    if (sum == 0) continue;
    for (long double& one : w) one /= sum;
    if (*std::min_element(w.begin(), w.end()) < 0) continue;
    Wide point{};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 3; ++c) point[c] += w[k] * x[k][c];
    }
    const long double at = wide_dot(point, d) / length;
    if (at > 0 && at < best.distance) best = {at, i, w};
  }
  return best;
}

/// Directions and points in a box that do not repeat.
class Random {
 public:
  double operator()(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  Vec3d in(const vec::Box& box) {
    return {(*this)(box.lower[0], box.upper[0]), (*this)(box.lower[1], box.upper[1]), (*this)(box.lower[2], box.upper[2])};
  }

 private:
  std::mt19937 random_{7};
};

vec::Box box_of(const Frame& frame) {
  vec::Box box;
  for (const Vec4f& p : frame.positions) box.extend(xyz(p));
  return box;
}

/// A box around it, twice as large.
vec::Box around(const vec::Box& box) {
  const Vec3d half = vec::mul(vec::sub(box.upper, box.lower), 0.5);
  return {vec::sub(box.lower, half), vec::add(box.upper, half)};
}

/// A liver under its weight, cut from above, its flap in motion.
World cut_liver() {
  World world = World::open(source_dir() + "/scenes/liver.json", on("cpu", true));
  world.advance(0.05);
  const vec::Box box = box_of(*world.frame());
  const Vec3d middle = between(box.lower, box.upper, 0.5);
  const Vec3d a{middle[0], middle[1], -1}, b{middle[0], middle[1], 1}, c{middle[0], 1, 1}, d{middle[0], 1, -1};
  EXPECT_TRUE(world.cut({{a, b, c}, {a, c, d}}).changed);
  world.advance(0.05);
  return world;
}

void expect_consistent(const Frame& frame, const PickedPoint& found, const Vec3d& origin, const Vec3d& direction) {
  const Triangle& t = frame.triangles[found.triangle];
  const double size = distance(origin, found.point);
  Vec3d mean{};
  for (std::size_t k = 0; k < 3; ++k) mean = vec::add(mean, vec::mul(xyz(frame.positions[t[k]]), found.weights[k]));
  EXPECT_LT(distance(mean, found.point), 1e-12);
  EXPECT_NEAR(found.weights[0] + found.weights[1] + found.weights[2], 1, 1e-12);
  EXPECT_GE(*std::min_element(found.weights.begin(), found.weights.end()), 0);
  EXPECT_NEAR(found.distance, size, 1e-9 * size);
  EXPECT_LT(distance(vec::add(origin, vec::mul(direction, found.distance / vec::norm(direction))), found.point), 1e-7 * size);
  for (const std::int32_t v : t) {
    EXPECT_LE(distance(xyz(frame.positions[found.vertex]), found.point), distance(xyz(frame.positions[v]), found.point));
  }
  EXPECT_TRUE(std::find(t.begin(), t.end(), found.vertex) != t.end());
  EXPECT_NEAR(vec::norm(found.normal), 1, 1e-12);
  const Vec3d a = xyz(frame.positions[t[0]]), e = vec::sub(xyz(frame.positions[t[1]]), a),
              f = vec::sub(xyz(frame.positions[t[2]]), a), normal = vec::cross(e, f);
  EXPECT_NEAR(vec::dot(found.normal, normal), vec::norm(normal), 1e-9 * vec::norm(normal));
  const IndexRange part = frame.body_triangles[found.body];
  EXPECT_TRUE(found.triangle >= part.first && found.triangle < part.first + part.count);
}

TEST(Pick, FindsWhatASearchInLongDoubleFinds) {
  World world = cut_liver();
  const FramePtr frame = world.frame();
  ASSERT_FALSE(frame->cut_faces.empty());
  const vec::Box box = box_of(*frame), wide = around(box);
  Random random;
  int met = 0, on_cut = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3d origin = random.in(wide);
    Vec3d direction = vec::sub(random.in(i % 3 == 0 ? wide : box), origin);
    if (i % 7 == 0) direction[static_cast<std::size_t>(i) % 3] = 0;
    direction = vec::mul(direction, std::pow(10, random(-3, 3)));
    const auto found = world.pick(origin, direction);
    const Reference expected = reference(*frame, origin, direction);
    ASSERT_EQ(found.has_value(), std::isfinite(expected.distance)) << i;
    if (!found) continue;
    ++met;
    ASSERT_NEAR(found->distance, static_cast<double>(expected.distance), 1e-9 * found->distance) << i;
    ASSERT_EQ(found->triangle, expected.triangle) << i;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found->weights[k], static_cast<double>(expected.weights[k]), 1e-6);
    expect_consistent(*frame, *found, origin, direction);
    on_cut += frame->cut_faces[found->triangle];
  }
  EXPECT_GT(met, 200);
  EXPECT_GT(on_cut, 2);
}

/// The triangles around each vertex.
std::vector<std::vector<std::size_t>> fans_of(const Frame& frame) {
  std::vector<std::vector<std::size_t>> fans(frame.positions.size());
  for (std::size_t i = 0; i < frame.triangles.size(); ++i) {
    for (const std::int32_t v : frame.triangles[i]) fans[static_cast<std::size_t>(v)].push_back(i);
  }
  return fans;
}

/// Whether these triangles all face a ray, or all face away from it: then they cover what lies around its way. Beside the
/// outline of a surface a ray may pass, however little its numbers are rounded.
bool face_alike(const Frame& frame, const std::vector<std::size_t>& triangles, const Vec3d& direction) {
  int facing = 0;
  for (const std::size_t i : triangles) {
    const Triangle& t = frame.triangles[i];
    const Vec3d a = xyz(frame.positions[t[0]]);
    const Vec3d normal = vec::cross(vec::sub(xyz(frame.positions[t[1]]), a), vec::sub(xyz(frame.positions[t[2]]), a));
    const double cosine = vec::dot(normal, direction) / (vec::norm(normal) * vec::norm(direction));
    if (std::abs(cosine) > 1e-6) facing += cosine > 0 ? 1 : -1;
  }
  return std::abs(facing) == static_cast<int>(triangles.size());
}

TEST(Pick, NothingSlipsThroughEdgesAndVertices) {
  World world = cut_liver();
  const FramePtr frame = world.frame();
  const std::vector<std::vector<std::size_t>> fans = fans_of(*frame);
  const vec::Box wide = around(box_of(*frame));
  Random random;
  int rays = 0;
  for (int eye = 0; eye < 4; ++eye) {
    const Vec3d origin = random.in(wide);
    for (std::size_t i = static_cast<std::size_t>(eye); i < frame->triangles.size(); i += 8) {
      const Triangle& t = frame->triangles[i];
      const Vec3d a = xyz(frame->positions[t[0]]), b = xyz(frame->positions[t[1]]);
      const auto &of_a = fans[static_cast<std::size_t>(t[0])], &of_b = fans[static_cast<std::size_t>(t[1])];
      std::vector<std::size_t> of_edge;
      std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::back_inserter(of_edge));
      for (const double share : {0.0, 0.5, random(0, 1)}) {
        const Vec3d target = between(a, b, share), direction = vec::sub(target, origin);
        if (!face_alike(*frame, share == 0 ? of_a : of_edge, direction)) continue;
        const auto found = world.pick(origin, direction);
        ASSERT_TRUE(found.has_value());
        ASSERT_LE(found->distance, distance(origin, target) + 1e-9) << "it is met, or something else before it";
        ++rays;
      }
    }
  }
  EXPECT_GT(rays, 10000);
}

/// Where arithmetic is exact: the edges of an upright box, the diagonals of its sides, and its corners.
TEST(Pick, MeetsTheEdgesOfABoxExactly) {
  SceneSpec scene = block(0);
  scene.bodies[0].surface = box_surface({0, 0, 0}, {0.125, 0.125, 0.125});
  World world(scene, on("cpu"));
  const FramePtr frame = world.frame();
  const vec::Box box = box_of(*frame);
  ASSERT_EQ(box.upper, (Vec3d{0.125, 0.125, 0.125}));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      for (int i = 0; i <= 16; ++i) {
        for (int j = 0; j <= 16; ++j) {  // the grid has the edges of the box and the diagonals of its sides
          Vec3d origin{}, direction{};
          origin[axis] = sign > 0 ? -1 : 1;
          origin[(axis + 1) % 3] = 0.125 * i / 16;
          origin[(axis + 2) % 3] = 0.125 * j / 16;
          direction[axis] = sign;
          const auto found = world.pick(origin, direction);
          ASSERT_TRUE(found.has_value()) << axis << " " << i << " " << j;
          const bool inner = i % 16 != 0 && j % 16 != 0;
          if (!inner) continue;  // a neighbouring side may be met as well, edge-on
          EXPECT_EQ(found->distance, sign > 0 ? 1 : 0.875);
          EXPECT_EQ(found->normal, vec::mul(direction, -1)) << "the normal is outward";
        }
      }
    }
  }
}

TEST(Pick, LooksAheadOnlyAndMeetsBothSides) {
  World world(block(0), on("cpu"));
  const FramePtr frame = world.frame();
  EXPECT_FALSE(world.pick({0.05, 1, 0.03}, {0, 1, 0}).has_value());
  EXPECT_FALSE(world.pick({0.05, 1, 0.03}, {1, 0, 0}).has_value());
  const auto above = world.pick({0.05, 1, 0.03}, {0, -2, 0}), inside = world.pick({0.05, 0.05, 0.03}, {0, 5e300, 0});
  ASSERT_TRUE(above && inside);
  EXPECT_NEAR(above->distance, 0.92, 1e-7);
  EXPECT_NEAR(inside->distance, 0.03, 1e-7) << "the face behind the origin is nearer to the eye, and not met";
  EXPECT_EQ(above->normal, (Vec3d{0, 1, 0}));
  EXPECT_EQ(inside->normal, (Vec3d{0, 1, 0})) << "from inside it is still the outward one";
}

TEST(Pick, NamesTheBodyThatIsMetFirst) {
  SceneSpec scene = block(0);
  scene.bodies.push_back(scene.bodies[0]);
  scene.bodies[1].name = "second";
  scene.bodies[1].translate = {0.5, 0, 0};
  scene.bodies[1].fixed = {{RegionSpec::plane({0, 0.001, 0}, {0, -1, 0})}};
  World world(scene, on("cpu"));
  const FramePtr frame = world.frame();
  const auto first = world.pick({-1, 0.04, 0.02}, {1, 0, 0}), second = world.pick({2, 0.04, 0.02}, {-1, 0, 0});
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->body, 0U);
  EXPECT_EQ(second->body, 1U);
  EXPECT_NEAR(first->point[0], 0, 1e-6);
  EXPECT_NEAR(second->point[0], 0.6, 1e-6);
  for (const auto& found : {first, second}) {
    const IndexRange part = frame->body_vertices[found->body];
    EXPECT_TRUE(found->vertex >= static_cast<std::int32_t>(part.first));
    EXPECT_TRUE(found->vertex < static_cast<std::int32_t>(part.first + part.count));
  }
}

/// A block that is cut: what is picked is what grab() takes, by the numbers of the frame that the user has.
TEST(Pick, AfterACutItsVertexIsTheOneThatGrabTakes) {
  SceneSpec scene = block(0);
  scene.gravity = {};
  scene.bodies[0].fixed = {{RegionSpec::plane({0.001, 0, 0}, {-1, 0, 0})}};
  World world(scene, on("cpu", true));
  const FramePtr before = world.frame();
  const Vec3d p{0.047, -1, -1}, q{0.047, 1, -1}, r{0.047, 1, 1}, s{0.047, -1, 1};
  ASSERT_TRUE(world.cut({{p, q, r}, {p, r, s}}).changed);
  ASSERT_TRUE(world.step_async(5));
  world.wait();  // there is a frame of the cut, and nobody has it
  const Vec3d origin{0.05, 1, 0.03}, down{0, -1, 0};
  const auto unseen = world.pick(origin, down);
  ASSERT_TRUE(unseen.has_value());
  EXPECT_LT(unseen->vertex, static_cast<std::int32_t>(before->positions.size())) << "by the numbers of the frame before";
  const FramePtr after = world.frame();
  const auto found = world.pick(origin, down);
  ASSERT_TRUE(found.has_value());
  EXPECT_GE(found->vertex, static_cast<std::int32_t>(before->positions.size())) << "a vertex of the cut is nearest";
  const GrabId grab = world.grab(found->vertex);
  const Vec3d target = vec::add(xyz(after->positions[found->vertex]), {0, 0.03, 0});
  world.move_grab(grab, target);
  world.advance(1.0);
  EXPECT_LT(distance(xyz(world.frame()->positions[found->vertex]), target), 0.01)
      << "the part that was cut off follows the hand";
}

TEST(Pick, DoesNotWaitAndLooksAtTheFrameHandedOutLast) {
  World world(block(0), on("cpu"));
  const Vec3d origin{0.05, 1, 0.03}, down{0, -1, 0};
  EXPECT_FALSE(world.pick(origin, down).has_value()) << "there was no frame";
  const FramePtr frame = world.frame_since(nullptr).frame;
  const auto first = world.pick(origin, down);
  ASSERT_TRUE(first.has_value());
  ASSERT_TRUE(world.step_async(1'000'000'000));
  const auto during = world.pick(origin, down);
  EXPECT_TRUE(world.busy()) << "it would have waited for hours";
  ASSERT_TRUE(during.has_value());
  EXPECT_EQ(during->distance, first->distance);
}

TEST(Pick, RaysThatAreNoneAreRefused) {
  World world(block(0), on("cpu"));
  (void)world.frame();
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  for (const Vec3d& wrong : {Vec3d{0, 0, 0}, Vec3d{0, -0.0, 0}, Vec3d{nan, 0, 1}, Vec3d{0, inf, 0}}) {
    EXPECT_EQ(code_of([&] { (void)world.pick({0, 0, 0}, wrong); }), ErrorCode::usage);
  }
  EXPECT_EQ(code_of([&] { (void)world.pick({nan, 0, 0}, {1, 0, 0}); }), ErrorCode::usage);
  EXPECT_EQ(
      message_of([&] {
        (void)world.pick({1, 2, 3}, {0, 0, 0});
      }),
      "pick: got a ray from [1, 2, 3] m in the direction [0, 0, 0]; allowed are finite numbers and a direction that is not "
      "zero");
  EXPECT_TRUE(world.pick({0.05, 1, 0.03}, {0, -1e-310, 0}).has_value()) << "as short as it may be";
}

TEST(PickInC, GivesWhatCppGives) {
  const CCube cube;
  const double origin[3]{0.01, 0.02, 1}, down[3]{0, 0, -2}, up[3]{0, 0, 1}, zero[3]{0, 0, 0};
  pliant_picked_point found = PLIANT_PICKED_POINT_INIT;
  int hit = -1;
  ASSERT_EQ(pliant_world_pick(cube, origin, down, &hit, &found), PLIANT_OK) << pliant_last_error();
  EXPECT_EQ(hit, 0) << "there was no frame";
  pliant_frame frame = PLIANT_FRAME_INIT;
  ASSERT_EQ(pliant_world_frame(cube, &frame), PLIANT_OK);
  ASSERT_EQ(pliant_world_pick(cube, origin, down, &hit, &found), PLIANT_OK) << pliant_last_error();
  EXPECT_EQ(hit, 1);
  EXPECT_EQ(found.body, 0U);
  EXPECT_NEAR(found.distance, 0.96, 1e-7);
  double mean[3]{0, 0, 0};
  const std::int32_t* const t = frame.triangles + 3 * found.triangle;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 3; ++c)
      mean[c] += found.weights[k] * static_cast<double>(frame.positions[4 * t[k] + static_cast<std::int32_t>(c)]);
  }
  const double expected[3]{0.01, 0.02, 0.04}, normal[3]{0, 0, 1};
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(found.point[c], expected[c], 1e-7);
    EXPECT_NEAR(mean[c], expected[c], 1e-7);
    EXPECT_EQ(found.normal[c], normal[c]);
  }
  EXPECT_TRUE(std::find(t, t + 3, found.vertex) != t + 3);
  EXPECT_EQ(frame.positions[4 * found.vertex], 0.0F) << "x of the nearest corner";
  found.triangle = 99;
  ASSERT_EQ(pliant_world_pick(cube, origin, up, &hit, &found), PLIANT_OK);
  EXPECT_EQ(hit, 0);
  EXPECT_EQ(found.triangle, 99U) << "nothing was written";
  EXPECT_EQ(pliant_world_pick(cube, origin, down, &hit, nullptr), PLIANT_OK);
  EXPECT_EQ(hit, 1);
  EXPECT_EQ(pliant_world_pick(cube, origin, zero, &hit, &found), PLIANT_USAGE);
  EXPECT_EQ(hit, 0);
  EXPECT_EQ(pliant_world_pick(cube, nullptr, down, &hit, &found), PLIANT_USAGE);
  EXPECT_EQ(pliant_world_pick(cube, origin, down, nullptr, &found), PLIANT_USAGE);
}

}  // namespace
}  // namespace pliant::pick_test
