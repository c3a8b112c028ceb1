// A block of about N elements, one end fixed, under gravity: the body of the kernel benchmark.
#pragma once
#include <cstdint>
#include <memory>

#include "model/model.h"

namespace pliant::bench {

struct Block {
  Scene scene;
  std::shared_ptr<const Model> model;
  std::int64_t counted = 0;  ///< elements, springs or triangles of a membrane: what its rows count
};

/// A cubic block of `elements` elements, within a few percent: lattice cells, or cells cut into six tetrahedra.
Block make_block(ElementKind element, Law law, std::int64_t elements);

/// A cubic block whose `springs` lie along the edges of tetrahedra, six in each cell of a grid.
Block make_network(std::int64_t springs);
/// A sheet of springs with a membrane of `triangles` on its surface.
Block make_membrane(std::int64_t triangles);

}  // namespace pliant::bench
