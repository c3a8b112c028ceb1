// Shape-matching nodes of a body: slots, links, regions, weights.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "model/elements/body_mesh.h"
#include "model/model.h"

namespace pliant {

/// Numbers the nodes of the body's shape-matching cells, assigns slots at the end of `model` to those that no finite element
/// moves, and finds their regions. `slot`: the slot of each node of the body, -1 if it has none yet. `previous` (may be
/// null): its regions are reused where nodes and links are the same.
FlsmBatch place_matching_nodes(const BodyElements& solid, const Body& body, std::int32_t number,
                               std::vector<std::int32_t>& slot, const Model* previous, Model& model);

/// Finds the regions of a batch from its links, and fillers for them, replacing the previous ones. Call again after links
/// were cut, and weigh() afterwards.
void find_batch_regions(FlsmBatch& batch, const FlsmBatch* before = nullptr);

/// Sets the weights of the region sums from lumped masses: m / holders, so that the mean of the goals conserves momentum.
void weigh(FlsmBatch& batch, const std::vector<double>& mass);

/// For shape matching with a stiffness (settings.young > 0): weights that account for constrained nodes, and the elasticity
/// of the regions. Call after weigh(), when model.constraints is set.
void make_elastic(FlsmBatch& batch, const Model& model);

/// Sums `values` [own + interface] over the nodes of each region; with `back`, over the regions that contain each node.
std::vector<double> region_sums(const FlsmBatch& batch, const std::vector<double>& values, bool back);

/// Moments of a region's undeformed weights about its centre, in grid units: sum m; m o (3); m o o^T (xx yy zz xy xz yz).
using RestMoments = std::array<double, 10>;
std::vector<RestMoments> rest_moments(const FlsmBatch& batch);

}  // namespace pliant
