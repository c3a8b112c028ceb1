// A model after an edit takes over what its elements keep of the model before, and is the same as one that is built anew.
#include "model/elements/kept_elements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cutting/cut_bodies.h"
#include "cutting/cut_scenes.h"
#include "cutting/mesh_files.h"
#include "elements/elements.h"
#include "solver/scenes.h"
#include "support/temp_folder.h"
#include "tearing/torn_body.h"

namespace pliant::kept_elements_test {
namespace {

using namespace cut_test;

/// A bar of 6 x 2 x 2 cells of 1 cm along x, soft at its beginning and of two materials.
struct KeptElementsOfABar : ::testing::Test {
  KeptElementsOfABar() {
    Body body;
    body.name = "bar";
    body.mesh = tet_box_file(folder, "bar.msh", 6, 2, 2);
    body.element = ElementKind::tet4;
    body.material.set_moduli(Law::neo_hookean, Moduli::from_young(3000, 0.4));
    Inclusion hard{{Selection::Kind::box, {0.04, -1, -1}, {0.05, 1, 1}, 0, {}, ""}, body.material};
    hard.material.set_moduli(Law::neo_hookean, Moduli::from_young(9000, 0.3));
    whole = std::make_shared<const BodyMesh>(make_body_mesh(body));
    YoungField field{"E", 0.4, std::vector<double>(whole->tets.size(), 3000), 3000};
    for (std::size_t t = 0; t < whole->tets.size() / 4; ++t) field.values[t] = 700;
    body.material.young_field = std::make_shared<const YoungField>(field);
    body.inclusions.push_back(hard);
    scene = scene_with(body);
  }
  [[nodiscard]] static Model model_of(const Scene& scene, const BodyMesh& solid, const Model* earlier = nullptr) {
    const BodyMesh* const all[]{&solid};
    return build_elements(scene, all, earlier);
  }
  /// The bar, parted at x = 3 cm.
  [[nodiscard]] BodyMesh parted() const {
    TornBody body(whole, std::vector<Material>(whole->tets.size()));
    std::vector<TetFace> faces;
    for (std::size_t t = 0; t < whole->tets.size(); ++t) {
      for (std::size_t f = 0; f < 4; ++f) {
        const auto& corners = kTetFaces[f];
        const bool there = std::all_of(corners.begin(), corners.end(), [&](int k) {
          return std::abs(whole->nodes[static_cast<std::size_t>(whole->tets[t][static_cast<std::size_t>(k)])][0] - 0.03) < 1e-9;
        });
        if (there) faces.push_back({static_cast<std::int32_t>(t), static_cast<std::int8_t>(f)});
      }
    }
    body.tear(faces);
    return body.solid();
  }

  test::TempFolder folder;
  std::shared_ptr<const BodyMesh> whole;
  Scene scene;
};

void expect_same(const Model& a, const Model& b) {
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_EQ(a.element_bound, b.element_bound);
  EXPECT_EQ(a.bound_element, b.bound_element);
  EXPECT_EQ(a.shortest, b.shortest);
  ASSERT_EQ(a.batches.size(), b.batches.size());
  for (std::size_t i = 0; i < a.batches.size(); ++i) {
    EXPECT_EQ(a.batches[i].nodes, b.batches[i].nodes);
    EXPECT_EQ(a.batches[i].records, b.batches[i].records);
    EXPECT_EQ(a.batches[i].frequency, b.batches[i].frequency);
    EXPECT_EQ(a.batches[i].share, b.batches[i].share);
    EXPECT_EQ(a.batches[i].id, b.batches[i].id);
  }
}

TEST_F(KeptElementsOfABar, KeepTheirNumbersWhereItParts) {
  const Model before = model_of(scene, *whole);
  const BodyMesh solid = parted();
  ASSERT_GT(solid.nodes.size(), whole->nodes.size());
  ASSERT_EQ(before.batches.size(), 2);
  std::size_t kept = 0;
  for (const ElementBatch& batch : before.batches) {
    const KeptElements found(&before, batch);
    for (std::size_t t = 0; t < solid.tets.size(); ++t) {
      std::array<Vec3d, 4> x;
      for (std::size_t a = 0; a < 4; ++a) x[a] = solid.nodes[static_cast<std::size_t>(solid.tets[t][a])];
      kept += found.find(t, x) ? 1 : 0;
    }
  }
  EXPECT_EQ(kept, solid.tets.size());
  expect_same(model_of(scene, solid, &before), model_of(scene, solid));
}

TEST_F(KeptElementsOfABar, HaveNewNumbersInAnotherMaterial) {
  const Model before = model_of(scene, *whole);
  scene.bodies[0].material.set_moduli(Law::neo_hookean, Moduli::from_young(40000, 0.4));
  const Model now = model_of(scene, *whole, &before);
  expect_same(now, model_of(scene, *whole));
  EXPECT_LT(now.element_bound, 0.6 * before.element_bound);
}

TEST_F(KeptElementsOfABar, HaveNewNumbersInAnotherShape) {
  const Model before = model_of(scene, *whole);
  BodyMesh moved = *whole;
  moved.nodes[moved.nodes.size() / 2][0] += 0.002;
  const Model now = model_of(scene, moved, &before);
  expect_same(now, model_of(scene, moved));
  double least = std::numeric_limits<double>::infinity();
  for (const ElementBatch& batch : now.batches) {
    for (std::size_t e = 0; e < batch.size(); ++e)
      least = std::min(least, std::cbrt(element_volume(batch.kind, batch.record_of(e))));
  }
  EXPECT_EQ(now.shortest, least);
  EXPECT_LT(now.shortest, before.shortest);
}

}  // namespace
}  // namespace pliant::kept_elements_test
