// Number of pieces of a body.
#pragma once
#include <cstdint>
#include <vector>

#include "model/model.h"

namespace pliant {

/// Returns the number of sets of elements that share nodes; there are several after cuts or tears, or if the body consists of
/// several parts. `piece` (may be null): [elements], the index of each element's set, in order of first occurrence.
[[nodiscard]] std::int64_t pieces_of(const ModelBody& body, std::vector<std::int32_t>* piece = nullptr);

/// [Model::slots] the index of the set of the elements at each slot; -1: it has none.
[[nodiscard]] std::vector<std::int32_t> pieces_of_slots(const ModelBody& body, std::int32_t slots);

}  // namespace pliant
