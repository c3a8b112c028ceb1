// Elements and regions of one body and one material, in the form that the Program uses.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "elements/element.h"
#include "model/matching/flsm_regions.h"
#include "scene/scene.h"

namespace pliant {

/// Elements of one kind, one body and one material outside the bricks.
struct ElementBatch {
  ElementKind kind{};
  Material material;
  std::int32_t body = 0;
  bool uniform = false;             ///< all are equal cubes, with one record
  std::vector<std::int32_t> nodes;  ///< [elements][corners] slots
  std::vector<double> records;      ///< [elements or 1][numbers of a record] (elements/element.h)
  std::vector<double> share;        ///< [elements] fraction of a full element's stiffness, by fill and modulus
  std::vector<double> frequency;    ///< [elements] of each alone, before its modulus [1/s]; empty if uniform
  std::vector<std::int64_t> id;     ///< [elements] index in the body
  [[nodiscard]] std::size_t size() const { return id.size(); }
  [[nodiscard]] const ElementInfo& info() const { return element_info(kind); }
  [[nodiscard]] std::span<const std::int32_t> nodes_of(std::size_t e) const {
    const auto corners = static_cast<std::size_t>(info().corners);
    return {nodes.data() + corners * e, corners};
  }
  [[nodiscard]] std::span<const double> record_of(std::size_t e) const {
    const std::size_t numbers = uniform ? records.size() : static_cast<std::size_t>(info().record);
    return {records.data() + (uniform ? 0 : numbers * e), numbers};
  }
};

/// Consecutive bricks with the same material and spacing.
struct BrickBatch {
  Material material;
  std::int32_t body = 0;  ///< body of the first brick, for labels
  double spacing = 0;     ///< [m]
  std::int32_t first = 0, count = 0;
  [[nodiscard]] static ElementKind kind() { return brick_element(); }
  [[nodiscard]] std::vector<double> record() const;  ///< the record of each of its cells
};

/// Elasticity of a region, if shape matching has the stiffness of a material (model/matching/flsm_elastic.cpp).
struct RegionElasticity {
  std::array<double, 6>
      inverse{};     ///< inverse of its undeformed second moments (xx yy zz xy xz yz) [1/kg]; 0 for a thin region
  double share = 0;  ///< second moment of a full window with the same amount of material [kg]; 0: the region stays rigid
};

/// Fast lattice shape matching of one body: the nodes of its non-operational cells, with one region around each. Regions are
/// numbered as the nodes: first the nodes moved by shape matching (`own`, slots first_slot, first_slot + 1, ...), then the
/// interface.
struct FlsmBatch {
  std::int32_t body = 0;
  DeformationModel settings;
  double spacing = 0;                      ///< [m]
  double density = 0;                      ///< [kg/m^3], for the calibrated stiffness
  std::int32_t own = 0, interface = 0;     ///< numbers of nodes
  std::int32_t first_slot = 0, slots = 0;  ///< slots reserved for `own` and padding, a multiple of 16
  std::int32_t fillers = 0;                ///< empty grid points that the ordered sums pass through; they have only links
  std::vector<std::int32_t> slot;          ///< [own + interface]
  std::vector<std::array<std::int32_t, 3>> index;  ///< [own + interface] grid point
  std::vector<std::array<std::int32_t, 6>> link;   ///< [own + interface + fillers] -x, +x, -y, +y, -z, +z, -1: none
  std::vector<Branch> branches;                    ///< connections between nodes whose links lead to other copies
  FlsmRegions regions;
  /// After an edit, input of the next edit: the regions without fillers, and the grid points of the fillers.
  std::shared_ptr<const FlsmRegions> bare;
  std::vector<std::array<std::int32_t, 3>> filler_index;
  std::vector<double> weight;             ///< [own + interface] node mass over the number of regions that contain it [kg]
  std::vector<double> matter;             ///< [own + interface] fraction of the node's mass that is in shape-matching cells
  std::vector<RegionElasticity> elastic;  ///< [own + interface] if settings.young > 0, otherwise empty
  double poisson = 0;                     ///< Poisson's ratio of `elastic`
  /// Upper bounds of omega^2 of shape matching alone over alpha / H^2: for all nodes, and for interface nodes.
  double stiffest = 1, stiffest_interface = 1;
};

}  // namespace pliant
