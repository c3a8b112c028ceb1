// Which triangles of a deformed surface are near: as if all were looked at.
#include "simulation/edits/present_surface.h"

#include <random>

#include "model/surfaces.h"
#include "physics/harness.h"
#include "support/source_dir.h"

namespace pliant::physics {
namespace {

using Found = std::vector<std::pair<std::size_t, std::array<Vec3d, 3>>>;

/// A smooth displacement of many cells: turned by half a radian, stretched, moved.
std::vector<double> deformed(const Model& model) {
  std::vector<double> u(4 * static_cast<std::size_t>(model.slots));
  const Eigen::Matrix3d turned = Eigen::AngleAxisd(0.5, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (const ModelBody& body : model.bodies) {
    for (std::size_t n = 0; n < body.slot.size(); ++n) {
      const Vector3d x = eigen(body.rest[n]);
      Vector3d to = turned * x + Vector3d(0.4, -0.2, 0.1);
      to[1] *= 1 + x[0];
      for (int c = 0; c < 3; ++c) u[4 * static_cast<std::size_t>(body.slot[n]) + static_cast<std::size_t>(c)] = to[c] - x[c];
    }
  }
  return u;
}

Found one_by_one(const Model& model, const std::vector<double>& u, const vec::Box& near) {
  const ModelSurface& s = model.surface;
  Found found;
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    std::array<Vec3d, 3> now;
    vec::Box box;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(s.triangles[t][k]);
      now[k] = s.rest[v];
      for (std::size_t a = 0; a < 8; ++a) {
        for (std::size_t c = 0; c < 3; ++c) now[k][c] += s.weights[v][a] * u[4 * static_cast<std::size_t>(s.nodes[v][a]) + c];
      }
      box.extend(now[k]);
    }
    if (box.overlaps(near)) found.emplace_back(t, now);
  }
  return found;
}

TEST(PresentSurface, FindsWhatIsNear) {
  const auto sim = simulate(load_scene(test::source_dir() + "/scenes/liver_on_table.json"), "cpu");
  const Model& model = sim->model();
  const std::vector<double> u = deformed(model);
  PresentSurface surface(model, u);
  std::mt19937 random(7);
  std::size_t all = 0, most = 0;
  for (int n = 0; n < 60; ++n) {
    vec::Box near;
    const Vec3d at = test::random_point(random, {0.25, -0.4, -0.05}, {0.55, 0.05, 0.25});
    near.extend(at);
    near.extend(vec::add(at, test::random_point(random, {0, 0, 0}, {0.03, 0.03, 0.03})));
    const Found expected = one_by_one(model, u, near);
    Found found;
    surface.within(near, [&](std::size_t t, const std::array<Vec3d, 3>& now, const vec::Box&) { found.emplace_back(t, now); });
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].first, expected[i].first);
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_LT(vec::norm(vec::sub(found[i].second[k], expected[i].second[k])), 1e-15) << found[i].first;
    }
    all += found.size();
    most = std::max(most, found.size());
  }
  EXPECT_GT(all, 500U);
  EXPECT_LT(most, model.surface.triangles.size() / 4);
}

}  // namespace
}  // namespace pliant::physics
