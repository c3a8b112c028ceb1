// A part of a Model around a contact, as a Model of its own.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model/model.h"

namespace pliant::haptics {

/// The finite elements at every node of a model, to walk from element to neighbour. Elements are numbered in the order of
/// for_each_element().
class ElementGraph {
 public:
  explicit ElementGraph(const Model& model);
  [[nodiscard]] std::int32_t elements() const { return static_cast<std::int32_t>(first_.size()) - 1; }
  /// Returns the ring of each element: 0 for those at a seed (a slot), n + 1 for those that share a node with ring n; -1
  /// beyond `rings`.
  [[nodiscard]] std::vector<std::int32_t> rings(const std::vector<std::int32_t>& seeds, std::int32_t rings) const;
  /// Returns whether finite elements alone move this node.
  /// Returns whether any finite element has this node.
  [[nodiscard]] bool has_elements(std::int32_t slot) const {
    return offset_[static_cast<std::size_t>(slot)] < offset_[static_cast<std::size_t>(slot) + 1];
  }
  [[nodiscard]] bool moves_alone(std::int32_t slot) const { return coupled_[static_cast<std::size_t>(slot)] == 0; }
  /// The slots of an element.
  [[nodiscard]] std::vector<std::int32_t> nodes_of(std::int32_t element) const {
    return {nodes_.begin() + first_[static_cast<std::size_t>(element)],
            nodes_.begin() + first_[static_cast<std::size_t>(element) + 1]};
  }

 private:
  std::vector<std::int32_t> first_{0}, nodes_;  ///< [elements + 1], slots of the corners
  std::vector<std::int32_t> offset_, at_;       ///< [slots + 1], elements at each node
  std::vector<char> coupled_;                   ///< [slots] moved by shape matching, too
};

struct Submodel {
  /// Element lists only, the contact points whose nodes are all inside the rim, all tools; node i has slot i. Its rim and what
  /// moves on a curve have no inverse mass (Constraint::holds).
  std::shared_ptr<const Model> model;
  std::vector<std::int32_t> slot;   ///< [nodes] slot in the whole model, ascending
  std::vector<char> rim;            ///< [nodes] 1: shared with elements outside, or moved by something else than its elements
  std::vector<std::int32_t> point;  ///< [contact points] index in the whole model's
  /// [nodes] (body << 32 | index in the body, node), ascending: identifies a node in every model of the scene.
  std::vector<std::pair<std::int64_t, std::int32_t>> names;
  std::int32_t rings = 0;  ///< as requested
  std::int64_t elements = 0;
  bool whole = false;              ///< no element outside shares a node with it
  std::vector<std::string> tools;  ///< names, in order: what friction refers to
  std::int64_t topology = 0;       ///< number of edits of the model that it is a part of
};

/// Extracts the elements with ring >= 0. Throws Error (internal) if there are none.
Submodel extract(const Model& model, const ElementGraph& graph, const std::vector<std::int32_t>& ring);

}  // namespace pliant::haptics
