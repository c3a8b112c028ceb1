// A body on its way into the Model. Private to host/model.
#pragma once
#include <optional>
#include <vector>

#include "model/elements/body_mesh.h"

namespace pliant {

/// Everything about one body that is known before its list nodes have slots.
struct NodeNumbering {
  const BodyMesh* given = nullptr;
  std::optional<BodyElements> own;  ///< with a partition of its own
  [[nodiscard]] const BodyElements& solid() const { return own ? *own : *given; }
  ElementMaterials materials;
  std::vector<double> stiff;  ///< stiff_fills()
  std::vector<char> in_brick;
  std::vector<double> volume;  ///< [elements] of full ones [m^3]
  std::vector<std::int32_t> slot;
};

/// Slots for the nodes outside the bricks: body by body in Cuthill-McKee order, so that the nodes of one element stand as close
/// as the cross-section of the body allows (sweeping through the elements then finds them in the cache), and inside windows of
/// 256 nodes by the number of elements they touch, so that the rows of a tile's gather list are nearly full.
void number_list_nodes(std::vector<NodeNumbering>& drafts, Model& model);

}  // namespace pliant
