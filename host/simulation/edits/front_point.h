// Front points of blades that cut by force: places in the material that nodes carry.
#pragma once
#include <cstdint>
#include <vector>

#include "cutting/blade/inverse_map.h"
#include "cutting/topology/cut_topology.h"

namespace pliant {

/// The nodes of a body that carry a front point, with their weights: of the cell's one or two copies, at most eight.
struct FrontCarrier {
  std::int32_t node = 0;
  double weight = 0;
};
std::vector<FrontCarrier> front_carriers(const CutTopology& body, const MaterialPoint& point);

/// Where a front point is [m]. x: present positions of the body's nodes [m].
Vec3d front_place(const CutTopology& body, const std::vector<Vec3d>& x, const MaterialPoint& point);

}  // namespace pliant
