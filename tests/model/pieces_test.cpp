// Pieces: elements that share nodes, directly or through others.
#include "model/pieces.h"

#include <gtest/gtest.h>

namespace pliant {
namespace {

TEST(Pieces, AreSetsOfElementsThatShareNodes) {
  ModelBody body;
  body.rest.resize(14);
  EXPECT_EQ(pieces_of(body), 0);
  body.tets = {{4, 5, 6, 7}, {0, 1, 2, 3}, {7, 8, 9, 10}, {3, 11, 12, 13}};
  std::vector<std::int32_t> piece{9, 9};
  EXPECT_EQ(pieces_of(body, &piece), 2);
  EXPECT_EQ(piece, (std::vector<std::int32_t>{0, 1, 0, 1}));
  body.tets.push_back({0, 6, 1, 2});
  EXPECT_EQ(pieces_of(body), 1);
}

}  // namespace
}  // namespace pliant
