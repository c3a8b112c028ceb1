// Elements and regions of one body and one material, as the Program takes them.
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
  ElementKind kind = ElementKind::hex8;
  Material material;
  std::int32_t body = 0;
  bool uniform = false;             ///< all are cubes of the same edge: one record
  std::vector<std::int32_t> nodes;  ///< [elements][corners] slots
  std::vector<double> records;      ///< [elements or 1][numbers of a record] (elements/element.h)
  std::vector<double> share;        ///< [elements] of a full one's stiffness, by fill and modulus
  std::vector<std::int64_t> id;     ///< [elements] number in its body
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

/// A run of bricks that share one material and spacing.
struct BrickBatch {
  Material material;
  std::int32_t body = 0;  ///< of the first brick, for labels
  double spacing = 0;     ///< [m]
  std::int32_t first = 0, count = 0;
  static constexpr ElementKind kind = ElementKind::hex8;
  [[nodiscard]] std::vector<double> record() const;  ///< of each of its cells
};

/// What a region resists a strain with, where shape matching has the stiffness of a material (model/matching/flsm_elastic.cpp).
struct RegionElasticity {
  std::array<double, 6> inverse{};  ///< of its second moments at rest (xx yy zz xy xz yz) [1/kg]; of a thin region nothing
  double share = 0;                 ///< second moment of a whole window that holds as much material [kg]; 0: it stays rigid
};

/// Fast lattice shape matching of one body: the nodes of its cells that are not operational, and one region around each.
/// Regions are numbered like these nodes: first the nodes that shape matching moves (`own`, slots first_slot, first_slot + 1,
/// ...), then the interface.
struct FlsmBatch {
  std::int32_t body = 0;
  DeformationModel settings;
  double spacing = 0;                              ///< [m]
  double density = 0;                              ///< [kg/m^3], for calibrated stiffness
  std::int32_t own = 0, interface = 0;             ///< nodes
  std::int32_t first_slot = 0, slots = 0;          ///< slots reserved for `own` and for the padding, a multiple of 16
  std::int32_t fillers = 0;                        ///< empty grid points that the ordered sums cross; they have links only
  std::vector<std::int32_t> slot;                  ///< [own + interface]
  std::vector<std::array<std::int32_t, 3>> index;  ///< [own + interface] grid point
  std::vector<std::array<std::int32_t, 6>> link;   ///< [own + interface + fillers] -x, +x, -y, +y, -z, +z, -1: none
  std::vector<Branch> branches;                    ///< where the parts that links join hang together besides
  FlsmRegions regions;
  /// Of a batch that an edit has made, for the next edit: the regions without fillers, and the grid points of the fillers.
  std::shared_ptr<const FlsmRegions> bare;
  std::vector<std::array<std::int32_t, 3>> filler_index;
  std::vector<double> weight;             ///< [own + interface] node mass over the number of regions that hold it [kg]
  std::vector<double> matter;             ///< [own + interface] share of the node's mass in cells of shape matching
  std::vector<RegionElasticity> elastic;  ///< [own + interface] with settings.young > 0, else empty
  double poisson = 0;                     ///< that of `elastic`
  /// The highest omega^2 of shape matching alone over alpha / H^2, at most: anywhere, and at interface nodes.
  double stiffest = 1, stiffest_interface = 1;
};

}  // namespace pliant
