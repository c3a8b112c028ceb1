// A block of about N elements, one end fixed, under gravity: the body of the kernel benchmark.
#pragma once
#include <cstdint>
#include <memory>

#include "model/model.h"

namespace pliant::bench {

struct Block {
  Scene scene;
  std::shared_ptr<const Model> model;
};

/// A cubic block of `elements` elements, within a few percent: lattice cells, or cells cut into six tetrahedra.
Block make_block(ElementKind element, Law law, std::int64_t elements);

}  // namespace pliant::bench
