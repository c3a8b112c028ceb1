// The nodes of a body that follow shape matching: slots, links, regions, weights.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "model/elements/body_mesh.h"
#include "model/model.h"

namespace pliant {

/// Number the nodes of the body's shape-matching cells, give those that no finite element moves slots at the end of `model`,
/// and find their regions. `slot` is the slot of each node of the body, -1 where it has none yet.
/// `previous` lends its regions where nodes and links are the same; it may be null.
FlsmBatch place_matching_nodes(const BodyElements& solid, const Body& body, std::int32_t number,
                               std::vector<std::int32_t>& slot, const Model* previous, Model& model);

/// Find the regions of a batch from the links among its nodes, and fillers for them; those it had before go. Called again after
/// links were cut; weigh() has to follow.
void find_batch_regions(FlsmBatch& batch, const FlsmBatch* before = nullptr);

/// Weights of the region sums, once the masses are lumped: m / holders, so that the mean of the goals keeps the momentum.
void weigh(FlsmBatch& batch, const std::vector<double>& mass);

/// Where shape matching is to have a stiffness (settings.young > 0): weights that know what is held, and what makes regions
/// deform like the material. After weigh(), once model.constraints are there.
void make_elastic(FlsmBatch& batch, const Model& model);

/// Sums of `values` [own + interface] over the nodes of each region; with `back`, over the regions that hold each node.
std::vector<double> region_sums(const FlsmBatch& batch, const std::vector<double>& values, bool back);

/// Moments of a region's weights at rest about its centre, in grid units: sum m; m o (3); m o o^T (xx yy zz xy xz yz).
using RestMoments = std::array<double, 10>;
std::vector<RestMoments> rest_moments(const FlsmBatch& batch);

}  // namespace pliant
