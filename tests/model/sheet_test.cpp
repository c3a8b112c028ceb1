// Sheets: volumes in closed form, faces that agree, and surfaces that are refused.
#include "geometry/sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "geometry/vec.h"
#include "pliant/error.h"

namespace pliant {
namespace {

/// A grid over [0, n] x [0, n], mapped.
template <class Map>
TriangleMesh grid(int n, const Map& map) {
  TriangleMesh mesh;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) mesh.vertices.push_back(map(double(i), double(j)));
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const std::int32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
      if ((i + j) % 2 == 0) {
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
      } else {
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {b, c, d}});
      }
    }
  }
  return mesh;
}

TriangleMesh square() {
  return grid(4, [](double x, double y) { return Vec3d{x, y, 0}; });
}

/// Edges that are not used once in each direction.
int open_edges(const VolumeMesh& mesh) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> uses;
  for (const auto& t : boundary_triangles(mesh)) {
    for (std::size_t i = 0; i < 3; ++i) {
      ++uses[{t[i], t[(i + 1) % 3]}];
      --uses[{t[(i + 1) % 3], t[i]}];
    }
  }
  return static_cast<int>(std::count_if(uses.begin(), uses.end(), [](const auto& u) { return u.second != 0; }));
}

double volume(const VolumeMesh& mesh) { return signed_volume({mesh.vertices, boundary_triangles(mesh)}); }

std::string refusal(const TriangleMesh& mesh, double thickness) {
  try {
    static_cast<void>(thicken(mesh, thickness, "skin.obj"));
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    return error.what();
  }
  return "";
}

TEST(Sheet, ASquareHasItsAreaTimesTheThickness) {
  const VolumeMesh mesh = thicken(square(), 0.3, "");
  EXPECT_EQ(mesh.vertices.size(), 50U);
  EXPECT_EQ(mesh.tets.size(), 96U);
  EXPECT_NEAR(volume(mesh), 16 * 0.3, 1e-12);
  EXPECT_EQ(open_edges(mesh), 0) << "the prisms' faces agree";
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) EXPECT_DOUBLE_EQ(mesh.vertices[v][2], v % 2 == 0 ? -0.15 : 0.15);
}

TEST(Sheet, ACylinderIsAsThickEverywhere) {
  const double angle = std::numbers::pi / 40, thickness = 0.2;
  const TriangleMesh mesh = grid(20, [&](double x, double y) {
    return Vec3d{5 * std::cos(angle * x), 5 * std::sin(angle * x), y};
  });
  const VolumeMesh thick = thicken(mesh, thickness, "");
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    area += vec::norm(vec::cross(vec::sub(b, a), vec::sub(c, a))) / 2;
  }
  EXPECT_NEAR(volume(thick) / (area * thickness), 1, 2e-3);
  EXPECT_EQ(open_edges(thick), 0);
}

TEST(Sheet, TrianglesWoundAtRandomAreTurned) {
  TriangleMesh mesh = square();
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  EXPECT_NEAR(volume(thicken(mesh, 0.3, "")), 16 * 0.3, 1e-12);
}

TEST(Sheet, ThreeTrianglesAtAnEdgeAreRefused) {
  TriangleMesh mesh = square();
  mesh.vertices.push_back({0.5, 0.5, 1});
  mesh.triangles.push_back({0, 6, 25});
  EXPECT_EQ(refusal(mesh, 0.1),
            "skin.obj: 3 triangles meet at the edge from (0, 0, 0) to (1, 1, 0); a sheet has at most two at each edge");
}

TEST(Sheet, AOneSidedSurfaceIsRefused) {
  TriangleMesh band;
  const int n = 24;
  for (int i = 0; i < n; ++i) {
    const double turn = 2 * std::numbers::pi * i / n;
    for (const double s : {-0.5, 0.5}) {
      const double r = 3 + s * std::cos(turn / 2);
      band.vertices.push_back({r * std::cos(turn), r * std::sin(turn), s * std::sin(turn / 2)});
    }
  }
  for (int i = 0; i < n; ++i) {
    const bool last = i + 1 == n;
    const std::int32_t a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    band.triangles.insert(band.triangles.end(), {{a, b, c}, {b, d, c}});
  }
  EXPECT_EQ(refusal(band, 0.05), "skin.obj: the surface has only one side, and a sheet needs two");
}

TEST(Sheet, ABendThatIsTooSharpIsRefused) {
  const double angle = std::numbers::pi / 20;
  const TriangleMesh mesh = grid(20, [&](double x, double y) { return Vec3d{std::cos(angle * x), std::sin(angle * x), y}; });
  EXPECT_EQ(refusal(mesh, 0.5), "");
  const std::string message = refusal(mesh, 2.5);  // its inner side would be beyond the axis
  EXPECT_NE(message.find("the surface bends too sharply for a sheet of 2.5 m"), std::string::npos) << message;
}

}  // namespace
}  // namespace pliant
