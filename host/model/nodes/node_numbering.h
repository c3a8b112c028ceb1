// Numbering of a body's nodes for the Model. Private to host/model.
#pragma once
#include <optional>
#include <vector>

#include "model/elements/body_mesh.h"

namespace pliant {

/// A body before its list nodes have slots.
struct NodeNumbering {
  const BodyMesh* given = nullptr;
  std::optional<BodyElements> own;  ///< with its own partition
  [[nodiscard]] const BodyElements& solid() const { return own ? *own : *given; }
  ElementMaterials materials;
  std::vector<double> stiff;  ///< stiff_fills()
  std::vector<char> in_brick;
  std::vector<double> volume;  ///< [elements] of full elements [m^3]
  std::vector<std::int32_t> slot;
};

/// Assigns slots to the nodes outside the bricks: body by body in Cuthill-McKee order, so that the nodes of an element are as
/// close as the body's cross-section allows and a sweep over the elements finds them in the cache; and within windows of 256
/// nodes sorted by number of elements, so that the rows of a tile's gather list are nearly full.
void number_list_nodes(std::vector<NodeNumbering>& drafts, Model& model);

}  // namespace pliant
