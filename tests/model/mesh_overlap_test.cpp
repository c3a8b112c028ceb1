#include "geometry/mesh_overlap.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>

#include "geometry/vec.h"
#include "scenes/generate/organs.h"
#include "surfaces.h"

namespace pliant::mesh_overlap_test {

using Wide = long double;
using WidePoint = std::array<Wide, 3>;
using Faces = std::vector<std::vector<WidePoint>>;  ///< of a convex polyhedron, polygons that are outward

WidePoint minus(const WidePoint& a, const WidePoint& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
WidePoint cross(const WidePoint& a, const WidePoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Wide dot(const WidePoint& a, const WidePoint& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Faces faces_of(const TriangleMesh& mesh) {
  Faces faces;
  for (const auto& t : mesh.triangles) {
    faces.emplace_back();
    for (const std::int32_t v : t) {
      const Vec3d& p = mesh.vertices[static_cast<std::size_t>(v)];
      faces.back().push_back({p[0], p[1], p[2]});
    }
  }
  return faces;
}

/// The parts of polygons behind a plane.
Faces behind(const Faces& faces, const WidePoint& on, const WidePoint& normal) {
  Faces kept;
  for (const auto& face : faces) {
    std::vector<WidePoint> part;
    for (std::size_t i = 0; i < face.size(); ++i) {
      const WidePoint &a = face[i], &b = face[(i + 1) % face.size()];
      const Wide sa = -dot(minus(a, on), normal), sb = -dot(minus(b, on), normal);
      if (sa >= 0) part.push_back(a);
      if ((sa >= 0) == (sb >= 0)) continue;
      const Wide t = sa / (sa - sb);
      part.push_back({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])});
    }
    if (part.size() > 2) kept.push_back(part);
  }
  return kept;
}

/// The surface of one convex polyhedron inside another one: its faces, cut by the planes of the other.
Faces inside(const TriangleMesh& mesh, const TriangleMesh& other) {
  Faces faces = faces_of(mesh);
  for (const auto& plane : faces_of(other)) {
    faces = behind(faces, plane[0], cross(minus(plane[1], plane[0]), minus(plane[2], plane[0])));
  }
  return faces;
}

struct Measures {
  Wide volume = 0, area = 0;
  WidePoint moment{};
};

Measures measures(const Faces& faces) {
  Measures m;
  for (const auto& face : faces) {
    for (std::size_t k = 2; k < face.size(); ++k) {
      const WidePoint &a = face[0], &b = face[k - 1], &c = face[k], n = cross(minus(b, a), minus(c, a));
      const Wide volume = dot(a, cross(b, c)) / 6;
      m.volume += volume;
      m.area += std::sqrt(dot(n, n)) / 2;
      for (std::size_t i = 0; i < 3; ++i) m.moment[i] += volume * (a[i] + b[i] + c[i]) / 4;
    }
  }
  return m;
}

/// A subdivided octahedron on the unit sphere.
TriangleMesh ball(int times) {
  TriangleMesh mesh{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                    {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  for (int n = 0; n < times; ++n) {
    std::map<std::array<std::int32_t, 2>, std::int32_t> middles;
    std::vector<std::array<std::int32_t, 3>> finer;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [at, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)}, mesh.vertices.size());
      if (is_new) {
        const Vec3d m = vec::add(mesh.vertices[static_cast<std::size_t>(a)], mesh.vertices[static_cast<std::size_t>(b)]);
        mesh.vertices.push_back(vec::mul(m, 1 / vec::norm(m)));
      }
      return at->second;
    };
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const std::array<std::int32_t, 3>& t : {std::array{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}}) {
        finer.push_back(t);
      }
    }
    mesh.triangles = finer;
  }
  return mesh;
}

/// An affine image with a positive determinant: columns and shift at random.
TriangleMesh stretched(TriangleMesh mesh, std::mt19937& random) {
  std::array<Vec3d, 3> column{};
  double volume = 0;
  while (volume < 0.05) {
    for (Vec3d& c : column) c = test::random_point(random, {-1, -1, -1}, {1, 1, 1});
    volume = vec::dot(column[0], vec::cross(column[1], column[2]));
  }
  const Vec3d shift = test::random_point(random, {-1, -1, -1}, {1, 1, 1});
  for (Vec3d& v : mesh.vertices) {
    const Vec3d x = v;
    v = shift;
    for (std::size_t a = 0; a < 3; ++a) v = vec::add(v, vec::mul(column[a], x[a]));
  }
  return mesh;
}

/// Turned about a skew axis and moved.
TriangleMesh moved(TriangleMesh mesh) {
  const Vec3d axis = vec::mul({1, 2, -2}, 1.0 / 3);
  const double c = std::cos(0.7), s = std::sin(0.7);
  for (Vec3d& v : mesh.vertices) {
    const Vec3d along = vec::mul(axis, vec::dot(axis, v)), out = vec::sub(v, along);
    v = vec::add(vec::add(along, vec::mul(out, c)), vec::add(vec::mul(vec::cross(axis, v), s), {3, -5, 7}));
  }
  return mesh;
}

TriangleMesh shifted(TriangleMesh mesh, const Vec3d& by) {
  for (Vec3d& v : mesh.vertices) v = vec::add(v, by);
  return mesh;
}

void expect_box(const TriangleMesh& a, const TriangleMesh& b, const Vec3d& low, const Vec3d& high,
                const std::array<double, 2>& area) {
  const MeshOverlap o = mesh_overlap(a, b);
  const Vec3d size = vec::sub(high, low);
  EXPECT_NEAR(o.volume, size[0] * size[1] * size[2], 1e-14);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(o.centroid[c], 0.5 * (low[c] + high[c]), 1e-14);
  for (std::size_t m = 0; m < 2; ++m) EXPECT_NEAR(o.area[m], area[m], 1e-13);
}

TEST(MeshOverlap, BoxesInClosedForm) {
  const TriangleMesh a = test::box({0, 0, 0}, {1, 2, 3});
  expect_box(a, test::box({0.9, 1.8, 2.7}, {4, 5, 6}), {0.9, 1.8, 2.7}, {1, 2, 3}, {0.11, 0.11});
  expect_box(a, test::box({0.25, 0.5, 0.75}, {0.5, 1, 1.5}), {0.25, 0.5, 0.75}, {0.5, 1, 1.5}, {0, 1.375});
  expect_box(a, test::box({0.25, 0.5, -1}, {0.5, 1, 4}), {0.25, 0.5, 0}, {0.5, 1, 3}, {0.25, 4.5});
  // Faces in one plane: what lies in the other's surface counts half.
  expect_box(a, test::box({0.5, 0, 0}, {1.5, 2, 3}), {0.5, 0, 0}, {1, 2, 3}, {8.5, 8.5});
  expect_box(a, a, {0, 0, 0}, {1, 2, 3}, {11, 11});
  const TriangleMesh cube = test::box({0, 0, 0}, {1, 1, 1});
  for (std::size_t axis = 0; axis < 3; ++axis) {  // one face of a smaller box in one of a larger one, on either side
    for (const double low : {0.0, 0.5}) {
      Vec3d lower{0.25, 0.25, 0.25}, upper{0.75, 0.75, 0.75};
      lower[axis] = low, upper[axis] = low + 0.5;
      expect_box(cube, test::box(lower, upper), lower, upper, {0.125, 1.375});
    }
  }
  for (const Vec3d& away : {Vec3d{1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {1, 2, 3}, {9, 0, 0}}) {
    EXPECT_EQ(mesh_overlap(a, shifted(a, away)).volume, 0) << away[0] << away[1] << away[2];
  }
  EXPECT_NEAR(mesh_overlap(a, test::box({0.9, 1.8, 2.7}, {4, 5, 6})).depth, 0.1, 1e-14);
  EXPECT_EQ(mesh_overlap(a, test::box({0.9, 1.8, 2.7}, {4, 5, 6})).deepest, (Vec3d{1, 2, 3}));
  EXPECT_NEAR(mesh_overlap(a, test::box({0.25, 0.5, 0.75}, {0.4, 1, 1.5})).depth, 0.4, 1e-14);
  EXPECT_EQ(mesh_overlap(a, test::box({0.25, 0.5, -1}, {0.5, 1, 4})).depth, 0) << "no vertex of either is in the other";
}

TEST(MeshOverlap, ConvexPolyhedraExactly) {
  const TriangleMesh tet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  std::mt19937 random(7);
  int met = 0;
  double worst = 0;
  for (int n = 0; met < 1000; ++n) {
    const TriangleMesh a = stretched(n % 3 == 0 ? ball(1) : tet, random), b = stretched(n % 2 == 0 ? ball(0) : tet, random);
    const Faces of_a = inside(a, b), of_b = inside(b, a);
    Faces both = of_a;
    both.insert(both.end(), of_b.begin(), of_b.end());
    const Measures exact = measures(both);
    const MeshOverlap o = mesh_overlap(a, b);
    const auto volume = static_cast<double>(exact.volume);
    ASSERT_NEAR(o.volume, volume, 1e-6 * volume + 1e-15) << n;
    ASSERT_NEAR(o.area[0], static_cast<double>(measures(of_a).area), 1e-6 * o.area[0] + 1e-13) << n;
    ASSERT_NEAR(o.area[1], static_cast<double>(measures(of_b).area), 1e-6 * o.area[1] + 1e-13) << n;
    if (volume < 1e-9) continue;
    ++met;
    worst = std::max(worst, std::abs(o.volume / volume - 1));
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_NEAR(o.centroid[c], static_cast<double>(exact.moment[c] / exact.volume), 1e-6) << n;
    }
  }
  EXPECT_LT(worst, 1e-9);
  RecordProperty("worst", fmt::format("{:.3g}", worst));
}

/// Two unit spheres a distance d apart: two caps of height h = 1 - d / 2.
TEST(MeshOverlap, LensOfTwoSpheres) {
  const double d = 1.3, h = 1 - d / 2, volume = 2 * std::numbers::pi * h * h * (3 - h) / 3, area = 2 * std::numbers::pi * h;
  double last = 0;
  for (int times = 3; times <= 6; ++times) {
    const TriangleMesh sphere = moved(ball(times));
    const MeshOverlap o = mesh_overlap(sphere, shifted(sphere, {0.3 * d, -0.4 * d, std::sqrt(0.75) * d}));
    const double error = 1 - o.volume / volume;
    EXPECT_GT(error, 0) << "polyhedra are inside the spheres";
    if (last > 0) {
      EXPECT_NEAR(last / error, 4, 0.15) << times;
    }
    last = error;
    for (std::size_t m = 0; m < 2; ++m) EXPECT_NEAR(o.area[m], area, 3 * error * area);
    EXPECT_NEAR(o.centroid[0], 3 + 0.15 * d, 1e-3);
    EXPECT_NEAR(o.centroid[1], -5 - 0.2 * d, 1e-3);
    EXPECT_NEAR(o.depth, 2 * h, 0.7 / (1 << times)) << "a vertex is no further than an edge from the deepest point";
  }
  EXPECT_LT(last, 2e-3);
}

/// What a shape of no particular symmetry has in two halves of space, it has in all.
TEST(MeshOverlap, PartsOfALiver) {
  const TriangleMesh liver = make_shape("liver");
  const double whole = signed_volume(liver);
  vec::Box box;
  for (const Vec3d& v : liver.vertices) box.extend(v);
  const Vec3d size = vec::sub(box.upper, box.lower), far = vec::add(box.upper, size), low = vec::sub(box.lower, size);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Vec3d end = far, begin = low;
    end[axis] = begin[axis] = box.lower[axis] + 0.37 * size[axis];
    const MeshOverlap one = mesh_overlap(liver, test::box(low, end)), other = mesh_overlap(test::box(begin, far), liver);
    EXPECT_NEAR((one.volume + other.volume) / whole, 1, 1e-12) << axis;
    EXPECT_NEAR(one.area[1] / other.area[0], 1, 1e-9) << "the section, once from either side";
    EXPECT_GT(one.volume, 0.05 * whole);
  }
  EXPECT_NEAR(mesh_overlap(liver, liver).volume / whole, 1, 1e-12);
  const TriangleMesh inner = [&] {
    TriangleMesh m = liver;
    for (Vec3d& v : m.vertices)
      v = vec::add(vec::mul(vec::sub(v, liver.vertices[0]), 1e-3), vec::mul(vec::add(box.lower, box.upper), 0.5));
    return m;
  }();
  const MeshOverlap o = mesh_overlap(liver, inner);
  EXPECT_NEAR(o.volume / (1e-9 * whole), 1, 1e-9) << "small, and wholly inside";
  EXPECT_EQ(o.area[0], 0);
}

TEST(MeshOverlap, MotionAndOrderDoNotMatter) {
  std::mt19937 random(11);
  for (int n = 0; n < 50; ++n) {
    const TriangleMesh a = stretched(ball(3), random), b = stretched(ball(2), random);
    const MeshOverlap o = mesh_overlap(a, b), turned = mesh_overlap(moved(a), moved(b)), swapped = mesh_overlap(b, a);
    EXPECT_NEAR(turned.volume, o.volume, 1e-12);
    EXPECT_NEAR(swapped.volume, o.volume, 1e-13);
    EXPECT_NEAR(turned.depth, o.depth, 1e-12);
    EXPECT_EQ(swapped.depth, o.depth);
    for (std::size_t m = 0; m < 2; ++m) {
      EXPECT_NEAR(turned.area[m], o.area[m], 1e-11);
      EXPECT_NEAR(swapped.area[1 - m], o.area[m], 1e-12);
    }
    if (o.volume < 1e-3) continue;
    const Vec3d centroid = moved(TriangleMesh{{o.centroid}, {}}).vertices[0];
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(turned.centroid[c], centroid[c], 1e-9);
  }
}

/// The columns of a mesh are summed with signs, so that a hole takes away what its outline would have.
TEST(MeshOverlap, CavitiesAndSeveralParts) {
  TriangleMesh shell = ball(3), hole = ball(2);
  for (Vec3d& v : hole.vertices) v = vec::mul(v, 0.5);
  for (auto& t : hole.triangles) std::swap(t[1], t[2]);
  test::append(shell, hole);
  const TriangleMesh slab = test::box({-2, -2, -2}, {2, 2, 0.3});
  TriangleMesh plain = hole;
  for (auto& t : plain.triangles) std::swap(t[1], t[2]);
  EXPECT_NEAR(mesh_overlap(shell, slab).volume, mesh_overlap(ball(3), slab).volume - mesh_overlap(plain, slab).volume, 1e-13);
  EXPECT_LT(mesh_overlap(shell, shifted(plain, {0, 0, 0.01})).depth, 0.02) << "in the cavity nothing is deep";
  TriangleMesh two = ball(3);
  test::append(two, shifted(ball(3), {5, 0, 0}));
  EXPECT_NEAR(mesh_overlap(two, test::box({-3, -2, 0}, {8, 2, 2})).volume, signed_volume(ball(3)), 1e-12);
}

/// Four times the triangles, four times the work; what is elsewhere costs nothing.
TEST(MeshOverlap, CostsWhatIsInCommon) {
  const Vec3d away{0.2, 0.1, 1.9};
  double last = 0;
  for (int times = 4; times <= 7; ++times) {
    const MeshOverlap o = mesh_overlap(ball(times), shifted(ball(times), away));
    const auto compared = static_cast<double>(o.compared), triangles = static_cast<double>(ball(times).triangles.size());
    EXPECT_GT(compared, 0);
    EXPECT_LT(compared, 1.2 * triangles) << "the caps have a twentieth of the triangles each";
    if (last > 0) {
      EXPECT_NEAR(compared / last, 4, 0.8) << times;
    }
    last = compared;
  }
  TriangleMesh more = ball(5);
  for (const Vec3d& to : {Vec3d{3, 0, 0}, {0, 3, -3}, {0, -3, 3}, {-3, 3, 0}}) test::append(more, shifted(ball(5), to));
  EXPECT_EQ(mesh_overlap(more, shifted(ball(5), away)).compared, mesh_overlap(ball(5), shifted(ball(5), away)).compared);
}

}  // namespace pliant::mesh_overlap_test
