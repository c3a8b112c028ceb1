// Into how many pieces a body has come apart.
#pragma once
#include <cstdint>
#include <vector>

#include "model/model.h"

namespace pliant {

/// Sets of elements that share nodes, by cuts, tears or because the body was made of several parts. `piece`, where it is
/// given: [elements], the number of each element's set, in the order in which they are met.
[[nodiscard]] std::int64_t pieces_of(const ModelBody& body, std::vector<std::int32_t>* piece = nullptr);

}  // namespace pliant
