// What other code asks the list of elements for, instead of naming one.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "elements/elements.h"

namespace pliant {
namespace {

TEST(ElementList, TheUsualElementsAreThoseOfScenesThatNameNone) {
  EXPECT_STREQ(to_string(usual_element(4)), "tet4");
  EXPECT_STREQ(to_string(usual_element(8)), "hex8");
}

TEST(ElementList, OneIsTheReferenceAndOneIsStoredInBricks) {
  int references = 0, bricks = 0;
  for (const ElementKind kind : all_elements()) {
    references += element_info(kind).reference;
    bricks += element_info(kind).brick != nullptr;
  }
  EXPECT_EQ(references, 1);
  EXPECT_EQ(bricks, 1);
  EXPECT_TRUE(element_info(reference_element()).statics) << "plan's references of scenes at rest are static solutions";
  EXPECT_EQ(brick_element(), usual_element(8));
}

TEST(ElementList, PlanTriesEachInItsPlace) {
  std::set<int> places;
  for (const ElementKind kind : all_elements()) places.insert(element_info(kind).trial);
  EXPECT_EQ(places.size(), element_count) << "two elements have the same place";
  EXPECT_EQ(*places.begin(), element_info(usual_element(8)).trial) << "hybrids are tried on what the first one needs";
}

TEST(ElementList, ACubeOfALatticeHasTheVolumeOfItsEdge) {
  const Material material = make_material(Law::neo_hookean, Moduli{1000, 3000});
  for (const ElementKind kind : all_elements()) {
    const std::vector<double> record = element_cube_record(kind, 0.5, material, "a cube");
    if (record.empty()) continue;  // divided into tetrahedra
    EXPECT_NEAR(element_volume(kind, record), 0.125, 1e-15) << to_string(kind);
  }
}

}  // namespace
}  // namespace pliant
